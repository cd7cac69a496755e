/* What an empty battery orders, and nothing else does. */
#include "control/battery_orders.h"

#include <string.h>

#include "unity.h"

#define CYCLE_US UINT32_C(25000)

static battery_orders_t orders;
static flight_outputs_t before;
static flight_inputs_t in;
static float operator_m;
static uint32_t operator_sequence;

static void step(battery_verdict_t verdict);

void setUp(void)
{
    memset(&orders, 0, sizeof orders);
    memset(&in, 0, sizeof in);
    before = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    before.state = FLIGHT_FLYING;
    operator_m = 0.6F;
    operator_sequence = 1U;
    step(BATTERY_GOOD);
}

void tearDown(void) {}

static void step(battery_verdict_t verdict)
{
    in.now_us += CYCLE_US;
    in.reference_m = operator_m;
    in.reference_sequence = operator_sequence;
    battery_orders_step(&orders, verdict, &before, &in);
}

static void steps(battery_verdict_t verdict, int count)
{
    for (int i = 0; i < count; i++) {
        step(verdict);
    }
}

void test_nothing_but_an_empty_battery_orders(void)
{
    for (int verdict = 0; verdict < BATTERY_VERDICT_COUNT; verdict++) {
        setUp();
        steps((battery_verdict_t)verdict, 1000);
        TEST_ASSERT_EQUAL_FLOAT(verdict == BATTERY_EMPTY ? 0.0F : 0.6F, in.reference_m);
        TEST_ASSERT_EQUAL_UINT32(verdict == BATTERY_EMPTY ? 2U : 1U, in.reference_sequence);
    }
}

void test_it_orders_once_in_every_state_that_flies_and_in_no_other(void)
{
    for (int state = 0; state < FLIGHT_STATE_COUNT; state++) {
        const bool flies = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_FLOATING ||
                           state == FLIGHT_COASTING || state == FLIGHT_LOWERING;

        setUp();
        steps(BATTERY_GOOD, 10);
        before.state = (flight_state_t)state;
        steps(BATTERY_EMPTY, 1000);
        TEST_ASSERT_EQUAL_UINT32(flies ? 2U : 1U, in.reference_sequence);
        TEST_ASSERT_EQUAL_FLOAT(flies ? 0.0F : 0.6F, in.reference_m);
    }
}

void test_who_orders_otherwise_in_the_air_has_ten_seconds(void)
{
    steps(BATTERY_EMPTY, 10);
    before.state = FLIGHT_LANDING;
    steps(BATTERY_EMPTY, 10);
    operator_sequence++;
    operator_m = 0.4F;
    step(BATTERY_EMPTY);
    before.state = FLIGHT_FLYING;
    steps(BATTERY_EMPTY, 395);
    TEST_ASSERT_EQUAL_FLOAT(0.4F, in.reference_m);
    const uint32_t sequence = in.reference_sequence;
    steps(BATTERY_EMPTY, 10);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.reference_m);
    TEST_ASSERT_EQUAL_UINT32(sequence + 1U, in.reference_sequence);
}

/* BAT NONE in the air: it flies on by what is ordered next. */
void test_switched_off_it_orders_nothing_more(void)
{
    steps(BATTERY_EMPTY, 10);
    operator_sequence++;
    steps(BATTERY_OFF, 10);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, in.reference_m);
    steps(BATTERY_OFF, 1000);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, in.reference_m);
}

void test_on_the_ground_an_empty_battery_takes_no_reference(void)
{
    before.state = FLIGHT_GROUND;
    operator_sequence++;
    steps(BATTERY_EMPTY, 10);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.reference_m);
    TEST_ASSERT_TRUE(battery_orders_forbid(BATTERY_EMPTY, FLIGHT_GROUND));
    TEST_ASSERT_FALSE(battery_orders_forbid(BATTERY_EMPTY, FLIGHT_FLYING));
    TEST_ASSERT_FALSE(battery_orders_forbid(BATTERY_LOW, FLIGHT_GROUND));
    steps(BATTERY_GOOD, 10); /* another battery: not by an order of before */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.reference_m);
    operator_sequence++;
    step(BATTERY_GOOD);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, in.reference_m);
}

void test_a_flight_that_a_pilot_begins_after_a_landing_lands_too(void)
{
    steps(BATTERY_EMPTY, 10);
    before.state = FLIGHT_GROUND;
    steps(BATTERY_EMPTY, 10);
    const uint32_t sequence = in.reference_sequence;
    before.state = FLIGHT_FLOATING;
    steps(BATTERY_EMPTY, 10);
    TEST_ASSERT_EQUAL_UINT32(sequence + 1U, in.reference_sequence);
}

/* The operator's order comes in the cycle in which the battery is found empty: nobody sees the same sequence
 * twice with two meanings. */
void test_an_order_of_the_same_cycle_is_not_lost(void)
{
    steps(BATTERY_LOW, 10);
    operator_sequence++;
    operator_m = 0.9F;
    step(BATTERY_EMPTY);
    TEST_ASSERT_EQUAL_FLOAT(0.9F, in.reference_m);
    TEST_ASSERT_EQUAL_UINT32(2U, in.reference_sequence);
    steps(BATTERY_EMPTY, 500);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.reference_m);
}

void test_a_long_pause_and_the_clocks_wrap_do_not_shorten_the_ten_seconds(void)
{
    in.now_us = UINT32_MAX - 3U * CYCLE_US;
    steps(BATTERY_EMPTY, 2);
    operator_sequence++;
    step(BATTERY_EMPTY);
    in.now_us += UINT32_C(60000000);
    step(BATTERY_EMPTY);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, in.reference_m);
}
