#include "control/laws/laws.h"
#include "flight_case.h"

static laws_t laws;

void setUp(void)
{
    begin();
    memset(&laws, 0, sizeof laws);
}

void tearDown(void) {}

void test_law_est_is_asked_to_hold_to_land_or_to_sink(void)
{
    static const flight_mode_t modes[] = {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_LAND, FLIGHT_MODE_EST_SINK};
    static const est_mode_t asked[] = {EST_MODE_HOLD, EST_MODE_LAND, EST_MODE_SINK};
    for (int i = 0; i < 3; i++) {
        setUp();
        mode_is(modes[i]);
        est_law_t expected = est;
        const est_order_t order = {.mode = asked[i],
                                   .reference_m = 0.6F,
                                   .airborne = where.contact.airborne,
                                   .hover_n = where.hover.thrust_n};
        const float expected_n = est_law_step(&expected, &parameters, &order);
        TEST_ASSERT_EQUAL_FLOAT(expected_n, laws_step(&laws, &est, &now, false));
    }
}
