#include "control/aim.h"
#include "flight_case.h"

static aim_t aim;

void setUp(void)
{
    begin();
    memset(&aim, 0, sizeof aim);
}

void tearDown(void) {}

static void step(flight_mode_t mode, flight_mode_t before)
{
    situation_t then = now;

    then.mode = mode;
    then.mode_before = before;
    aim_step(&aim, &then);
}

/* FLOATING holds this height, and the vehicle is at 0.5 m. */
static void floats_at_m(float height_m)
{
    at_mm(1000.0F * height_m);
    step(FLIGHT_MODE_FLOAT, FLIGHT_MODE_IDLE);
    at_mm(500.0F);
}

void test_a_wanted_height_is_there_while_one_is_held(void)
{
    for (int state = 0; state < (int)FLIGHT_STATE_COUNT; state++) {
        setUp();
        floats_at_m(0.8F);
        in_state((flight_state_t)state);
        const bool holds = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_LOWERING;
        if (state == FLIGHT_FLOATING) {
            NEAR(0.3F, aim_wanted_m(&aim, &where.supervisor, now.mode));
            mode_is(FLIGHT_MODE_HOVER);
            TEST_ASSERT_TRUE(isnan(aim_wanted_m(&aim, &where.supervisor, now.mode)));
        } else if (holds) {
            NEAR(0.1F, aim_wanted_m(&aim, &where.supervisor, now.mode));
        } else {
            TEST_ASSERT_TRUE(isnan(aim_wanted_m(&aim, &where.supervisor, now.mode)));
        }
    }
}

void test_what_the_law_ignores_is_not_wanted(void)
{
    in_state(FLIGHT_FLYING);
    const float wanted_m = aim_wanted_m(&aim, &where.supervisor, now.mode);

    est.terrain.ignored_m = 0.25F;
    step(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_HOLD);
    NEAR(wanted_m - 0.25F, aim_wanted_m(&aim, &where.supervisor, now.mode));
}

void test_floating_holds_its_first_height_within_its_reach(void)
{
    static const struct {
        bool entered, throttle_unknown, has_effect;
        flight_mode_t mode;
        float before_m, held_m;
    } rows[] = {{false, false, false, FLIGHT_MODE_FLOAT, 0.6F, 0.6F},
                {true, false, false, FLIGHT_MODE_FLOAT, 0.6F, 0.5F},
                {false, false, false, FLIGHT_MODE_HOVER, 0.6F, 0.5F},
                {false, false, true, FLIGHT_MODE_FLOAT, 0.9F, 0.8F},
                {false, false, false, FLIGHT_MODE_FLOAT, 0.1F, 0.2F},
                {false, true, false, FLIGHT_MODE_EST_HOLD, 0.9F, 0.56F},
                {false, true, false, FLIGHT_MODE_EST_HOLD, 0.1F, 0.44F},
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.9F, 0.8F},
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.1F, 0.2F}};
    for (int i = 0; i < 9; i++) {
        setUp();
        in_state(FLIGHT_FLOATING);
        unknown(rows[i].throttle_unknown);
        commands_show(rows[i].has_effect);
        floats_at_m(rows[i].before_m);
        step(rows[i].mode, rows[i].entered ? FLIGHT_MODE_IDLE : FLIGHT_MODE_EST_HOLD);
        NEAR(rows[i].held_m, aim_height_m(&aim, &where.supervisor));
    }
    in_state(FLIGHT_FLYING); /* towards its reference; what floating held is forgotten */
    floats_at_m(0.6F);
    step(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_HOLD);
    NEAR(0.6F, aim_height_m(&aim, &where.supervisor));
    in_state(FLIGHT_FLOATING);
    NEAR(0.5F, aim_height_m(&aim, &where.supervisor));
}

/* 0.3 m below it for cycles of 10 s. */
static bool stays_below(flight_state_t state, float reference_m, int cycles)
{
    in_state(state);
    ordered_m(reference_m);
    cycle_takes_us(10000000U);
    at_mm(300.0F);
    for (int i = 0; i < cycles; i++) {
        step(now.mode, now.mode_before);
    }
    return aim.out_of_reach;
}

void test_a_reference_out_of_reach_is_told_in_the_states_that_act_until_another_one_comes(void)
{
    TEST_ASSERT_TRUE(stays_below(FLIGHT_FLYING, 0.6F, 20));
    TEST_ASSERT_TRUE(stays_below(FLIGHT_TAKEOFF, 0.6F, 1));
    TEST_ASSERT_FALSE(stays_below(FLIGHT_TAKEOFF, 0.7F, 1));
    TEST_ASSERT_TRUE(stays_below(FLIGHT_TAKEOFF, 0.7F, 20));
    TEST_ASSERT_FALSE(stays_below(FLIGHT_COASTING, 0.7F, 20));
    TEST_ASSERT_FALSE(stays_below(FLIGHT_FLYING, 0.7F, 1)); /* counted anew */
}

void test_a_landing_that_somebody_holds_up_does_not_reach_the_ground(void)
{
    const pilot_signs_t held_up = {.state = FLIGHT_LANDING,
                                   .has_throttle = true,
                                   .step_s = 0.5F,
                                   .height_mm = 500.0F,
                                   .thrust_n = 5.0F,
                                   .hover_n = 7.0F};

    in_state(FLIGHT_LANDING);
    step(now.mode, now.mode_before);
    TEST_ASSERT_FALSE(aim.out_of_reach);
    for (int i = 0; i < 3; i++) {
        (void)pilot_step(&where.pilot, &held_up);
    }
    step(now.mode, now.mode_before);
    TEST_ASSERT_TRUE(aim.out_of_reach);
}
