/* When the motors idle instead of standing still. */
#include "control/arming.h"

#include "unity.h"

#include <string.h>

static arming_t arming;
static flight_inputs_t in;
static supervisor_t supervisor;

void setUp(void)
{
    memset(&arming, 0, sizeof arming);
    in = (flight_inputs_t){.now_us = 0U};
    supervisor_init(&supervisor);
}

void tearDown(void) {}

static void step_from(flight_state_t before)
{
    arming_step(&arming, &in, before, &supervisor);
}

static bool armed(void)
{
    return arming_idle_n(&arming, 100.0F, FLIGHT_GROUND) > 0.0F;
}

static void state(flight_state_t is)
{
    supervisor.state = is;
}

static void flags(uint16_t are)
{
    supervisor.flags = are;
}

static void reference(float is_m)
{
    supervisor.reference_m = is_m;
}

static void step(void)
{
    step_from(supervisor.state);
}

static void wish(bool arm)
{
    in.arm = arm;
    in.arm_sequence++;
    step();
}

static void enter(flight_state_t next)
{
    const flight_state_t before = supervisor.state;

    state(next);
    step_from(before);
}

void test_nothing_arms_but_the_wish_and_then_it_stays(void)
{
    for (int i = 0; i < 100; i++) {
        step();
        TEST_ASSERT_FALSE(armed());
    }
    wish(true);
    for (int i = 0; i < 100; i++) {
        step();
        TEST_ASSERT_TRUE(armed());
    }
    wish(true);
    TEST_ASSERT_TRUE(armed());
}

void test_a_wish_in_the_air_comes_to_nothing(void)
{
    state(FLIGHT_FLOATING);
    wish(true);
    TEST_ASSERT_FALSE(armed());
    enter(FLIGHT_GROUND);
    TEST_ASSERT_FALSE(armed());
}

void test_a_whole_flight_keeps_it_armed_for_the_next(void)
{
    static const flight_state_t flight[] = {FLIGHT_TAKEOFF, FLIGHT_FLYING, FLIGHT_COASTING, FLIGHT_LOWERING,
                                            FLIGHT_LANDING, FLIGHT_GROUND, FLIGHT_TAKEOFF};

    wish(true);
    for (uint16_t i = 0; i < sizeof flight / sizeof flight[0]; i++) {
        enter(flight[i]);
        TEST_ASSERT_TRUE(armed());
    }
}

void test_a_stop_disarms_at_once_on_the_ground_and_in_the_air_after_the_landing(void)
{
    wish(true);
    wish(false);
    TEST_ASSERT_FALSE(armed());
    wish(true);
    enter(FLIGHT_FLYING);
    wish(false);
    TEST_ASSERT_TRUE(armed());
    enter(FLIGHT_LANDING);
    TEST_ASSERT_TRUE(armed());
    enter(FLIGHT_GROUND);
    TEST_ASSERT_FALSE(armed());
}

void test_a_new_reference_before_the_ground_calls_the_stop_off(void)
{
    wish(true);
    enter(FLIGHT_FLYING);
    wish(false);
    enter(FLIGHT_LANDING);
    reference(0.6F);
    enter(FLIGHT_FLYING);
    reference(0.0F);
    enter(FLIGHT_LANDING);
    enter(FLIGHT_GROUND);
    TEST_ASSERT_TRUE(armed());
}

void test_faults_disarm(void)
{
    wish(true);
    enter(FLIGHT_CUT);
    TEST_ASSERT_FALSE(armed());
    state(FLIGHT_GROUND);
    wish(true);
    enter(FLIGHT_DESCENDING);
    TEST_ASSERT_TRUE(armed());
    enter(FLIGHT_GROUND); /* nobody has seen the ground */
    TEST_ASSERT_FALSE(armed());
    for (uint16_t i = 0; i < 2U; i++) {
        flags(0U);
        wish(true);
        TEST_ASSERT_TRUE(armed());
        flags((i == 0U) ? FLIGHT_FLAG_LINK : FLIGHT_FLAG_TILT);
        step();
        TEST_ASSERT_FALSE(armed());
    }
    flags(0U);
    wish(true);
    flags(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_ATTITUDE);
    step();
    TEST_ASSERT_TRUE_MESSAGE(armed(), "a sensor that is silent on the ground harms nobody");
}

void test_a_silent_link_in_the_air_lands_first(void)
{
    wish(true);
    state(FLIGHT_LANDING);
    flags(FLIGHT_FLAG_LINK);
    step();
    TEST_ASSERT_TRUE(armed());
    enter(FLIGHT_GROUND);
    TEST_ASSERT_FALSE(armed());
}

void test_the_idle_is_a_share_of_the_throttle_while_armed_and_none_in_cut(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, arming_idle_n(&arming, 15.0F, FLIGHT_GROUND));
    wish(true);
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, 1.764F, arming_idle_n(&arming, 15.0F, FLIGHT_GROUND));
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, 1.764F, arming_idle_n(&arming, 15.0F, FLIGHT_FLYING));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, arming_idle_n(&arming, 0.0F, FLIGHT_GROUND));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, arming_idle_n(&arming, 15.0F, FLIGHT_CUT));
}

void test_any_reference_at_all_takes_a_stop_back(void)
{
    wish(true);
    enter(FLIGHT_FLYING);
    wish(false);
    reference(0.0005F);
    step();
    reference(0.0F);
    enter(FLIGHT_GROUND);
    TEST_ASSERT_TRUE(armed());
}

void test_a_stop_ends_with_its_disarming(void)
{
    wish(true);
    enter(FLIGHT_FLYING);
    wish(false);
    enter(FLIGHT_GROUND);
    TEST_ASSERT_FALSE(armed());
    wish(true);
    step();
    TEST_ASSERT_TRUE(armed());
}

/* ---- the order that a hand-over needs */

void test_a_hand_over_is_ordered_from_the_wish_until_it_leaves_the_ground(void)
{
    step();
    TEST_ASSERT_FALSE(arming.hands_over);
    wish(true);
    TEST_ASSERT_TRUE(arming.hands_over);
    for (int i = 0; i < 100; i++) {
        step();
        TEST_ASSERT_TRUE(arming.hands_over);
    }
    enter(FLIGHT_TAKEOFF);
    TEST_ASSERT_FALSE(arming.hands_over);
    enter(FLIGHT_GROUND);
    TEST_ASSERT_TRUE(armed());
    TEST_ASSERT_FALSE_MESSAGE(arming.hands_over, "of the flight before");
    wish(true);
    TEST_ASSERT_TRUE(arming.hands_over);
}

void test_a_stop_or_a_fault_takes_that_order_back(void)
{
    wish(true);
    wish(false);
    TEST_ASSERT_FALSE(arming.hands_over);
    wish(true);
    flags(FLIGHT_FLAG_TILT);
    step();
    TEST_ASSERT_FALSE(arming.hands_over);
    flags(0U);
    step();
    TEST_ASSERT_FALSE(arming.hands_over);
}

void test_a_wish_in_the_air_orders_no_hand_over(void)
{
    wish(true);
    enter(FLIGHT_FLOATING);
    wish(true);
    enter(FLIGHT_GROUND);
    TEST_ASSERT_FALSE(arming.hands_over);
}
