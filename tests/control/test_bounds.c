#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_an_estimate_that_no_height_has_checked_coasts_near_the_hover_thrust(void)
{
    f.where.hover.thrust_n = 7.2F;
    for (int i = 0; i < 3; i++) {
        f.where.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_COASTING;
        f.est.estimator.unchecked_count = (uint16_t)((i == 2) ? 0 : 1);
        NEAR((i == 0) ? 7.7F : 9.0F, bounded_n(9.0F));
        NEAR((i == 0) ? 6.2F : 5.0F, bounded_n(5.0F));
        NEAR(7.5F, bounded_n(7.5F));
    }
}

/* The present height is 0.5 m; the cycle takes 0.1 s. */
void test_floating_without_a_pin_adds_thrust_while_it_is_too_low_until_the_effect_shows(void)
{
    static const struct {
        float floating_m, before_n;
        bool felt, shown, est;
        float added_n;
    } rows[] = {{0.55F, 0.1F, true, false, true, 0.14F}, {0.55F, 0.38F, true, false, true, 0.4F},
                {0.45F, 0.1F, true, false, true, 0.06F}, {0.45F, 0.02F, true, false, true, 0.0F},
                {0.55F, 0.1F, false, false, true, 0.0F}, {0.55F, 0.1F, true, true, true, 0.0F},
                {0.55F, 0.1F, true, false, false, 0.0F}};
    for (int i = 0; i < 7; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_FLOATING;
        unknown(true);
        f.mode = rows[i].est ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_FLOAT;
        f.aim.floating_m = rows[i].floating_m;
        f.bounds.trim_n = rows[i].before_n;
        f.est.estimator.felt = rows[i].felt;
        f.where.pilot.effect.has_effect = rows[i].shown;
        NEAR(6.8F + rows[i].added_n, bounded_n(6.8F));
        NEAR(rows[i].added_n, f.bounds.trim_n);
        NEAR(7.0F, f.where.hover.thrust_n);
    }
    setUp(); /* the limit of all of it */
    unknown(true);
    f.bounds.trim_n = 0.4F;
    f.aim.floating_m = 0.6F;
    NEAR(9.0F, bounded_n(8.9F));
}

/* A law that wants 11 N, of a vehicle with 2 m/s2 per newton less or more and a damping of 2.5 1/s. */
static float climbing_n(flight_state_t state, flight_mode_t mode, bool unconfirmed, float pushed_mps,
                        float felt_mps)
{
    f.where.supervisor.state = state;
    f.mode = mode;
    f.evidence.unconfirmed = unconfirmed;
    f.evidence.push_mps = pushed_mps;
    feel(felt_mps);
    return bounded_n(11.0F);
}

void test_a_climb_has_a_thrust_by_the_vehicles_model(void)
{
    const float per_mps = 2.5F * 7.0F / 9.80665F; /* newtons against the drag of 1 m/s */
    NEAR(7.0F + 0.35F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, true, 0.26F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, true, 0.24F, 0.0F));
    NEAR(7.0F + 1.1F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, false, 1.01F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, false, 0.99F, 0.0F));
    NEAR(7.0F + 0.6F * per_mps, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.51F));
    NEAR(11.0F, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.49F, 0.51F));
    NEAR(11.0F, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.49F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_LAW, true, 0.3F, 0.0F)); /* law EST does not fly */
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_DESCENT, true, 0.3F, 0.0F));
    f.law = LAW_PIDT;
    NEAR(7.0F + 0.35F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_LAW, true, 0.3F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_FLOAT, true, 0.3F, 0.0F));
    NEAR(6.5F, bounded_n(6.5F));
}

void test_a_descent_over_a_far_fall_of_the_terrain_has_one_too(void)
{
    const float least_n = 7.0F - 0.35F * 2.5F * 7.0F / 9.80665F;
    NEAR(3.0F, bounded_n(3.0F));
    f.evidence.terrain_fell = true;
    NEAR(least_n, bounded_n(3.0F));
    NEAR(8.0F, bounded_n(8.0F));
    f.mode = FLIGHT_MODE_LAW;
    NEAR(3.0F, bounded_n(3.0F));
    f.law = LAW_PIDT;
    NEAR(least_n, bounded_n(3.0F));
    f.mode = FLIGHT_MODE_FLOAT;
    NEAR(3.0F, bounded_n(3.0F));
}

void test_a_thrust_in_doubt_stays_near_the_held_one_on_one_side(void)
{
    f.evidence.doubts = DOUBT_THRUST;
    f.evidence.held_n = 7.2F;
    NEAR(7.8F, bounded_n(11.0F));
    NEAR(3.0F, bounded_n(3.0F));
    f.evidence.held_down = true;
    NEAR(6.6F, bounded_n(3.0F));
    NEAR(11.0F, bounded_n(11.0F));
    f.where.supervisor.state = FLIGHT_LANDING;
    f.bounds.sunk_n = 0.5F;
    NEAR(6.6F - 0.52F, bounded_n(3.0F)); /* 0.2 N/s */
    f.where.supervisor.step_us = 5000000U;
    NEAR(6.6F - 0.62F, bounded_n(3.0F));
    f.mode = FLIGHT_MODE_IDLE;
    NEAR(0.0F, bounded_n(0.0F));
    f.where.supervisor.state = FLIGHT_FLYING;
    (void)bounded_n(3.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.bounds.sunk_n);
    f.bounds.sunk_n = 0.5F;
    f.where.supervisor.state = FLIGHT_LANDING;
    f.evidence.doubts = DOUBT_SIGHT;
    f.mode = FLIGHT_MODE_EST_LAND;
    NEAR(3.0F, bounded_n(3.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.bounds.sunk_n);
}

void test_where_a_pilot_may_fly_the_thrust_is_within_two_newtons_of_hover(void)
{
    f.where.supervisor.state = FLIGHT_FLOATING;
    f.aim.floating_m = 0.5F;
    unknown(true);
    NEAR(9.0F, bounded_n(11.0F));
    NEAR(5.0F, bounded_n(3.0F));
    NEAR(7.5F, bounded_n(7.5F));
}

void test_the_end_of_a_descent_is_tried_by_a_newton_a_second(void)
{
    static const struct {
        flight_mode_t mode;
        uint16_t doubts;
        bool still, tries;
    } rows[] = {
        {FLIGHT_MODE_EST_SINK, 0U, true, true},      {FLIGHT_MODE_EST_LAND, DOUBT_IMU, true, true},
        {FLIGHT_MODE_BLIND_DESCENT, 0U, true, true}, {FLIGHT_MODE_BLIND_DESCENT, DOUBT_IMU, true, false},
        {FLIGHT_MODE_EST_HOLD, 0U, true, false},     {FLIGHT_MODE_EST_SINK, 0U, false, false},
        {FLIGHT_MODE_DESCENT, 0U, true, false}};
    for (int i = 0; i < 7; i++) {
        setUp();
        f.mode = rows[i].mode;
        f.evidence.doubts = rows[i].doubts;
        f.evidence.may_stand = rows[i].still;
        f.bounds.standing_n = 6.0F;
        f.thrust_n = 6.5F;
        NEAR(rows[i].tries ? 5.9F : 8.0F, bounded_n(8.0F));
        NEAR(rows[i].tries ? 5.9F : THRUST_MAX_N, f.bounds.standing_n);
        NEAR(3.0F, bounded_n(3.0F));
    }
    setUp();
    f.mode = FLIGHT_MODE_EST_SINK;
    f.evidence.may_stand = true;
    f.bounds.standing_n = THRUST_MAX_N;
    f.thrust_n = 6.5F;
    NEAR(6.4F, bounded_n(8.0F));
    f.where.supervisor.step_us = 5000000U;
    NEAR(5.9F, bounded_n(8.0F));
    f.bounds.standing_n = 0.05F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, bounded_n(8.0F));
}

void test_a_landing_near_the_ground_goes_on_there_while_heights_are_missing(void)
{
    f.where.hover.thrust_n = 7.0F;
    f.where.supervisor.state = FLIGHT_DESCENDING;
    f.where.supervisor.height.height_mm = 30.0F;
    NEAR(8.0F, landing_n(8.0F)); /* a height of before the landing tells nothing */
    f.where.supervisor.state = FLIGHT_LANDING;
    f.where.supervisor.height.height_mm = 41.0F;
    NEAR(8.0F, landing_n(8.0F));
    f.where.supervisor.height.height_mm = 39.0F;
    NEAR(7.3F, landing_n(8.0F)); /* 0.5 N above, after 0.1 s at 2 N/s */
    f.where.supervisor.state = FLIGHT_DESCENDING;
    NEAR(7.1F, landing_n(8.0F));
    NEAR(3.0F, landing_n(3.0F));
    f.where.supervisor.state = FLIGHT_LANDING;
    NEAR(6.7F, landing_n(8.0F));
    f.where.supervisor.height.height_mm = 101.0F;
    NEAR(8.0F, landing_n(8.0F));
    f.where.supervisor.height.height_mm = 30.0F;
    NEAR(7.3F, landing_n(8.0F));
    f.evidence.doubts = DOUBT_SIGHT;
    NEAR(8.0F, landing_n(8.0F));
    f.evidence.doubts = 0U;
    f.where.contact.touching_s = 1.0F;
    f.where.supervisor.state = FLIGHT_LOWERING;
    NEAR(8.0F, landing_n(8.0F));
    NEAR(0.0F, f.where.contact.touching_s);
}

/* One step of 0.1 s with a felt speed, after felt climbs of before_n. */
static float carried_step_n(float felt_mps, float before_n)
{
    f.bounds.felt_n = before_n;
    f.est.estimator.now.speed_mps = f.est.estimator.filter.estimate.speed_mps = felt_mps;
    f.est.estimator.now.bias_mps2 = f.est.estimator.filter.estimate.bias_mps2 = 0.2F;
    return bounded_n(3.0F);
}

void test_a_carried_vehicle_has_a_thrust_below_hover_that_sinks(void)
{
    f.where.pilot.given_back = true;
    unknown(true);
    f.where.pilot.sink_n_per_s = 0.06F;
    f.where.supervisor.state_us = 10000000U;
    NEAR(7.0F - 0.5F - 0.6F, carried_step_n(0.3F, 0.0F));
    NEAR(0.285F, f.est.estimator.now.speed_mps); /* less a twentieth: 0.1 of 2 s */
    NEAR(0.0F, f.est.estimator.now.height_m);
    NEAR(0.2015F, f.est.estimator.now.bias_mps2);
    NEAR(7.0F - 0.5F - 0.6F - 0.4F, carried_step_n(-0.3F, 0.4F));
    f.where.supervisor.state_us = 50000000U;
    NEAR(7.0F - 0.5F - 1.2F, carried_step_n(0.0F, 0.0F));
}

void test_a_carried_vehicle_that_feels_a_climb_gives_less_and_a_fall_more(void)
{
    f.where.pilot.given_back = true;
    unknown(true);
    NEAR(7.0F - 0.5F - 0.2F - 1.0F, carried_step_n(1.35F, 0.0F)); /* 1 m/s beyond: 2 N in a second */
    NEAR(0.2F, f.bounds.felt_n);
    NEAR(7.0F - 0.5F + 1.0F, carried_step_n(-0.85F, 0.0F));
    NEAR(0.0F, f.bounds.felt_n); /* no more than what climbs have lowered */
    NEAR(7.0F - 0.5F - 0.9F + 1.0F, carried_step_n(-0.85F, 1.0F));
    NEAR(7.0F - 0.5F + 1.8F, carried_step_n(-2.0F, 0.0F));
    (void)carried_step_n(3.0F, 1.95F);
    NEAR(2.0F, f.bounds.felt_n);
}

void test_a_doubted_accelerometer_does_not_free_a_climb_at_take_off(void)
{
    f.evidence.doubts = DOUBT_IMU;
    TEST_ASSERT_TRUE(climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.0F) < 9.0F);
}
