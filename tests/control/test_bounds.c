#include "control/bounds.h"
#include "flight_case.h"

static bounds_t bounds;

void setUp(void)
{
    begin();
    memset(&bounds, 0, sizeof bounds);
}

void tearDown(void) {}

/* All limits, and what floating adds. */
static float bounded_n(float thrust_n)
{
    return bounds_apply(&bounds, &now, thrust_n);
}

void test_full_thrust_is_told_also_where_the_law_asks_for_no_more_than_there_is(void)
{
    (void)bounded_n(THRUST_MAX_N);
    TEST_ASSERT_EQUAL(BOUND_ACTUATOR, bounds.holds);
    (void)bounded_n(THRUST_MAX_N - 0.01F);
    TEST_ASSERT_EQUAL(BOUND_NONE, bounds.holds);
}

void test_an_estimate_that_no_height_has_checked_coasts_near_the_hover_thrust(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        hovers_at_n(7.2F);
        in_state((i == 1) ? FLIGHT_FLYING : FLIGHT_COASTING);
        if (i != 2) {
            unchecked();
        }
        NEAR((i == 0) ? 7.7F : 9.0F, bounded_n(9.0F));
        NEAR((i == 0) ? 6.2F : 5.0F, bounded_n(5.0F));
        NEAR(7.5F, bounded_n(7.5F));
    }
}

/* In FLYING, until its heights count as lost. A thrust that brakes a climb is free. */
void test_an_estimate_whose_heights_have_just_been_doubted_does_not_push_up(void)
{
    hovers_at_n(7.2F);
    in_state(FLIGHT_FLYING);
    NEAR(11.0F, bounded_n(11.0F));
    evidence.doubts = DOUBT_SIGHT;
    NEAR(7.7F, bounded_n(11.0F));
    NEAR(4.0F, bounded_n(4.0F));
}

/* FLOATING without a pin, 0.5 m high, has added so much: 8 N/(m s) in a cycle of 0.1 s. */
static void has_added_n(float trim_n)
{
    in_state(FLIGHT_FLOATING);
    unknown(true);
    now.aim_m = 0.5F + trim_n / 0.8F;
    (void)bounds_apply(&bounds, &now, GRAV_N);
}

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
        has_added_n(rows[i].before_n);
        mode_is(rows[i].est ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_FLOAT);
        now.aim_m = rows[i].floating_m;
        accelerations_come(rows[i].felt);
        commands_show(rows[i].shown);
        NEAR(6.8F + rows[i].added_n, bounded_n(6.8F));
        NEAR(rows[i].added_n, bounds.trim_n);
        NEAR(7.0F, where.hover.thrust_n);
    }
    setUp(); /* the limit of all of it */
    has_added_n(0.4F);
    now.aim_m = 0.6F;
    NEAR(9.0F, bounded_n(8.9F));
}

#define HIGH_MM LOW_MM /* the least at which it does not stand by its heights */

/* A law that wants 11 N, of a vehicle with 2 m/s2 per newton less or more and a damping of 2.5 1/s. */
static float climbing_n(float height_mm, flight_mode_t mode, bool unconfirmed, float pushed_mps,
                        float felt_mps)
{
    in_state(FLIGHT_FLYING);
    at_mm(height_mm);
    mode_is(mode);
    evidence.unshown.climb = unconfirmed;
    evidence.push_mps = pushed_mps;
    feel(felt_mps);
    return bounded_n(11.0F);
}

void test_a_climb_has_a_thrust_by_the_vehicles_model(void)
{
    evidence.unshown.first_climb = true;
    const float per_mps = 2.5F * 7.0F / 9.80665F; /* newtons against the drag of 1 m/s */
    NEAR(7.0F + 0.3F * per_mps, climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.0F));
    NEAR(11.0F, climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 0.29F, 0.0F));
    NEAR(11.0F, climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, false, 2.0F, 0.0F));
    NEAR(7.0F + 0.3F * per_mps, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.30001F));
    evidence.felt_valid = false; /* a Razor without accelerations */
    NEAR(11.0F, bounded_n(11.0F));
    NEAR(11.0F, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.29F, 0.31F));
    NEAR(11.0F, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.29F));
    evidence.doubts = DOUBT_IMU; /* then the thrust alone tells */
    NEAR(7.0F + 0.3F * per_mps, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.0F));
    evidence.doubts = 0U;
    where.supervisor.height.age_us = HEIGHT_FRESH_US + 1U; /* nor does an old height show the ground */
    NEAR(7.0F + 0.3F * per_mps, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.0F));
    where.supervisor.height.age_us = 0U;
    evidence.unshown.first_climb = false; /* blocked in flight, so that they show the ground */
    NEAR(7.0F + 0.3F * per_mps, climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.31F, 0.0F));
    evidence.unshown.first_climb = true;
    NEAR(11.0F, climbing_n(HIGH_MM, FLIGHT_MODE_LAW, true, 0.4F, 0.0F)); /* law EST does not fly */
    NEAR(11.0F, climbing_n(HIGH_MM, FLIGHT_MODE_DESCENT, true, 0.4F, 0.0F));
    now.law = LAW_PIDT;
    NEAR(7.0F + 0.3F * per_mps, climbing_n(HIGH_MM, FLIGHT_MODE_LAW, true, 0.4F, 0.0F));
    NEAR(11.0F, climbing_n(HIGH_MM, FLIGHT_MODE_FLOAT, true, 0.4F, 0.0F));
    NEAR(6.5F, bounded_n(6.5F));
}

/* 8 1/s of VELK: an error of 0.1 m/s asks for 0.8 m/s2. */
static float braking_n(float climb_mps)
{
    const float mps2_per_n = 9.80665F / 7.0F;

    return 7.0F + (2.5F * climb_mps + 8.0F * (0.3F - climb_mps)) / mps2_per_n;
}

void test_a_climb_that_thrust_and_accelerometer_tell_is_braked_by_the_less_of_both(void)
{
    evidence.unshown.first_climb = true;
    NEAR(braking_n(0.33F), climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 0.33F, 0.5F));
    NEAR(braking_n(0.33F), climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 0.5F, 0.33F));
    NEAR(braking_n(0.33F), climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.5F, 0.33F));
    NEAR(6.5F, climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 2.0F, 2.0F)); /* as a slow descent */
    evidence.rise_mps = 0.151F;                                              /* the heights show it */
    NEAR(braking_n(0.3F), climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 2.0F, 2.0F));
    evidence.rise_mps = 0.149F;
    NEAR(6.5F, climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 2.0F, 2.0F));
    parameters.value[PARAMETER_VELK] = 2.0F; /* less than the damping: no more than a slow climb needs */
    NEAR(braking_n(0.3F), climbing_n(HIGH_MM, FLIGHT_MODE_EST_HOLD, true, 2.0F, 2.0F));
}

void test_a_descent_over_a_far_fall_of_the_terrain_has_one_too(void)
{
    const float least_n = 7.0F - 0.3F * 2.5F * 7.0F / 9.80665F;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.unshown.descent = true;
    NEAR(least_n, bounded_n(3.0F));
    NEAR(8.0F, bounded_n(8.0F));
    mode_is(FLIGHT_MODE_LAW);
    NEAR(3.0F, bounded_n(3.0F));
    now.law = LAW_PIDT;
    NEAR(least_n, bounded_n(3.0F));
    mode_is(FLIGHT_MODE_FLOAT);
    NEAR(3.0F, bounded_n(3.0F));
}

void test_a_descent_has_one_for_a_second_while_all_mirrors_may_lie_and_it_sinks(void)
{
    const float least_n = 7.0F - 0.3F * 2.5F * 7.0F / 9.80665F;

    evidence.push_mps = -0.01F;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.mirrors.suspected = true;
    NEAR(least_n, bounded_n(3.0F));
    NEAR(8.0F, bounded_n(8.0F));
    evidence.doubts = DOUBT_SIGHT;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.doubts = 0U;
    evidence.push_mps = 0.01F;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.push_mps = -0.01F;
    for (int k = 0; k < 9; k++) { /* cycles of 0.1 s */
        NEAR(least_n, bounded_n(3.0F));
    }
    (void)bounded_n(3.0F);
    NEAR(3.0F, bounded_n(3.0F));
}

/* Heights that stand still hide how fast it sinks. */
void test_a_descent_that_the_heights_do_not_show_is_braked_by_the_speed_without_them(void)
{
    evidence.unshown.descent = true;
    evidence.speed_mps = -0.3F;
    NEAR(7.0F - 0.3F * 2.5F * 7.0F / 9.80665F, bounded_n(3.0F));
    evidence.speed_mps = -0.33F;
    NEAR(7.0F + (2.5F * -0.33F + 8.0F * 0.03F) * 7.0F / 9.80665F, bounded_n(3.0F));
    NEAR(8.0F, bounded_n(8.0F));
    evidence.speed_mps = -1.0F;
    NEAR(7.5F, bounded_n(3.0F));                                          /* no harder than a slow climb */
    for (float rise_mps = -0.151F; rise_mps < 0.2F; rise_mps += 0.302F) { /* heights that move show it */
        evidence.rise_mps = rise_mps;
        NEAR(7.0F - 0.3F * 2.5F * 7.0F / 9.80665F, bounded_n(3.0F));
    }
    evidence.unshown.descent = false;
    NEAR(3.0F, bounded_n(3.0F));
}

/* LOWERING ends a climb that the hover thrust may have made: a bound by that thrust would keep it up. */
void test_what_is_lowered_is_braked_only_where_it_falls_and_the_heights_stand_still(void)
{
    in_state(FLIGHT_LOWERING);
    mode_is(FLIGHT_MODE_EST_LAND);
    evidence.unshown.descent = true;
    evidence.speed_mps = -0.3F;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.speed_mps = -0.33F;
    NEAR(7.0F + (2.5F * -0.33F + 8.0F * 0.03F) * 7.0F / 9.80665F, bounded_n(3.0F));
    evidence.rise_mps = 0.151F; /* an accelerometer that lies: it climbs by this bound */
    NEAR(3.0F, bounded_n(3.0F));
    evidence.rise_mps = 0.0F;
    in_state(FLIGHT_LANDING);
    NEAR(3.0F, bounded_n(3.0F));
}

void test_a_thrust_in_doubt_stays_near_the_held_one_on_one_side(void)
{
    evidence.doubts = DOUBT_THRUST;
    evidence.held.hover_n = 7.2F;
    NEAR(7.7F, bounded_n(11.0F));
    NEAR(3.0F, bounded_n(3.0F));
    evidence.held.down = true;
    NEAR(6.7F, bounded_n(3.0F));
    NEAR(11.0F, bounded_n(11.0F));
    in_state(FLIGHT_LANDING);
    NEAR(6.7F - 0.02F, bounded_n(3.0F)); /* 0.2 N/s */
    cycle_takes_us(5000000U);
    NEAR(6.7F - 0.12F, bounded_n(3.0F)); /* of 0.5 s at most */
    mode_is(FLIGHT_MODE_IDLE);
    NEAR(0.0F, bounded_n(0.0F));
    mode_is(FLIGHT_MODE_EST_LAND);
    in_state(FLIGHT_FLYING);
    NEAR(6.7F, bounded_n(3.0F)); /* no longer */
    in_state(FLIGHT_LANDING);
    NEAR(6.7F - 0.1F, bounded_n(3.0F));
    evidence.doubts = DOUBT_SIGHT;
    NEAR(3.0F, bounded_n(3.0F));
    evidence.doubts = DOUBT_THRUST;
    NEAR(6.7F - 0.1F, bounded_n(3.0F)); /* anew */
}

void test_where_a_pilot_may_fly_the_thrust_is_within_two_newtons_of_hover(void)
{
    in_state(FLIGHT_FLOATING);
    now.aim_m = 0.5F;
    unknown(true);
    NEAR(9.0F, bounded_n(11.0F));
    NEAR(5.0F, bounded_n(3.0F));
    NEAR(7.5F, bounded_n(7.5F));
    in_state(FLIGHT_LANDING); /* which sinks by 0.2 N/s more */
    NEAR(4.98F, bounded_n(3.0F));
    NEAR(4.96F, bounded_n(3.0F));
    NEAR(9.0F, bounded_n(11.0F));
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
        NEAR(8.0F, bounded_n(8.0F)); /* it does not seem to stand */
        mode_is(rows[i].mode);
        evidence.doubts = rows[i].doubts;
        evidence.may_stand = rows[i].still;
        now.thrust_n = 6.1F;
        NEAR(rows[i].tries ? 6.0F : 8.0F, bounded_n(8.0F));
        now.thrust_n = 6.5F; /* it does not rise again */
        NEAR(rows[i].tries ? 5.9F : 8.0F, bounded_n(8.0F));
        NEAR(3.0F, bounded_n(3.0F));
    }
    setUp();
    (void)bounded_n(8.0F);
    mode_is(FLIGHT_MODE_EST_SINK);
    evidence.may_stand = true;
    now.thrust_n = 6.5F;
    NEAR(6.4F, bounded_n(8.0F));
    cycle_takes_us(5000000U);
    NEAR(5.9F, bounded_n(8.0F)); /* of 0.5 s at most */
    evidence.may_stand = false;
    NEAR(8.0F, bounded_n(8.0F)); /* it felt a fall */
    evidence.may_stand = true;
    NEAR(6.0F, bounded_n(8.0F)); /* anew */
    now.thrust_n = 0.05F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, bounded_n(8.0F));
}

void test_the_thrust_fades_out_while_contact_says_touching(void)
{
    const landing_signs_t low = {
        .state = FLIGHT_LANDING, .height_m = 0.039F, .powered = true, .sees = true, .step_s = 0.1F};
    NEAR(8.0F, bounded_n(8.0F));
    contact_watch(&where.contact, &low);
    NEAR(7.3F, bounded_n(8.0F)); /* 0.5 N above hover, after 0.1 s at 2 N/s */
    contact_watch(&where.contact, &low);
    NEAR(7.1F, bounded_n(8.0F));
    NEAR(3.0F, bounded_n(3.0F));
}

/* A descent out of a pilot's hands, for state_us: one step of 0.1 s with a felt speed, after felt climbs that
 * have lowered the thrust by before_n. */
static float given_back_n(uint32_t state_us, float felt_mps, float before_n)
{
    setUp();
    given_back(0.06F);
    in_state_for_us(FLIGHT_DESCENDING, state_us);
    estimated(0.0F, 0.3F + before_n, 0.0F); /* 2 N per metre beyond 0.3 m/s, for half a second */
    cycle_takes_us(500000U);
    (void)bounded_n(3.0F);
    cycle_takes_us(100000U);
    estimated(0.0F, felt_mps, 0.0F);
    return bounded_n(3.0F);
}

/* What felt climbs have lowered after that step. */
static float lowered_n(void)
{
    estimated(0.0F, 0.0F, 0.0F);
    return GRAV_N - 0.5F - bounded_n(3.0F);
}

void test_a_vehicle_given_back_without_heights_has_a_thrust_below_hover_that_sinks(void)
{
    NEAR(7.0F - 0.5F - 0.6F, given_back_n(10000000U, 0.3F, 0.0F));
    NEAR(7.0F - 0.5F - 0.6F - 0.4F, given_back_n(10000000U, -0.3F, 0.4F));
    NEAR(7.0F - 0.5F - 1.5F, given_back_n(50000000U, 0.0F, 0.0F));
}

void test_a_vehicle_given_back_that_feels_a_climb_gives_less_and_a_fall_more(void)
{
    const float per_mps = 2.5F * 7.0F / 9.80665F;                     /* what the drag of 1 m/s takes */
    NEAR(7.0F - 0.5F - 0.2F - per_mps, given_back_n(0U, 1.3F, 0.0F)); /* 1 m/s beyond: 2 N in a second */
    NEAR(0.2F, lowered_n());
    NEAR(7.0F - 0.5F + 0.5F * per_mps, given_back_n(0U, -0.8F, 0.0F));
    NEAR(0.0F, lowered_n()); /* no more than what climbs have lowered */
    NEAR(7.0F - 0.5F - 0.9F + 0.5F * per_mps, given_back_n(0U, -0.8F, 1.0F));
    NEAR(7.0F - 0.5F + 2.0F, given_back_n(0U, -2.0F, 0.0F));
    (void)given_back_n(0U, 3.0F, 1.95F);
    NEAR(2.0F, lowered_n());
}

void test_what_felt_climbs_have_lowered_ends_with_the_descent(void)
{
    const pilot_signs_t flies = {.state = FLIGHT_FLYING, .has_throttle = true};

    (void)given_back_n(0U, 0.0F, 1.0F);
    (void)pilot_step(&where.pilot, &flies);
    in_state(FLIGHT_FLYING);
    (void)bounded_n(7.0F);
    given_back(0.06F);
    in_state(FLIGHT_DESCENDING);
    NEAR(0.0F, lowered_n());
}

void test_a_doubted_accelerometer_does_not_free_a_climb_at_take_off(void)
{
    evidence.doubts = DOUBT_IMU;
    TEST_ASSERT_TRUE(climbing_n(LOW_MM - 0.01F, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.0F) < 9.0F);
}
