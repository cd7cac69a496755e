#include "control/thrust.h"
#include "unity.h"

#include <math.h>

void setUp(void) {}
void tearDown(void) {}

/* Seed document eq. 4: compare 4166 at no thrust, 2082 at 11.76 N, one count 0.48 us. */
void test_percent_are_of_the_whole_range(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, thrust_of_percent(0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, 1.764F, thrust_of_percent(15.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, THRUST_MAX_N, thrust_of_percent(100.0F));
}

void test_the_ends_are_the_seeds_pulses(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 1999.68F, thrust_to_pulse_us(0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 999.36F, thrust_to_pulse_us(THRUST_MAX_N));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 1999.68F, THRUST_IDLE_PULSE_US);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 999.36F, THRUST_FULL_PULSE_US);
}

/* (4166 - 177.21 * 7) * 0.48 = 1404.254 */
void test_seven_newtons_are_1404_us(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1404.254F, thrust_to_pulse_us(7.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 7.0F, thrust_from_pulse_us(1404.254F));
}

void test_more_thrust_is_a_shorter_pulse(void)
{
    for (int i = 0; i < 1176; i++) {
        const float here_us = thrust_to_pulse_us((float)i * 0.01F);
        const float next_us = thrust_to_pulse_us((float)(i + 1) * 0.01F);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.8506F, here_us - next_us);
    }
}

void test_the_two_maps_are_inverse(void)
{
    for (int i = 0; i <= 1176; i++) {
        const float thrust_n = (float)i * 0.01F;
        TEST_ASSERT_FLOAT_WITHIN(0.0001F, thrust_n, thrust_from_pulse_us(thrust_to_pulse_us(thrust_n)));
    }
}

void test_outside_values_end_at_the_ends(void)
{
    TEST_ASSERT_EQUAL_FLOAT(THRUST_IDLE_PULSE_US, thrust_to_pulse_us(-0.01F));
    TEST_ASSERT_EQUAL_FLOAT(THRUST_IDLE_PULSE_US, thrust_to_pulse_us(-INFINITY));
    TEST_ASSERT_EQUAL_FLOAT(THRUST_FULL_PULSE_US, thrust_to_pulse_us(11.77F));
    TEST_ASSERT_EQUAL_FLOAT(THRUST_FULL_PULSE_US, thrust_to_pulse_us(INFINITY));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, thrust_from_pulse_us(2500.0F));
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, thrust_from_pulse_us(500.0F));
}

void test_nan_is_the_idle_pulse(void)
{
    TEST_ASSERT_EQUAL_FLOAT(THRUST_IDLE_PULSE_US, thrust_to_pulse_us(NAN));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, thrust_from_pulse_us(NAN));
}

void test_the_smallest_thrust_is_one(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.0005F, thrust_from_pulse_us(thrust_to_pulse_us(0.0005F)));
}
