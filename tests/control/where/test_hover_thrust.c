#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_sure_hover_thrust_follows_the_estimated_one_slowly(void)
{
    static const struct {
        float learned_s, hover_n, then_s;
    } rows[] = {{1.0F, 7.04F, 1.1F},
                {0.59F, 7.4F, 0.69F},
                {0.61F, 7.0656F, 0.71F},
                {2.5F, 7.016F, 2.5F},
                {0.0F, 7.4F, 0.1F}};
    for (int i = 0; i < 5; i++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.where.hover.learned_s = rows[i].learned_s;
        update_hover();
        TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, rows[i].hover_n, f.where.hover.thrust_n);
        NEAR(rows[i].then_s, f.where.hover.learned_s);
    }
    setUp(); /* a pause counts as half a second */
    f.est.hover.thrust_n = 7.4F;
    f.where.supervisor.step_us = 5000000U;
    update_hover();
    NEAR(7.08F, f.where.hover.thrust_n);
}

void test_without_an_estimate_it_is_a_mean_of_the_thrust_in_flight(void)
{
    static const struct {
        flight_state_t state;
        flight_mode_t mode;
        bool throttle_unknown, airborne, follows;
    } rows[] = {{FLIGHT_FLYING, FLIGHT_MODE_LAW, false, true, true},
                {FLIGHT_TAKEOFF, FLIGHT_MODE_LAW, false, true, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, false, true, true},
                {FLIGHT_FLOATING, FLIGHT_MODE_HOVER, false, true, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, true, true, false}};
    for (int i = 0; i < 5; i++) {
        setUp();
        lose_the_estimate();
        f.est.hover.thrust_n = 6.0F;
        f.thrust_n = 7.5F;
        f.where.supervisor.state = rows[i].state;
        f.mode = rows[i].mode;
        unknown(rows[i].throttle_unknown);
        update_hover();
        NEAR(rows[i].follows ? 7.02F : 7.0F, f.where.hover.thrust_n);
    }
    setUp();
    f.est.airborne = false; /* an estimate of a vehicle on the ground is none */
    f.thrust_n = 7.5F;
    update_hover();
    NEAR(7.02F, f.where.hover.thrust_n);
}

void test_heights_that_may_be_of_a_blocked_beam_teach_nothing_but_at_first(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.evidence.teaches = i == 2;
        f.where.hover.learned_s = (i == 3) ? 0.0F : 1.0F;
        update_hover();
        NEAR((i < 2) ? 7.0F : (i == 2) ? 7.04F : 7.4F, f.where.hover.thrust_n);
    }
}

void test_what_the_flight_has_learned_is_given_up_on_the_ground(void)
{
    static const struct {
        flight_state_t state;
        bool learned, lifting;
        float hover_n;
    } rows[] = {{FLIGHT_GROUND, true, false, 7.0F},     {FLIGHT_FLYING, true, false, 7.6F},
                {FLIGHT_FLYING, true, true, 7.0F},      {FLIGHT_TAKEOFF, false, false, 7.6F},
                {FLIGHT_FLOATING, true, false, 7.6F},   {FLIGHT_DESCENDING, false, false, 7.0F},
                {FLIGHT_DESCENDING, true, false, 7.6F}, {FLIGHT_DESCENDING, true, true, 7.6F},
                {FLIGHT_FLOATING, false, false, 7.6F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.where.supervisor.state = rows[i].state;
        f.where.hover.learned = rows[i].learned;
        f.where.contact.lifting = rows[i].lifting;
        f.where.hover.thrust_n = f.est.hover.thrust_n = 7.6F;
        update_hover();
        NEAR(rows[i].hover_n, f.where.hover.thrust_n);
        if (rows[i].hover_n < 7.5F) {
            TEST_ASSERT_EQUAL_FLOAT(0.0F, f.where.hover.learned_s);
        }
        NEAR(rows[i].hover_n, f.est.sure_hover_n);
    }
}

void test_nothing_is_learned_without_sight_or_in_doubt(void)
{
    for (int why = 0; why < 5; why++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.where.supervisor.flags = (why == 1) ? FLIGHT_FLAG_HEIGHT : 0U;
        f.evidence.doubts = (uint16_t)((why == 2)   ? DOUBT_SIGHT
                                       : (why == 3) ? DOUBT_THRUST
                                       : (why == 4) ? DOUBT_IMU
                                                    : 0U);
        update_hover();
        NEAR((why == 0 || why == 4) ? 7.016F : 7.0F, f.where.hover.thrust_n);
    }
}

void test_the_sure_hover_thrust_stays_within_one_and_a_half_newton_of_gravity(void)
{
    f.where.hover.thrust_n = f.est.hover.thrust_n = 9.0F;
    update_hover();
    NEAR(8.5F, f.where.hover.thrust_n);
    f.where.hover.thrust_n = f.est.hover.thrust_n = 5.0F;
    update_hover();
    NEAR(5.5F, f.where.hover.thrust_n);
    f.where.hover.thrust_n = f.est.hover.thrust_n = -1.0F;
    parameters.value[PARAMETER_GRAV] = 0.5F;
    update_hover();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.where.hover.thrust_n);
    f.where.hover.thrust_n = f.est.hover.thrust_n = 13.0F;
    parameters.value[PARAMETER_GRAV] = 11.5F;
    update_hover();
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, f.where.hover.thrust_n);
}

void test_a_descent_keeps_the_hover_thrust_of_its_entry(void)
{
    static const flight_state_t states[] = {FLIGHT_DESCENDING, FLIGHT_LANDING, FLIGHT_LOWERING,
                                            FLIGHT_COASTING};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.state = states[i];
        f.est.entry_hover_n = 6.0F;
        f.where.hover.thrust_n = 7.2F;
        update_hover();
        NEAR((i < 3) ? 6.0F : 7.2F, f.est.entry_hover_n);
    }
}

void test_a_carried_descent_knows_its_hover_thrust_still(void)
{
    f.where.supervisor.state = FLIGHT_DESCENDING;
    f.where.pilot.given_back = true;
    f.est.entry_hover_n = 6.0F;
    f.where.hover.thrust_n = 7.2F;
    update_hover();
    NEAR(7.2F, f.est.entry_hover_n);
}
