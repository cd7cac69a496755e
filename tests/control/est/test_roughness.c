/* Noise of the heights, from both sides of each limit. */
#include "control/est/roughness.h"
#include "unity.h"

#include <math.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)
#define T_US UINT32_C(400000) /* the time before it wraps */

static roughness_t roughness;

void setUp(void)
{
    roughness_init(&roughness);
}

void tearDown(void) {}

void test_the_noise_is_a_sixth_of_the_squared_second_difference_over_five_heights(void)
{
    static const struct {
        float before_m, first_m, second_m, noise_m;
    } rows[] = {{0.010F, 0.51F, 0.50F, 0.0F},      /* computed below */
                {0.010F, 0.40F, 0.40F, 0.016125F}, /* clipped at 9 times the variance */
                {0.004F, 0.50F, 0.50F, 0.004F},
                {0.080F, 0.10F, 0.50F, 0.080F}};

    for (int i = 0; i < 4; i++) {
        roughness = (roughness_t){
            .noise_m = rows[i].before_m, .in_a_row = 2U, .previous_m = {rows[i].first_m, rows[i].second_m}};
        roughness_step(&roughness, 0.50F, 0.0F, T_US);
        const float bend_m = 0.5F - 2.0F * rows[i].first_m + rows[i].second_m;
        const float expected = (i == 0) ? sqrtf(0.8e-4F + 0.2F * bend_m * bend_m / 6.0F) : rows[i].noise_m;
        NEAR(expected, roughness.noise_m);
        NEAR(0.50F, roughness.previous_m[0]);
        NEAR(rows[i].first_m, roughness.previous_m[1]);
    }
}

/* Runs of outliers, 0.4 m too high for four scans in ten, must not make their own noise: else the third run
 * is fused. When they are believed after two, the first two right ones are off instead. */
void test_runs_of_wrong_heights_are_no_noise_of_the_floor(void)
{
    static const float off_m[2][10] = {{0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.4F, 0.4F, 0.4F, 0.4F},
                                       {-0.4F, -0.4F, 0.0F, 0.0F, 0.0F, 0.0F, 0.4F, 0.4F, 0.0F, 0.0F}};

    for (int believed = 0; believed < 2; believed++) {
        setUp();
        for (int scan = 0; scan < 100; scan++) {
            const float noise_m = (scan % 2 == 0) ? 0.003F : -0.003F;
            const float wrong_m = (scan % 10 >= 6) ? 0.4F : 0.0F;

            roughness_step(&roughness, 0.5F + wrong_m + noise_m, off_m[believed][scan % 10] + noise_m, T_US);
            TEST_ASSERT_FLOAT_WITHIN(0.0006F, 0.0045F, roughness.noise_m); /* 12 mm / sqrt(6) at most */
        }
    }
}

void test_a_floor_is_rough_beyond_three_sigma_of_a_smooth_one(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, roughness_variance_m2(&roughness));
    roughness.noise_m = 0.0191F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, roughness_variance_m2(&roughness));
    roughness.noise_m = 0.03F;
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 0.5F * (0.0009F - 0.0192F * 0.0192F),
                             roughness_variance_m2(&roughness));
}

static void edge(float innovation_m, float edge_m, uint32_t ago_us)
{
    roughness_init(&roughness);
    roughness_step(&roughness, 0.0F, edge_m, T_US - ago_us);
    roughness_step(&roughness, 0.0F, innovation_m, T_US);
}

void test_an_edge_that_returns_within_a_second_is_a_bar_of_half_its_height(void)
{
    edge(-0.05F, 0.06F, 999999U);
    NEAR(0.025F, roughness.noise_m);
    edge(0.06F, -0.05F, 1U);
    NEAR(0.025F, roughness.noise_m);
    edge(-0.05F, 0.06F, 1000000U);
    NEAR(0.004F, roughness.noise_m);
    edge(0.05F, 0.06F, 1U);
    NEAR(0.004F, roughness.noise_m);
    edge(-0.041F, 0.06F, 1U);
    NEAR(0.0205F, roughness.noise_m);
    edge(-0.159F, 0.159F, 1U);
    NEAR(0.0795F, roughness.noise_m);
}

/* It is none, so the edge before it stays the latest one. */
void test_what_is_lower_than_40_mm_or_higher_than_160_is_no_edge_of_a_bar(void)
{
    static const float none_m[] = {-0.039F, -0.161F};

    for (int i = 0; i < 2; i++) {
        edge(none_m[i], 0.06F, 1000U);
        NEAR(0.004F, roughness.noise_m);
        roughness_step(&roughness, 0.0F, -0.05F, T_US + 1U);
        NEAR(0.025F, roughness.noise_m);
    }
}
