#include "flight_case.h"

static mode_choice_t choice;

void setUp(void)
{
    begin();
    choice = (mode_choice_t){.law = LAW_EST, .estimated = true, .airborne = true, .has_throttle = true};
}

void tearDown(void) {}

void test_pidt_stands_in_for_law_est(void)
{
    TEST_ASSERT_EQUAL(LAW_EST, modes_law(&parameters, true));
    TEST_ASSERT_EQUAL(LAW_PIDT, modes_law(&parameters, false));
    set(PARAMETER_LAW, LAW_PID);
    TEST_ASSERT_EQUAL(LAW_PID, modes_law(&parameters, true));
    TEST_ASSERT_EQUAL(LAW_PID, modes_law(&parameters, false));
}

static flight_mode_t mode_of(flight_state_t state)
{
    in_state(state);
    return modes_select(&where.supervisor, &evidence, &choice);
}

void test_the_states_fly_by_the_estimate_where_it_is_sound(void)
{
    static const struct {
        flight_state_t state;
        control_law_t law;
        bool estimate, airborne, contradicted, uses;
    } rows[] = {{FLIGHT_TAKEOFF, LAW_EST, true, true, false, true},
                {FLIGHT_FLYING, LAW_PID, true, true, false, false},
                {FLIGHT_FLYING, LAW_EST, true, false, false, true},
                {FLIGHT_COASTING, LAW_EST, false, false, false, true},
                {FLIGHT_COASTING, LAW_PID, true, true, false, true},
                {FLIGHT_COASTING, LAW_PID, true, false, false, false},
                {FLIGHT_COASTING, LAW_PID, false, true, false, false},
                {FLIGHT_LANDING, LAW_PID, true, true, false, true},
                {FLIGHT_LANDING, LAW_EST, true, true, true, false},
                {FLIGHT_LANDING, LAW_EST, false, true, false, false},
                {FLIGHT_LOWERING, LAW_PID, true, true, false, true},
                {FLIGHT_LOWERING, LAW_EST, true, true, true, false},
                {FLIGHT_DESCENDING, LAW_PID, true, true, true, true},
                {FLIGHT_DESCENDING, LAW_EST, false, true, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        choice.law = rows[i].law;
        choice.estimated = rows[i].estimate;
        choice.airborne = rows[i].airborne;
        estimate_contradicts(rows[i].contradicted);
        TEST_ASSERT_EQUAL(rows[i].uses, modes_use_estimate(mode_of(rows[i].state)));
    }
}

void test_a_pilot_makes_floating_the_hover_thrust(void)
{
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, mode_of(FLIGHT_FLOATING));
    choice.estimated = false;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_FLOAT, mode_of(FLIGHT_FLOATING));
    choice.has_throttle = false;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, mode_of(FLIGHT_FLOATING));
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, mode_of(FLIGHT_FLYING));
}

void test_heights_found_wrong_are_not_held_while_coasting(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        evidence.doubts = (i == 1) ? DOUBT_IMU : DOUBT_SIGHT;
        choice.airborne = i != 2;
        TEST_ASSERT_EQUAL((i == 0) ? FLIGHT_MODE_EST_SINK : FLIGHT_MODE_EST_HOLD,
                          mode_of((i == 3) ? FLIGHT_FLYING : FLIGHT_COASTING));
    }
    setUp();
    evidence.doubts = DOUBT_SIGHT;
    choice.estimated = false;
    choice.law = LAW_PIDT;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, mode_of(FLIGHT_COASTING));
}

void test_the_modes_that_hold_a_height_of_their_own(void)
{
    TEST_ASSERT_TRUE(modes_hold(FLIGHT_MODE_EST_HOLD) && modes_hold(FLIGHT_MODE_FLOAT));
    TEST_ASSERT_FALSE(modes_hold(FLIGHT_MODE_HOVER) || modes_hold(FLIGHT_MODE_LAW));
}
