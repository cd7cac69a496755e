#include "sim/noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

#define DRAWS 400000

static noise_t noise;

void setUp(void)
{
    noise_init(&noise, 1, "test");
}

void tearDown(void) {}

/* First outputs of SplitMix64 for seed 1234567, as published with the reference code (Vigna, splitmix64.c;
 * the vector of Rosetta Code's "Pseudo-random numbers/Splitmix64"). */
void test_bits_are_those_of_splitmix64(void)
{
    noise_t raw = {1234567};

    TEST_ASSERT_TRUE(noise_bits(&raw) == 6457827717110365317u);
    TEST_ASSERT_TRUE(noise_bits(&raw) == 3203168211198807973u);
    TEST_ASSERT_TRUE(noise_bits(&raw) == 9817491932198370423u);
}

void test_the_same_seed_and_name_give_the_same_numbers(void)
{
    noise_t one, other;

    noise_init(&one, 42, "laser");
    noise_init(&other, 42, "laser");
    for (int i = 0; i < 1000; i++) {
        TEST_ASSERT_TRUE(noise_gauss(&one) == noise_gauss(&other)); /* to the last bit */
        TEST_ASSERT_TRUE(noise_uniform(&one, -3.0, 7.0) == noise_uniform(&other, -3.0, 7.0));
    }
}

/* Pinned on x86-64 with this very code: a change means that every recorded flight changes. */
void test_the_numbers_of_a_stream_are_pinned(void)
{
    noise_init(&noise, 1, "laser");
    TEST_ASSERT_EQUAL_HEX64(0xB264A23B3F3D648Cu, noise_bits(&noise));
    TEST_ASSERT_TRUE(noise_gauss(&noise) == -0x1.b7c1d31a28eb6p-1);
    TEST_ASSERT_TRUE(noise_gauss(&noise) == 0x1.db5e2d3758c8bp-1);
}

static double correlation(noise_t *one, noise_t *other)
{
    double sum = 0.0;

    for (int i = 0; i < DRAWS; i++) {
        sum += noise_gauss(one) * noise_gauss(other);
    }
    return sum / DRAWS;
}

void test_streams_of_other_names_or_neighbouring_seeds_are_independent(void)
{
    noise_t one, other;
    const double five_sigma = 5.0 / sqrt(DRAWS);

    noise_init(&one, 1, "roll");
    noise_init(&other, 1, "pitch");
    TEST_ASSERT_TRUE(one.state != other.state);
    TEST_ASSERT_DOUBLE_WITHIN(five_sigma, 0.0, correlation(&one, &other));
    noise_init(&one, 1, "roll");
    noise_init(&other, 2, "roll");
    TEST_ASSERT_DOUBLE_WITHIN(five_sigma, 0.0, correlation(&one, &other));
    noise_init(&one, 1, "ab");
    noise_init(&other, 1, "ba");
    TEST_ASSERT_TRUE(one.state != other.state);
}

void test_uniform_stays_in_range_and_fills_it_evenly(void)
{
    int tenth[10] = {0};

    for (int i = 0; i < DRAWS; i++) {
        double u = noise_uniform(&noise, -2.0, 3.0);

        TEST_ASSERT_TRUE(u >= -2.0 && u < 3.0);
        tenth[(int)((u + 2.0) * 2.0)]++;
    }
    for (int i = 0; i < 10; i++) { /* 5 sigma of a binomial count */
        TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(DRAWS * 0.1 * 0.9), DRAWS * 0.1, tenth[i]);
    }
}

void test_gauss_has_the_moments_of_the_normal_distribution(void)
{
    double m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0;
    const double n = DRAWS;

    for (int i = 0; i < DRAWS; i++) {
        double x = noise_gauss(&noise);

        m1 += x / n;
        m2 += x * x / n;
        m3 += x * x * x / n;
        m4 += x * x * x * x / n;
    }
    /* 5 sigma of each mean: variances of x, x^2, x^3, x^4 are 1, 2, 15, 96 */
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(1.0 / n), 0.0, m1);
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(2.0 / n), 1.0, m2);
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(15.0 / n), 0.0, m3);
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(96.0 / n), 3.0, m4);
}

void test_gauss_has_the_distribution_function_of_the_normal_distribution(void)
{
    int below[49] = {0}; /* limits -3 ... 3 by 1/8 */

    for (int i = 0; i < DRAWS; i++) {
        double x = noise_gauss(&noise);

        for (int k = 0; k < 49; k++) {
            below[k] += x < -3.0 + k / 8.0;
        }
    }
    for (int k = 0; k < 49; k++) {
        double p = 0.5 * erfc(-(-3.0 + k / 8.0) / sqrt(2.0));

        TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(p * (1.0 - p) / DRAWS), p, (double)below[k] / DRAWS);
    }
}

void test_successive_gauss_numbers_are_uncorrelated(void)
{
    double sum = 0.0;
    double last = noise_gauss(&noise);

    for (int i = 0; i < DRAWS; i++) {
        double x = noise_gauss(&noise);

        sum += x * last;
        last = x;
    }
    TEST_ASSERT_DOUBLE_WITHIN(5.0 / sqrt(DRAWS), 0.0, sum / DRAWS);
}
