#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_off_the_ground_is_where_only_the_commanded_thrust_carries_it(void)
{
    static const struct {
        flight_state_t state;
        bool airborne, lifting, has_throttle;
        float height_mm;
        bool off_ground;
    } rows[] = {{FLIGHT_GROUND, true, false, true, 500.0F, false},
                {FLIGHT_CUT, true, false, true, 500.0F, false},
                {FLIGHT_TAKEOFF, true, true, true, 0.0F, true},
                {FLIGHT_TAKEOFF, false, true, true, 500.0F, false},
                {FLIGHT_FLYING, true, false, true, 0.0F, true},
                {FLIGHT_FLYING, true, true, true, 500.0F, false},
                {FLIGHT_FLYING, true, false, false, 500.0F, false},
                {FLIGHT_FLOATING, true, false, true, 500.0F, true},
                {FLIGHT_LANDING, true, false, true, 80.0F, true},
                {FLIGHT_LANDING, true, false, true, 79.9F, false},
                {FLIGHT_LANDING, true, false, false, 500.0F, false},
                {FLIGHT_COASTING, true, false, true, 0.0F, true},
                {FLIGHT_COASTING, true, false, false, 500.0F, false},
                {FLIGHT_DESCENDING, true, false, true, 0.0F, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.where.supervisor.state = rows[i].state;
        f.est.airborne = rows[i].airborne;
        f.where.contact.lifting = rows[i].lifting;
        f.where.supervisor.height.height_mm = rows[i].height_mm;
        in.has_throttle = rows[i].has_throttle;
        TEST_ASSERT_EQUAL(rows[i].off_ground, described().off_ground);
    }
    f.where.supervisor.state = FLIGHT_FLOATING;
    f.mode = FLIGHT_MODE_HOVER;
    TEST_ASSERT_FALSE(described().off_ground);
}

void test_the_flight_is_described_to_the_consistency_check(void)
{
    in.now_us = 700000U;
    in.reference_sequence = 3U;
    f.where.supervisor.now_us = 600000U;
    f.where.supervisor.reference_sequence = 3U;
    f.where.hover.thrust_n = 7.2F;
    f.thrust_n = 7.9F;
    f.est.deadband.band_n = 0.2F;
    f.est.estimator.credit.noise_mps2 = 0.7F;
    command_t flown = described();
    NEAR(0.1F, flown.step_s);
    TEST_ASSERT_FALSE(flown.grounded || flown.standing || flown.ordered);
    TEST_ASSERT_TRUE(flown.off_ground && flown.ours);
    NEAR(deadband_effect(&f.est.deadband, 7.2F, 7.9F), flown.thrust_n);
    NEAR(7.2F, flown.hover_n);
    NEAR(est_law_vehicle(&f.est, &parameters).authority_mps2_per_n, flown.authority_mps2_per_n);
    NEAR(2.5F, flown.damping_per_s);
    NEAR(0.1F, flown.wanted_m);
    NEAR(0.7F, flown.noise_mps2);
    in.now_us += 5000000U;
    in.reference_sequence = 4U;
    in.has_throttle = false;
    f.where.supervisor.state = FLIGHT_GROUND;
    flown = described();
    NEAR(0.5F, flown.step_s);
    TEST_ASSERT_TRUE(flown.grounded && flown.ordered);
    TEST_ASSERT_FALSE(flown.ours);
    f.where.supervisor.started = false;
    f.where.supervisor.state = FLIGHT_TAKEOFF;
    f.where.contact.lifting = true;
    flown = described();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, flown.step_s);
    TEST_ASSERT_TRUE(flown.standing);
}

void test_it_may_be_carried_on_the_ground_without_a_pin_or_in_a_descent_that_began_so(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_GROUND;
        f.evidence.in_hands = i != 1;
        set(PARAMETER_SEL, (i == 2) ? (float)SEL_PIN : (float)SEL_NONE);
        TEST_ASSERT_EQUAL(i == 0, may_be_in_hands());
    }
    f.where.supervisor.state = FLIGHT_DESCENDING;
    sway(true);
    TEST_ASSERT_FALSE(may_be_in_hands());
    f.where.pilot.given_back = true;
    TEST_ASSERT_TRUE(may_be_in_hands());
    sway(false);
    TEST_ASSERT_FALSE(may_be_in_hands());
}
