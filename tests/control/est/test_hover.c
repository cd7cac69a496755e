#include "control/est/hover.h"
#include "unity.h"

#include <math.h>

static hover_t hover;
static uint32_t random_bits;

void setUp(void)
{
    hover_init(&hover, 7.0F, 0.7F, 5.0F, 9.0F);
    random_bits = 4711U;
}

void tearDown(void) {}

static float noise(float rms)
{
    float sum = -6.0F;
    for (int i = 0; i < 12; i++) {
        random_bits = random_bits * 1664525U + 1013904223U;
        sum += (float)(random_bits >> 8) / 16777216.0F;
    }
    return rms * sum;
}

static void see(float thrust_n, float rms_n, float seconds)
{
    for (float t = 0.0F; t < seconds; t += 0.025F) {
        hover_step(&hover, thrust_n + noise(rms_n), rms_n > 0.0F ? rms_n : 0.3F, 0.025F);
    }
}

void test_a_start_outside_the_bounds_is_clipped(void)
{
    hover_init(&hover, 12.0F, 0.5F, 5.0F, 9.0F);
    TEST_ASSERT_EQUAL_FLOAT(9.0F, hover.thrust_n);
    hover_init(&hover, -1.0F, 0.5F, 5.0F, 9.0F);
    TEST_ASSERT_EQUAL_FLOAT(5.0F, hover.thrust_n);
}

void test_a_wrong_start_is_mended_within_a_second(void)
{
    see(8.2F, 0.3F, 1.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.35F, 8.2F, hover.thrust_n + hover.gust_n);
    see(8.2F, 0.3F, 4.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 8.2F, hover.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.0F, hover.gust_n);
}

void test_once_known_it_moves_slowly_and_the_gusts_quickly(void)
{
    see(7.4F, 0.3F, 20.0F);
    const float before_n = hover.thrust_n;
    see(8.0F, 0.3F, 0.4F);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, before_n, hover.thrust_n);
    TEST_ASSERT_TRUE(hover.gust_n > 0.12F && hover.gust_n < 0.6F);
}

void test_a_sagging_battery_is_followed(void)
{
    see(7.4F, 0.3F, 10.0F);
    for (int i = 0; i < 600; i++) { /* 0.3 % in a second, for a minute */
        see(7.4F + 0.0022F * (float)i, 0.3F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.25F, 8.72F, hover.thrust_n + hover.gust_n);
}

void test_noise_slows_the_gusts_down(void)
{
    hover_t quiet = hover, loud = hover;
    hover_step(&quiet, 8.0F, 0.3F, 0.025F);
    hover_step(&loud, 8.0F, 1.5F, 0.025F);
    TEST_ASSERT_TRUE(quiet.gust_n > 4.0F * loud.gust_n && loud.gust_n > 0.0F);
}

void test_a_nudge_moves_the_gusts_alone_within_1_07_newtons(void)
{
    hover_nudge(&hover, 0.3F);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, hover.gust_n);
    TEST_ASSERT_EQUAL_FLOAT(7.0F, hover.thrust_n);
    hover_nudge(&hover, 5.0F);
    TEST_ASSERT_EQUAL_FLOAT(1.07F, hover.gust_n);
    hover_nudge(&hover, -9.0F);
    TEST_ASSERT_EQUAL_FLOAT(-1.07F, hover.gust_n);
}

void test_without_samples_a_gust_ends_and_the_hover_thrust_stays(void)
{
    see(7.4F, 0.3F, 20.0F);
    hover_nudge(&hover, 0.8F);
    const float before_n = hover.gust_n;
    const float hover_n = hover.thrust_n;
    for (float t = 0.0F; t < 0.76F; t += 0.019F) {
        hover_fade_gust(&hover, 0.019F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.37F, hover.gust_n / before_n); /* 1/e */
    TEST_ASSERT_EQUAL_FLOAT(hover_n, hover.thrust_n);
}

void test_nothing_leaves_the_bounds_whatever_is_seen(void)
{
    static const float seen[] = {-1e6F, 1e6F, 0.0F, 20.0F};
    for (int i = 0; i < 20000; i++) {
        random_bits = random_bits * 1664525U + 1013904223U;
        hover_step(&hover, seen[random_bits >> 30], 0.05F + noise(0.01F),
                   0.001F * (float)((random_bits >> 20) % 500U));
        TEST_ASSERT_TRUE(hover.thrust_n >= 5.0F && hover.thrust_n <= 9.0F);
        TEST_ASSERT_TRUE(fabsf(hover.gust_n) <= 1.07F);
        TEST_ASSERT_TRUE(hover.variance_n2 >= 0.0F && hover.variance_n2 < 1.0F);
    }
}

/* ---- one step; variance 0.49 N2 */

void test_a_sample_counts_by_kalmans_gain_with_its_noise_times_6_6(void)
{
    hover_step(&hover, 8.0F, 0.4F, 0.1F);
    const float variance = 0.49F + 0.000038F;
    const float gain = variance / (variance + 6.6F * 0.16F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.0F + gain, hover.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, variance * (1.0F - gain), hover.variance_n2);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.1F * 0.1F * (1.0F - 0.1F / 0.76F), hover.gust_n);
}

void test_noise_beyond_half_a_newton_follows_gusts_less(void)
{
    hover_step(&hover, 8.0F, 0.96F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.25F * 0.21F * (1.0F - 0.1F / 0.76F), hover.gust_n);
    hover_init(&hover, 7.0F, 0.7F, 5.0F, 9.0F);
    hover.gust_n = 0.4F;
    hover_step(&hover, 7.4F, 0.4F, 0.1F); /* explained already */
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.4F * (1.0F - 0.1F / 0.76F), hover.gust_n);
}

void test_a_long_step_counts_once_at_most_and_leaves_no_gust(void)
{
    hover_step(&hover, 8.0F, 0.4F, 0.3F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F * (1.0F - 0.3F / 0.76F), hover.gust_n); /* 2.1 1/s */
    hover_init(&hover, 7.0F, 0.7F, 5.0F, 9.0F);
    hover_step(&hover, 8.0F, 0.4F, 0.8F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, hover.gust_n);
}

void test_gusts_end_at_1_07_newtons_and_the_hover_thrust_at_its_bounds(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        hover_init(&hover, 7.0F, 0.5F, 5.0F, 9.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.25F, hover.variance_n2);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, hover.gust_n);
        hover_nudge(&hover, 0.95F * side);
        hover_nudge(&hover, 0.02F * side);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.97F * side, hover.gust_n);
        hover_nudge(&hover, 0.95F * side);
        TEST_ASSERT_EQUAL_FLOAT(1.07F * side, hover.gust_n);
        hover_step(&hover, 7.0F + 30.0F * side, 0.4F, 0.1F);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.07F * side * (1.0F - 0.1F / 0.76F), hover.gust_n);
        TEST_ASSERT_EQUAL_FLOAT(7.0F + 2.0F * side, hover.thrust_n);
    }
}

void test_a_gust_ends_without_a_sample_as_with_one(void)
{
    hover.gust_n = 0.4F;
    const hover_t before = hover;
    hover_fade_gust(&hover, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.4F * (1.0F - 0.1F / 0.76F), hover.gust_n);
    TEST_ASSERT_EQUAL_FLOAT(before.thrust_n, hover.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(before.variance_n2, hover.variance_n2);
}
