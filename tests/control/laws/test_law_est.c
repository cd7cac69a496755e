#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_law_est_is_asked_to_hold_to_land_or_to_sink(void)
{
    static const flight_mode_t modes[] = {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_LAND, FLIGHT_MODE_EST_SINK};
    static const est_mode_t asked[] = {EST_MODE_HOLD, EST_MODE_LAND, EST_MODE_SINK};
    for (int i = 0; i < 3; i++) {
        setUp();
        f.mode = modes[i];
        f.est.step_s = 0.1F;
        est_law_t expected = f.est;
        const float expected_n = est_law_step(&expected, &parameters, asked[i], 0.6F);
        TEST_ASSERT_FALSE(run_mode(false));
        NEAR(expected_n, f.laws.setpoint_n);
    }
}
