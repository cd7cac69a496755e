#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_pidt_stands_in_for_law_est(void)
{
    TEST_ASSERT_FALSE(select_law());
    lose_the_estimate();
    TEST_ASSERT_TRUE(select_law());
    TEST_ASSERT_EQUAL(LAW_PIDT, f.law);
    TEST_ASSERT_FALSE(select_law());
    set(PARAMETER_LAW, LAW_PID);
    TEST_ASSERT_TRUE(select_law());
    TEST_ASSERT_EQUAL(LAW_PID, f.law);
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
        f.where.supervisor.state = rows[i].state;
        f.law = rows[i].law;
        f.est.estimator.initialised = rows[i].estimate;
        f.est.airborne = rows[i].airborne;
        f.where.supervisor.estimate_age_us = rows[i].contradicted ? 60000000U : 0U;
        TEST_ASSERT_EQUAL(rows[i].uses, modes_use_estimate(select_mode()));
    }
}

void test_a_pilot_makes_floating_the_hover_thrust(void)
{
    f.where.supervisor.state = FLIGHT_FLOATING;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, select_mode());
    lose_the_estimate();
    TEST_ASSERT_EQUAL(FLIGHT_MODE_FLOAT, select_mode());
    in.has_throttle = false;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, select_mode());
    f.where.supervisor.state = FLIGHT_FLYING;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, select_mode());
}

void test_heights_found_wrong_are_not_held_while_coasting(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.state = (i == 3) ? FLIGHT_FLYING : FLIGHT_COASTING;
        f.evidence.doubts = (i == 1) ? DOUBT_IMU : DOUBT_SIGHT;
        f.est.airborne = i != 2;
        TEST_ASSERT_EQUAL((i == 0) ? FLIGHT_MODE_EST_SINK : FLIGHT_MODE_EST_HOLD, select_mode());
    }
    setUp();
    f.where.supervisor.state = FLIGHT_COASTING;
    f.evidence.doubts = DOUBT_SIGHT;
    lose_the_estimate();
    f.law = LAW_PIDT;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, select_mode());
}
