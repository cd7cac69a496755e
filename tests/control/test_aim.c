#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_a_wanted_height_is_there_while_one_is_held(void)
{
    for (int state = 0; state < (int)FLIGHT_STATE_COUNT; state++) {
        setUp();
        f.where.supervisor.state = (flight_state_t)state;
        f.aim.floating_m = 0.8F;
        const bool holds = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_LOWERING;
        if (state == FLIGHT_FLOATING) {
            NEAR(0.3F, aim_wanted_m(&f.aim, &f.where.supervisor, f.mode));
            f.mode = FLIGHT_MODE_HOVER;
            TEST_ASSERT_TRUE(isnan(aim_wanted_m(&f.aim, &f.where.supervisor, f.mode)));
        } else if (holds) {
            NEAR(0.1F, aim_wanted_m(&f.aim, &f.where.supervisor, f.mode));
        } else {
            TEST_ASSERT_TRUE(isnan(aim_wanted_m(&f.aim, &f.where.supervisor, f.mode)));
        }
    }
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
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.9F, 0.64F},
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.1F, 0.36F}};
    for (int i = 0; i < 9; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_FLOATING;
        f.mode = rows[i].mode;
        unknown(rows[i].throttle_unknown);
        f.where.pilot.effect.has_effect = rows[i].has_effect;
        f.aim.floating_m = rows[i].before_m;
        float_along(rows[i].entered);
        NEAR(rows[i].held_m, f.aim.floating_m);
        NEAR(f.aim.floating_m, aim_height_m(&f.aim, &f.where.supervisor));
    }
    f.where.supervisor.state = FLIGHT_FLYING;
    f.aim.floating_m = 0.6F;
    float_along(false);
    NEAR(0.5F, f.aim.floating_m);
    NEAR(0.6F, aim_height_m(&f.aim, &f.where.supervisor));
    TEST_ASSERT_TRUE(modes_hold(FLIGHT_MODE_EST_HOLD) && modes_hold(FLIGHT_MODE_FLOAT));
    TEST_ASSERT_FALSE(modes_hold(FLIGHT_MODE_HOVER) || modes_hold(FLIGHT_MODE_LAW));
}

void test_a_reference_out_of_reach_is_told_in_the_states_that_act(void)
{
    f.where.supervisor.reference_m = f.aim.reach_m = 0.6F;
    f.aim.reach = (reach_t){.on = true, .above = false, .nearest_mm = 100.0F, .stuck_us = 60000000U};
    const reach_t stuck = f.aim.reach;
    f.where.supervisor.height.height_mm = 300.0F;
    aim_judge(&f.aim, &f.where);
    TEST_ASSERT_TRUE(f.aim.out_of_reach);
    f.where.supervisor.state = FLIGHT_TAKEOFF;
    aim_judge(&f.aim, &f.where);
    TEST_ASSERT_TRUE(f.aim.out_of_reach);
    f.where.supervisor.reference_m = 0.7F;
    aim_judge(&f.aim, &f.where);
    TEST_ASSERT_FALSE(f.aim.out_of_reach);
    NEAR(0.7F, f.aim.reach_m);
    f.aim.reach = stuck;
    f.where.supervisor.state = FLIGHT_LANDING;
    aim_judge(&f.aim, &f.where);
    TEST_ASSERT_FALSE(f.aim.out_of_reach);
    TEST_ASSERT_FALSE(f.aim.reach.on);
}
