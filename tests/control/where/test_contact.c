#include "control/touchdown.h"
#include "control/where/contact.h"
#include "unity.h"

#include <string.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)

static contact_t contact;
static contact_signs_t signs;
static landing_signs_t landing;

void setUp(void)
{
    memset(&contact, 0, sizeof contact);
    signs = (contact_signs_t){.state = FLIGHT_GROUND};
    landing = (landing_signs_t){
        .state = FLIGHT_LANDING, .height_m = 0.03F, .powered = true, .sees = true, .step_s = 0.1F};
}

void tearDown(void) {}

static contact_kind_t step(flight_state_t state)
{
    signs.state = state;
    contact_step(&contact, &signs);
    return contact.kind;
}

static void fly(bool airborne)
{
    if (airborne) {
        contact_fly(&contact);
    } else {
        contact_end_flight(&contact);
    }
}

/* On the ground, then in this state. */
static contact_kind_t from_ground(flight_state_t state, bool airborne, bool risen, bool sways)
{
    (void)step(FLIGHT_GROUND);
    signs = (contact_signs_t){.risen = risen, .sways = sways};
    fly(airborne);
    return step(state);
}

void test_a_take_off_lifts_until_the_estimate_has_left_the_ground(void)
{
    TEST_ASSERT_EQUAL(CONTACT_GROUND, step(FLIGHT_GROUND));
    TEST_ASSERT_FALSE(contact_lifts(&contact));
    TEST_ASSERT_EQUAL(CONTACT_LIFTING, from_ground(FLIGHT_TAKEOFF, false, true, true));
    TEST_ASSERT_TRUE(contact_lifts(&contact));
    TEST_ASSERT_EQUAL(CONTACT_LIFTING, step(FLIGHT_FLYING));
    TEST_ASSERT_EQUAL(CONTACT_AIR, from_ground(FLIGHT_TAKEOFF, true, false, false));
    TEST_ASSERT_EQUAL(CONTACT_AIR, from_ground(FLIGHT_FLYING, true, false, false));
    fly(false); /* and it does not stand again before the ground */
    TEST_ASSERT_EQUAL(CONTACT_AIR, step(FLIGHT_FLYING));
}

/* A pilot who takes the throttle during a take-off makes it FLOATING on the ground. */
void test_a_vehicle_that_floats_may_stand_until_it_has_risen_or_sways(void)
{
    static const struct {
        flight_state_t state;
        bool risen, sways;
        contact_kind_t then;
    } rows[] = {{FLIGHT_FLOATING, false, false, CONTACT_LIFTING},
                {FLIGHT_FLOATING, true, false, CONTACT_AIR},
                {FLIGHT_FLOATING, false, true, CONTACT_AIR},
                {FLIGHT_LANDING, false, false, CONTACT_AIR}};

    for (int i = 0; i < 4; i++) {
        setUp();
        (void)from_ground(rows[i].state, true, rows[i].risen, rows[i].sways);
        fly(false);
        signs = (contact_signs_t){.risen = false}; /* then it flies for the firmware */
        TEST_ASSERT_EQUAL(rows[i].then, step(FLIGHT_FLYING));
    }
}

/* Touching as long as the limit of touchdown.h says, so it is asked for by that limit. */
static float thrust_after_n(flight_state_t state, float height_m)
{
    landing.state = state;
    landing.height_m = height_m;
    contact_watch(&contact, &landing);
    return touchdown_limit_n(contact.touching_s, 7.0F);
}

void test_a_landing_near_the_ground_goes_on_there_while_heights_are_missing(void)
{
    TEST_ASSERT_FLOAT_IS_INF(
        thrust_after_n(FLIGHT_DESCENDING, 0.03F)); /* before the landing: tells nothing */
    TEST_ASSERT_FLOAT_IS_INF(thrust_after_n(FLIGHT_LANDING, 0.041F));
    NEAR(7.3F, thrust_after_n(FLIGHT_LANDING, 0.039F)); /* 0.5 N above, after 0.1 s at 2 N/s */
    TEST_ASSERT_EQUAL(CONTACT_TOUCHING, contact.kind);
    NEAR(7.1F, thrust_after_n(FLIGHT_DESCENDING, 0.039F));
    NEAR(6.9F, thrust_after_n(FLIGHT_LANDING, 0.039F));
    TEST_ASSERT_FLOAT_IS_INF(thrust_after_n(FLIGHT_LANDING, 0.101F));
    TEST_ASSERT_EQUAL(CONTACT_AIR, contact.kind);
    NEAR(7.3F, thrust_after_n(FLIGHT_LANDING, 0.03F));
    landing.sees = false;
    TEST_ASSERT_FLOAT_IS_INF(thrust_after_n(FLIGHT_LANDING, 0.03F));
    landing.sees = true;
    NEAR(7.3F, thrust_after_n(FLIGHT_LANDING, 0.03F));
    TEST_ASSERT_FLOAT_IS_INF(thrust_after_n(FLIGHT_LOWERING, 0.03F));
}

void test_a_tilt_that_moves_as_in_flight_makes_the_end_slow(void)
{
    landing.step_s = 1.0F;
    landing.rocks = true;
    const float first_n = thrust_after_n(FLIGHT_LANDING, 0.03F);
    const float then_n = thrust_after_n(FLIGHT_LANDING, 0.03F);
    landing.rocks = false;
    TEST_ASSERT_TRUE(first_n - then_n < 0.5F * (then_n - thrust_after_n(FLIGHT_LANDING, 0.03F)));
}

void test_a_landing_ends_after_more_than_a_second_without_thrust(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        (void)thrust_after_n(FLIGHT_LANDING, (i == 2) ? 0.5F : 0.03F);
        landing.powered = false;
        for (int k = 0; k < 9; k++) {
            (void)thrust_after_n(FLIGHT_LANDING, landing.height_m);
        }
        TEST_ASSERT_FALSE(contact_ends_without_thrust(&contact));
        landing.powered = i == 1;
        landing.step_s = 0.09F;
        (void)thrust_after_n(FLIGHT_LANDING, landing.height_m);
        TEST_ASSERT_FALSE(contact_ends_without_thrust(&contact));
        landing.powered = false;
        landing.step_s = 0.02F;
        (void)thrust_after_n(FLIGHT_LANDING, landing.height_m);
        TEST_ASSERT_EQUAL(i == 0, contact_ends_without_thrust(&contact));
    }
}

void test_without_thrust_it_stands_also_where_one_foot_or_a_slope_shows_more_than_level_ground(void)
{
    for (int height_mm = 10; height_mm < 120; height_mm += 5) {
        setUp();
        landing.powered = false;
        for (int k = 0; k < 11; k++) {
            (void)thrust_after_n(FLIGHT_LANDING, 0.001F * (float)height_mm);
        }
        TEST_ASSERT_EQUAL_MESSAGE(height_mm < 90, contact_ends_without_thrust(&contact), "height");
    }
}

static void watch(flight_state_t state, uint32_t state_us)
{
    contact_watch(&contact, &(landing_signs_t){.state = state, .state_us = state_us});
}

void test_a_take_off_that_ends_on_the_ground_stops_there(void)
{
    static const struct {
        flight_state_t state;
        uint32_t takeoff_us;
        bool airborne, stops;
    } rows[] = {{FLIGHT_COASTING, 2999999U, false, true}, {FLIGHT_DESCENDING, 0U, false, true},
                {FLIGHT_LANDING, 0U, false, true},        {FLIGHT_FLYING, 0U, false, false},
                {FLIGHT_GROUND, 0U, false, false},        {FLIGHT_LANDING, 3000000U, false, false},
                {FLIGHT_LANDING, 0U, true, false}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        fly(rows[i].airborne);
        watch(FLIGHT_TAKEOFF, rows[i].takeoff_us);
        TEST_ASSERT_FALSE(contact_stops(&contact, FLIGHT_TAKEOFF));
        watch(rows[i].state, 0U);
        TEST_ASSERT_EQUAL(rows[i].stops, contact_stops(&contact, rows[i].state));
        TEST_ASSERT_EQUAL(rows[i].stops, contact_ends_without_thrust(&contact));
        watch(FLIGHT_LANDING, 0U);
        TEST_ASSERT_EQUAL(rows[i].stops, contact_stops(&contact, FLIGHT_LANDING)); /* and later */
        contact_lift_off(&contact); /* it has left the ground after all */
        TEST_ASSERT_FALSE(contact_stops(&contact, FLIGHT_LANDING));
    }
}
