#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_seeds_law_gets_its_gains_and_the_error(void)
{
    for (int integral = 0; integral < 2; integral++) {
        setUp();
        set(PARAMETER_KP, 0.02F);
        set(PARAMETER_KD, 0.005F);
        set(PARAMETER_KI, 0.03F);
        set(PARAMETER_USAT, 2.5F);
        set(PARAMETER_DSAT, 1.5F);
        f.law = (integral != 0) ? LAW_PID : LAW_PD;
        f.laws.pid = (pid_state_t){.integral_n = 0.1F, .last_error_mm = 80.0F, .primed = true};
        pid_state_t pid = f.laws.pid;
        const pid_gains_t gains = {0.02F, 0.005F, (integral != 0) ? 0.03F : 0.0F, 7.0F, 2.5F, 1.5F};
        const float expected_n = pid_step(&pid, &gains, 100.0F);
        TEST_ASSERT_EQUAL(integral != 0, step_pid()); /* the integral has come */
        NEAR(expected_n, f.laws.setpoint_n);
        NEAR(pid.integral_n, f.laws.pid.integral_n);
        TEST_ASSERT_FALSE(step_pid());
    }
}

void test_with_release_scan_a_sample_needs_a_new_height_or_is_the_first(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        set(PARAMETER_RELEASE, (i == 3) ? (float)RELEASE_FREE : (float)RELEASE_SCAN);
        f.law = LAW_PID;
        f.laws.pid.primed = i != 2;
        f.laws.pid.last_error_mm = 50.0F;
        f.where.supervisor.height.is_new = i == 1;
        (void)step_pid();
        TEST_ASSERT_EQUAL_FLOAT((i == 0) ? 50.0F : 100.0F, f.laws.pid.last_error_mm);
    }
}
