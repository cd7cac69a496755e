#include "control/laws/laws.h"
#include "flight_case.h"

static laws_t laws;

void setUp(void)
{
    begin();
    memset(&laws, 0, sizeof laws);
}

void tearDown(void) {}

static float step_n(flight_mode_t before, flight_mode_t mode)
{
    mode_changes(before, mode);
    (void)laws_step(&laws, &est, &now, false);
    return laws.setpoint_n;
}

static float descend_n(void)
{
    return step_n(FLIGHT_MODE_DESCENT, FLIGHT_MODE_DESCENT);
}

void test_a_descent_by_heights_samples_new_heights_and_its_start(void)
{
    descent_t expected;
    descent_start(&expected, 0.0F);
    hovers_at_n(7.3F);
    height_is(500.0F, -100.0F, 100000U, false);
    const float first_n = descent_step(&expected, 7.3F, 500.0F, -100.0F, 0.0F);
    NEAR(first_n, step_n(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_DESCENT)); /* its start, without a new height */
    height_is(400.0F, -100.0F, 100000U, false);
    NEAR(first_n, descend_n());
    height_is_new(true, 0U);
    NEAR(descent_step(&expected, 7.3F, 400.0F, -100.0F, 0.1F), descend_n());
}

void test_a_gap_of_heights_counts_as_0_3_s_in_a_descent(void)
{
    float thrust_n[2];
    for (uint32_t i = 0U; i < 2U; i++) {
        setUp();
        height_is(500.0F, -100.0F, 300000U + 4700000U * i, true);
        (void)descend_n();
        thrust_n[i] = descend_n();
    }
    NEAR(thrust_n[0], thrust_n[1]);
}

/* Near the ground its thrust fades out, slowly while the tilt moves as in flight. */
void test_a_tilt_that_moves_makes_the_end_of_a_descent_slow(void)
{
    float thrust_n[2];
    for (int rocks = 0; rocks < 2; rocks++) {
        setUp();
        now.rocks = rocks != 0;
        for (int i = 0; i < 20; i++) {
            height_is(10.0F, 0.0F, 100000U, true);
            thrust_n[rocks] = descend_n();
        }
    }
    TEST_ASSERT_TRUE(thrust_n[1] > thrust_n[0] + 0.5F);
}

void test_time_runs_three_times_as_fast_in_a_blind_descent_whose_tilt_is_still(void)
{
    hovers_at_n(7.2F);
    in_state_for_us(FLIGHT_DESCENDING, 10000000U);
    sway(false);
    NEAR(descent_blind(7.2F, 10.0F), step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_BLIND_DESCENT));
    mode_is(FLIGHT_MODE_BLIND_DESCENT); /* 0.1 s */
    NEAR(descent_blind(7.2F, 10.2F), step_n(FLIGHT_MODE_BLIND_DESCENT, FLIGHT_MODE_BLIND_DESCENT));
    NEAR(descent_blind(7.2F, 10.4F), step_n(FLIGHT_MODE_BLIND_DESCENT, FLIGHT_MODE_BLIND_DESCENT));
    evidence.calm = false;
    NEAR(descent_blind(7.2F, 10.4F), step_n(FLIGHT_MODE_BLIND_DESCENT, FLIGHT_MODE_BLIND_DESCENT));
    sway(false);
    frame_was_s_ago(0.3F); /* an IMU that tells nothing is still too */
    NEAR(descent_blind(7.2F, 10.4F), step_n(FLIGHT_MODE_BLIND_DESCENT, FLIGHT_MODE_BLIND_DESCENT));
    frame_was_s_ago(0.0F);
    NEAR(descent_blind(7.2F, 10.0F), step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_BLIND_DESCENT)); /* anew */
}

void test_a_blind_descent_ends_after_a_minute(void)
{
    hovers_at_n(100.0F); /* so that a minute leaves something */
    sway(true);
    in_state_for_us(FLIGHT_DESCENDING, 90000000U);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, descent_blind(100.0F, 60.0F),
                             step_n(FLIGHT_MODE_BLIND_DESCENT, FLIGHT_MODE_BLIND_DESCENT));
}
