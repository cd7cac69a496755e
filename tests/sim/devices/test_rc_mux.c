#include "sim/devices/rc_mux.h"
#include "unity.h"

static rc_mux_t mux;
static unsigned pulses;
static sim_time_t last;

static void autopilot(void *context, sim_time_t high_ns)
{
    TEST_ASSERT_EQUAL_PTR(&mux, context);
    pulses++;
    last = high_ns;
}

void setUp(void)
{
    pulses = 0;
    last = 0;
    rc_mux_init(&mux, autopilot, &mux);
}

void tearDown(void) {}

void test_the_firmware_has_the_throttle_at_first(void)
{
    rc_mux_receiver_pulse(&mux, 1100 * SIM_US);
    TEST_ASSERT_EQUAL_UINT(0, pulses);
    rc_mux_firmware_pulse(&mux, 1405 * SIM_US);
    TEST_ASSERT_EQUAL_UINT(1, pulses);
    TEST_ASSERT_EQUAL_INT64(1405 * SIM_US, last);
}

void test_the_pilot_takes_over_and_gives_back(void)
{
    rc_mux_select(&mux, false);
    rc_mux_firmware_pulse(&mux, 1405 * SIM_US);
    TEST_ASSERT_EQUAL_UINT(0, pulses);
    rc_mux_receiver_pulse(&mux, 1100 * SIM_US);
    TEST_ASSERT_EQUAL_INT64(1100 * SIM_US, last);
    rc_mux_select(&mux, true);
    rc_mux_receiver_pulse(&mux, 1200 * SIM_US);
    TEST_ASSERT_EQUAL_UINT(1, pulses);
    rc_mux_firmware_pulse(&mux, 2 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(2, pulses);
    TEST_ASSERT_EQUAL_INT64(2 * SIM_MS, last);
}

void test_the_firmwares_input_has_the_shape_of_a_pulse_sink(void)
{
    const rc_pulse_t input = rc_mux_firmware_pulse;
    input(&mux, 1 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(1 * SIM_MS, last);
}
