/* The wire of the stick: what it passes on, and how it lies. */
#include "sim/devices/stick_wire.h"

#include <math.h>

#include "unity.h"

#define PULSE (1234 * SIM_US)

static stick_wire_config_t config;
static stick_wire_t wire;

void setUp(void)
{
    config = (stick_wire_config_t)STICK_WIRE_DEFAULT;
    config.connected = 1.0;
}

void tearDown(void) {}

static sim_time_t at(double t_s, sim_time_t pulse)
{
    return stick_wire_pulse(&wire, t_s, pulse);
}

void test_an_open_wire_has_no_pulse_and_an_honest_one_each_as_it_is(void)
{
    stick_wire_init(&wire, &config, 1);
    TEST_ASSERT_EQUAL_INT64(PULSE, at(0.0, PULSE));
    TEST_ASSERT_EQUAL_INT64(2 * SIM_MS, at(0.02, 2 * SIM_MS));
    config.connected = 0.0;
    stick_wire_init(&wire, &config, 1);
    TEST_ASSERT_EQUAL_INT64(0, at(0.0, PULSE));
}

void test_it_is_lost_for_its_time(void)
{
    config.lost = (span_t){5.0, 2.0};
    stick_wire_init(&wire, &config, 1);
    TEST_ASSERT_EQUAL_INT64(PULSE, at(4.99, PULSE));
    TEST_ASSERT_EQUAL_INT64(0, at(5.0, PULSE));
    TEST_ASSERT_EQUAL_INT64(0, at(6.99, PULSE));
    TEST_ASSERT_EQUAL_INT64(PULSE, at(7.0, PULSE));
}

void test_frozen_it_repeats_the_pulse_before(void)
{
    config.frozen = (span_t){5.0, 2.0};
    stick_wire_init(&wire, &config, 1);
    TEST_ASSERT_EQUAL_INT64(PULSE, at(4.99, PULSE));
    TEST_ASSERT_EQUAL_INT64(PULSE, at(5.0, 2 * SIM_MS));
    TEST_ASSERT_EQUAL_INT64(2 * SIM_MS, at(7.0, 2 * SIM_MS));
}

void test_stuck_it_has_its_own_pulse_from_power_on(void)
{
    config.stuck = (span_t){SPAN_POWER_ON_S, SPAN_FOR_GOOD_S};
    config.stuck_us = 1100.0;
    stick_wire_init(&wire, &config, 1);
    TEST_ASSERT_EQUAL_INT64(1100 * SIM_US, at(-20.0, PULSE));
    TEST_ASSERT_EQUAL_INT64(1100 * SIM_US, at(200.0, PULSE));
}

void test_offset_noise_and_spikes_have_their_sizes_and_no_pulse_is_negative(void)
{
    double sum = 0.0, squares = 0.0;
    int far = 0;

    config.offset_us = 100.0;
    config.noise_us = 20.0;
    stick_wire_init(&wire, &config, 1);
    for (int i = 0; i < 10000; i++) {
        const double off_us = (double)(at(0.0, PULSE) - PULSE) * 1e-3;

        sum += off_us;
        squares += (off_us - 100.0) * (off_us - 100.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 100.0, sum / 10000.0);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 20.0, sqrt(squares / 10000.0));
    config.spikes = 0.25;
    config.noise_us = 0.0;
    config.offset_us = -1000.0;
    stick_wire_init(&wire, &config, 1);
    for (int i = 0; i < 10000; i++) {
        const sim_time_t pulse = at(0.0, PULSE);

        TEST_ASSERT_TRUE(pulse > 0);
        far += pulse != 234 * SIM_US;
    }
    TEST_ASSERT_INT_WITHIN(200, 2500, far);
}

void test_the_same_seed_gives_the_same_lies(void)
{
    stick_wire_t other;

    config.noise_us = 50.0;
    config.spikes = 0.1;
    stick_wire_init(&wire, &config, 7);
    stick_wire_init(&other, &config, 7);
    for (int i = 0; i < 1000; i++) {
        TEST_ASSERT_EQUAL_INT64(at(0.0, PULSE), stick_wire_pulse(&other, 0.0, PULSE));
    }
}
