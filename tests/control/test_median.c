#include "control/median.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265F
#define SEED 20210U

static uint32_t noise;

void setUp(void)
{
    noise = SEED;
}

void tearDown(void) {}

/* -1 .. 1 */
static float any(void)
{
    noise = noise * 1664525U + 1013904223U;
    return (float)(noise >> 8) / 8388608.0F - 1.0F;
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float wrapped(float angle)
{
    return angle > PI ? angle - 2.0F * PI : angle < -PI ? angle + 2.0F * PI : angle;
}

void test_one_value_is_its_own_median(void)
{
    const float value = -3.25F;
    TEST_ASSERT_EQUAL_FLOAT(value, median_of(&value, 1));
    TEST_ASSERT_EQUAL_FLOAT(value, median_of_angles(&value, 1));
}

void test_a_spike_disappears_wherever_it_stands(void)
{
    for (int at = 0; at < 5; at++) {
        float values[5] = {0.10F, 0.11F, 0.12F, 0.13F, 0.14F};
        values[at] = 0.35F;
        TEST_ASSERT_FLOAT_WITHIN(0.0101F, 0.125F, median_of(values, 5));
        TEST_ASSERT_TRUE(median_of(values, 5) == median_of_angles(values, 5));
    }
}

void test_two_spikes_of_five_disappear(void)
{
    const float values[5] = {-9.0F, 0.2F, 0.1F, 9.0F, 0.3F};
    TEST_ASSERT_EQUAL_FLOAT(0.2F, median_of(values, 5));
}

void test_equal_values_are_no_obstacle(void)
{
    const float most[5] = {2.0F, 1.0F, 2.0F, 2.0F, 7.0F};
    const float all[4] = {2.0F, 2.0F, 2.0F, 2.0F};
    TEST_ASSERT_EQUAL_FLOAT(2.0F, median_of(most, 5));
    TEST_ASSERT_EQUAL_FLOAT(2.0F, median_of(all, 4));
    TEST_ASSERT_EQUAL_FLOAT(2.0F, median_of_angles(most, 5));
}

void test_an_odd_median_is_the_middle_of_the_sorted_values(void)
{
    for (int round = 0; round < 2000; round++) {
        float values[9], sorted[9];
        const uint16_t count = (uint16_t)(1 + 2 * (round % 5));
        for (uint16_t i = 0; i < count; i++) {
            values[i] = sorted[i] = any() * (float)(1 + round % 3);
        }
        qsort(sorted, count, sizeof sorted[0], ascending);
        TEST_ASSERT_EQUAL_FLOAT(sorted[count / 2], median_of(values, count));
    }
}

void test_an_even_median_is_one_of_the_two_in_the_middle(void)
{
    for (int round = 0; round < 2000; round++) {
        float values[8], sorted[8];
        const uint16_t count = (uint16_t)(2 + 2 * (round % 4));
        for (uint16_t i = 0; i < count; i++) {
            values[i] = sorted[i] = any();
        }
        qsort(sorted, count, sizeof sorted[0], ascending);
        const float line = median_of(values, count);
        const float circle = median_of_angles(values, count);
        TEST_ASSERT_TRUE(line == sorted[count / 2 - 1] || line == sorted[count / 2]);
        TEST_ASSERT_TRUE(circle >= sorted[count / 2 - 1] - 1e-5F && circle <= sorted[count / 2] + 1e-5F);
    }
}

/* Whatever the direction the values are gathered around: seen from there, it is the ordinary median. */
void test_the_median_of_angles_does_not_know_where_the_seam_is(void)
{
    char seed[32];
    snprintf(seed, sizeof seed, "seed %u", SEED);
    TEST_MESSAGE(seed);
    for (int round = 0; round < 2000; round++) {
        const float centre = any() * PI;
        float offsets[5], angles[5];
        for (int i = 0; i < 5; i++) {
            offsets[i] = any() * 0.7F;
            angles[i] = wrapped(centre + offsets[i]);
        }
        const float off = wrapped(median_of_angles(angles, 5) - centre);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, median_of(offsets, 5), off);
    }
}

void test_an_opposite_spike_does_not_turn_the_median_of_angles(void)
{
    const float angles[5] = {3.1F, 0.05F, 0.0F, -0.05F, -3.1F};
    TEST_ASSERT_EQUAL_FLOAT(0.0F, median_of_angles(angles, 5));
}

void test_angles_on_both_sides_of_the_seam_are_neighbours(void)
{
    const float angles[5] = {3.10F, -3.13F, 3.14F, -3.10F, 3.12F};
    TEST_ASSERT_EQUAL_FLOAT(3.14F, median_of_angles(angles, 5)); /* order: 3.10 3.12 3.14 -3.13 -3.10 */
}

void test_values_beyond_the_count_are_not_read(void)
{
    static const float values[] = {3.0F, 1.0F, 2.0F, 100.0F};
    static const float angles_rad[] = {0.1F, 0.2F, 0.3F, 0.2F};
    TEST_ASSERT_EQUAL_FLOAT(2.0F, median_of(values, 3U));
    TEST_ASSERT_EQUAL_FLOAT(1.0F, median_of(values + 1, 2U)); /* of an even count the lower */
    TEST_ASSERT_EQUAL_FLOAT(3.0F, median_of(values, 1U));
    TEST_ASSERT_EQUAL_FLOAT(0.1F, median_of_angles(angles_rad, 2U)); /* of equals the first */
    TEST_ASSERT_EQUAL_FLOAT(0.1F, median_of_angles(angles_rad, 1U));
}
