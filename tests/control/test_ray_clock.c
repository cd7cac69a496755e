#include "control/ray_clock.h"
#include "unity.h"

#include <stdio.h>

#define AGE_US 70500U

static ray_clock_t ray_clock;

void setUp(void)
{
    ray_clock_init(&ray_clock);
}

void tearDown(void) {}

static int32_t error_us(uint32_t stamp_ms, uint32_t arrival_us, uint32_t unhindered_us)
{
    return (int32_t)(ray_clock_step(&ray_clock, stamp_ms, arrival_us, AGE_US) + AGE_US - unhindered_us);
}

void test_an_unhindered_reply_shows_its_rays_70_ms_before(void)
{
    TEST_ASSERT_EQUAL_UINT32(1000000U - 70500U, ray_clock_step(&ray_clock, 5U, 1000000U, AGE_US));
}

void test_a_late_reply_does_not_make_its_rays_later(void)
{
    TEST_ASSERT_EQUAL_INT32(0, error_us(1000U, 7000000U, 7000000U));
    TEST_ASSERT_INT_WITHIN(500, 0, error_us(1100U, 7120000U, 7100000U));
    TEST_ASSERT_INT_WITHIN(1000, 0, error_us(1200U, 7245000U, 7200000U));
    TEST_ASSERT_EQUAL_INT32(0, error_us(1300U, 7300000U, 7300000U));
}

/* Clocks up to 0.3 % apart, replies late by up to 15 ms, three of four in time; for ten minutes. */
void test_a_drifting_clock_is_followed_in_both_directions(void)
{
    static const double ratios[] = {0.997, 0.999, 1.0, 1.001, 1.003};
    for (unsigned i = 0; i < sizeof ratios / sizeof ratios[0]; i++) {
        uint32_t noise = 20161U + i;
        setUp();
        for (uint32_t scan = 0; scan < 6000U; scan++) {
            const uint32_t arrival_us = 0xFFFF0000U + scan * 100000U;
            const uint32_t stamp_ms = ((uint32_t)(scan * 100.0 * ratios[i]) + 0xFFFF00U) & 0xFFFFFFU;
            noise = noise * 1664525U + 1013904223U;
            const uint32_t late_us = (noise >> 30) != 0U ? 0U : (noise >> 8) % 15000U;
            const int32_t off_us = error_us(stamp_ms, arrival_us + late_us, arrival_us);
            TEST_ASSERT_TRUE(scan < 20U || (off_us > -2500 && off_us < 6000));
        }
    }
}

void test_a_sensor_that_starts_anew_is_believed_at_once(void)
{
    (void)error_us(500000U, 9000000U, 9000000U);
    TEST_ASSERT_EQUAL_INT32(0, error_us(12U, 9100000U, 9100000U));
    TEST_ASSERT_EQUAL_INT32(0, error_us(112U, 9200000U, 9200000U));
}

void test_after_a_long_silence_the_clocks_are_tied_anew(void)
{
    (void)error_us(1000U, 1000000U, 1000000U);
    TEST_ASSERT_EQUAL_INT32(0, error_us(61000U, 61040000U, 61040000U));
}

void test_a_stamp_wider_than_24_bits_is_cut(void)
{
    (void)error_us(0xFFFFFFU - 49U, 3000000U, 3000000U);
    TEST_ASSERT_EQUAL_INT32(0, error_us(50U, 3100000U, 3100000U));
    TEST_ASSERT_EQUAL_UINT32(50U, ray_clock.stamp_ms);
}
