#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_a_descent_by_heights_samples_new_heights_and_its_start(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.where.supervisor.height.is_new = i == 1;
        f.where.supervisor.height.gap_us = 100000U;
        f.where.supervisor.height.rate_mm_s = -100.0F;
        f.where.hover.thrust_n = 7.3F;
        f.laws.setpoint_n = 1.0F;
        descent_t expected = f.laws.descent;
        const float expected_n = descent_step(&expected, 7.3F, 500.0F, -100.0F, (i == 1) ? 0.1F : 0.0F);
        step_descent(i == 2);
        NEAR((i == 0) ? 1.0F : expected_n, f.laws.setpoint_n);
    }
    f.where.supervisor.height.is_new = true;
    f.where.supervisor.height.gap_us = 5000000U;
    f.laws.descent.sink_mm_s = 0.0F;
    step_descent(false);
    NEAR(90.0F, f.laws.descent.sink_mm_s); /* 300 mm/s2, of 0.3 s at most */
}

void test_the_tilt_of_a_silent_imu_does_not_rock(void)
{
    sway(true);
    TEST_ASSERT_TRUE(has_imu_and_rocks());
    step_descent(false);
    TEST_ASSERT_TRUE(f.laws.descent.rocks);
    f.est.frameless_s = 1.0F;
    TEST_ASSERT_FALSE(has_imu_and_rocks());
    f.est.frameless_s = 0.0F;
    sway(false);
    TEST_ASSERT_FALSE(has_imu_and_rocks());
}

void test_time_runs_three_times_as_fast_in_a_blind_descent_whose_tilt_is_still(void)
{
    f.where.hover.thrust_n = 7.2F;
    f.mode = FLIGHT_MODE_BLIND_DESCENT;
    f.where.supervisor.state = FLIGHT_DESCENDING;
    f.where.supervisor.state_us = 10000000U;
    f.laws.blind_ahead_s = 9.0F;
    sway(false);
    (void)run_mode(true);
    NEAR(descent_blind(7.2F, 10.0F), f.laws.setpoint_n);
    (void)run_mode(false); /* 0.1 s */
    NEAR(descent_blind(7.2F, 10.2F), f.laws.setpoint_n);
    (void)run_mode(false);
    NEAR(descent_blind(7.2F, 10.4F), f.laws.setpoint_n);
    f.evidence.calm = false;
    (void)run_mode(false);
    NEAR(descent_blind(7.2F, 10.4F), f.laws.setpoint_n);
    sway(false);
    f.est.frameless_s = 0.3F; /* an IMU that tells nothing is still too */
    (void)run_mode(false);
    NEAR(descent_blind(7.2F, 10.4F), f.laws.setpoint_n);
}
