#include "control/laws/laws.h"
#include "flight_case.h"

static laws_t laws;

void setUp(void)
{
    begin();
    memset(&laws, 0, sizeof laws);
    mode_is(FLIGHT_MODE_IDLE);
    (void)laws_step(&laws, &est, &now, false); /* it has stood on the ground */
    mode_is(FLIGHT_MODE_LAW);
    now.law = LAW_PID;
}

void tearDown(void) {}

/* One cycle; whether the law has gained or lost its integral action: then it starts from the thrust before.
 */
static bool step(float height_mm, bool is_new)
{
    at_mm(height_mm);
    height_is_new(is_new, 0U);
    now.thrust_n = 3.0F;
    return fabsf(laws_step(&laws, &est, &now, false) - now.thrust_n) < 1.0e-4F;
}

void test_the_seeds_law_gets_its_gains_and_the_error(void)
{
    for (int integral = 0; integral < 2; integral++) {
        setUp();
        set(PARAMETER_KP, 0.02F);
        set(PARAMETER_KD, 0.005F);
        set(PARAMETER_KI, 0.03F);
        set(PARAMETER_USAT, 2.5F);
        set(PARAMETER_DSAT, 1.5F);
        now.law = (integral != 0) ? LAW_PID : LAW_PD;
        const pid_gains_t gains = {0.02F, 0.005F, (integral != 0) ? 0.03F : 0.0F, 7.0F, 2.5F, 1.5F};
        pid_state_t expected;
        pid_reset(&expected);
        for (int i = 0; i < 5; i++) {
            const float error_mm = 80.0F - 30.0F * (float)i;
            const float expected_n = pid_step(&expected, &gains, error_mm);
            TEST_ASSERT_EQUAL(integral != 0 && i == 0, step(600.0F - error_mm, true)); /* it has come */
            NEAR(expected_n, laws.setpoint_n);
        }
        now.law = LAW_PD;
        TEST_ASSERT_EQUAL(integral != 0, step(500.0F, true)); /* it has gone */
    }
}

void test_with_release_scan_a_sample_needs_a_new_height_or_is_the_first(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        set(PARAMETER_KP, 0.01F);
        set(PARAMETER_KD, 0.0F);
        set(PARAMETER_KI, 0.0F);
        set(PARAMETER_RELEASE, (i == 3) ? (float)RELEASE_FREE : (float)RELEASE_SCAN);
        if (i != 2) {
            (void)step(550.0F, false);
            NEAR(GRAV_N + 0.5F, laws.setpoint_n);
        }
        (void)step(540.0F, i == 1);
        NEAR(GRAV_N + ((i == 0) ? 0.5F : 0.6F), laws.setpoint_n);
    }
}
