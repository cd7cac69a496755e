#include "firmware/ground.h"

#include "mock_servers.h"
#include "unity.h"

static flight_outputs_t flight;
static reference_sample_t reference;

static void read_flight(flight_outputs_t *status, int calls)
{
    (void)calls;
    *status = flight;
}

static void read_reference(reference_sample_t *sample, int calls)
{
    (void)calls;
    *sample = reference;
}

void setUp(void)
{
    flight = (flight_outputs_t){.state = FLIGHT_GROUND};
    reference = (reference_sample_t){.reference_m = 0.0F};
    flight_status_server_read_Stub(read_flight);
    reference_server_read_Stub(read_reference);
}

void tearDown(void) {}

void test_on_the_ground_without_thrust_and_reference_it_is_idle(void)
{
    TEST_ASSERT_TRUE(ground_idle());
    TEST_ASSERT_TRUE(ground_waits());
}

void test_in_any_other_state_it_is_not(void)
{
    for (int state = FLIGHT_GROUND + 1; state < FLIGHT_STATE_COUNT; state++) {
        flight.state = (flight_state_t)state;
        TEST_ASSERT_FALSE(ground_idle());
    }
}

void test_thrust_is_not_idle(void)
{
    flight.thrust_n = 0.17F;
    TEST_ASSERT_FALSE(ground_idle());
}

void test_armed_motors_that_idle_wait_and_more_thrust_does_not(void)
{
    flight.idle_n = flight.thrust_n = 1.764F;
    TEST_ASSERT_FALSE(ground_idle());
    TEST_ASSERT_TRUE(ground_waits());
    flight.thrust_n = 1.93F;
    TEST_ASSERT_FALSE(ground_waits());
    flight.thrust_n = flight.idle_n;
    flight.state = FLIGHT_FLOATING;
    TEST_ASSERT_FALSE(ground_waits());
    flight.state = FLIGHT_GROUND;
    reference.reference_m = 0.5F;
    TEST_ASSERT_FALSE(ground_waits());
}

void test_a_reference_in_force_or_on_its_way_is_not_idle(void)
{
    flight.reference_m = 0.5F;
    TEST_ASSERT_FALSE(ground_idle());
    flight.reference_m = 0.0F;
    reference.reference_m = 0.5F;
    TEST_ASSERT_FALSE(ground_idle());
}

void test_every_state_but_ground_and_cut_is_in_the_air(void)
{
    for (int state = 0; state < FLIGHT_STATE_COUNT; state++) {
        flight.state = (flight_state_t)state;
        TEST_ASSERT_EQUAL_INT(state != FLIGHT_GROUND && state != FLIGHT_CUT, ground_left());
    }
}

void test_the_smallest_reference_or_thrust_is_not_idle(void)
{
    reference.reference_m = 0.0005F;
    TEST_ASSERT_FALSE(ground_idle());
    TEST_ASSERT_FALSE(ground_waits());
    reference.reference_m = 0.0F;
    flight.reference_m = 0.0005F;
    TEST_ASSERT_FALSE(ground_idle());
    flight.reference_m = 0.0F;
    flight.thrust_n = 0.0005F;
    TEST_ASSERT_FALSE(ground_idle());
}
