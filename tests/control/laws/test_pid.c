#include "control/laws/pid.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define SEED 4242U

/* Best flown values, seed document, Annex III. */
static const pid_gains_t best = {0.015F, 0.008F, 0.01F, 7.0F, 1.0F, 0.0F};
static const pid_gains_t wide = {0.015F, 0.008F, 0.01F, 6.0F, 5.0F, 5.0F};

static pid_state_t law;
static uint32_t noise;

void setUp(void)
{
    pid_reset(&law);
    noise = SEED;
}

void tearDown(void) {}

static float any(float most)
{
    noise = noise * 1664525U + 1013904223U;
    return ((float)(noise >> 8) / 8388608.0F - 1.0F) * most;
}

/* 6 + 0.015 e + 0.008 (e - e') + 0.01 sum e for 10, 20, -5 mm. */
void test_the_three_actions_by_hand(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F + 0.15F + 0.0F + 0.1F, pid_step(&law, &wide, 10.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F + 0.3F + 0.08F + 0.3F, pid_step(&law, &wide, 20.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F - 0.075F - 0.2F + 0.25F, pid_step(&law, &wide, -5.0F));
}

void test_without_error_the_action_is_gravity(void)
{
    TEST_ASSERT_EQUAL_FLOAT(7.0F, pid_step(&law, &best, 0.0F));
    TEST_ASSERT_FALSE(law.saturated);
}

void test_the_first_sample_has_no_derivative(void)
{
    const pid_gains_t d_alone = {0.0F, 0.01F, 0.0F, 6.0F, 5.0F, 5.0F};
    TEST_ASSERT_EQUAL_FLOAT(6.0F, pid_step(&law, &d_alone, 100.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.5F, pid_step(&law, &d_alone, 150.0F));
    pid_reset(&law);
    TEST_ASSERT_EQUAL_FLOAT(6.0F, pid_step(&law, &d_alone, -100.0F));
}

void test_after_a_pause_there_is_no_derivative_but_the_integral_is_kept(void)
{
    (void)pid_step(&law, &wide, 100.0F);
    pid_resume(&law);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F + 0.015F * 20.0F + 0.01F * 120.0F, pid_step(&law, &wide, 20.0F));
}

/* No time enters: the same height read twice has no derivative but is integrated twice. */
void test_a_repeated_height_is_a_sample_like_any_other(void)
{
    const float first_n = pid_step(&law, &wide, 10.0F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, first_n + 0.1F, pid_step(&law, &wide, 10.0F));
}

void test_the_window_is_relative_to_gravity(void)
{
    TEST_ASSERT_EQUAL_FLOAT(8.0F, pid_step(&law, &best, 400.0F));
    TEST_ASSERT_TRUE(law.saturated);
    pid_reset(&law);
    TEST_ASSERT_EQUAL_FLOAT(7.0F, pid_step(&law, &best, -1.0F));
    TEST_ASSERT_TRUE(law.saturated);
}

void test_the_window_is_clipped_to_the_actuator(void)
{
    const pid_gains_t strong = {1.0F, 0.0F, 0.0F, 7.0F, THRUST_MAX_N, THRUST_MAX_N};
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, pid_step(&law, &strong, 3000.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, pid_step(&law, &strong, -3000.0F));
}

void test_a_clipped_sample_is_not_integrated(void)
{
    for (int i = 0; i < 1000; i++) {
        (void)pid_step(&law, &best, 400.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.integral_n);
    for (int i = 0; i < 1000; i++) {
        (void)pid_step(&law, &best, -400.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.integral_n);
}

void test_while_clipped_the_integral_action_is_the_last_one_before(void)
{
    (void)pid_step(&law, &wide, 50.0F);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.5F, law.integral_n);
    TEST_ASSERT_EQUAL_FLOAT(11.0F, pid_step(&law, &wide, 900.0F));
    TEST_ASSERT_TRUE(law.saturated);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.5F, law.integral_n);
}

/* 39 mm: 7 + 0.585 + 0.39 = 7.975 fits and is integrated; 20 mm then 7 + 0.3 - 0.152 + 0.59 fits; 60 mm then
 * would be 8.2 + ...: made with the 0.59 N of before, 7 + 0.9 + 0.32 + 0.59, and clipped. 25 mm then: 7 +
 * 0.375 - 0.28 + 0.59 + 0.25 fits again. */
void test_integration_goes_on_as_soon_as_the_action_fits(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.975F, pid_step(&law, &best, 39.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.738F, pid_step(&law, &best, 20.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 8.0F, pid_step(&law, &best, 60.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.935F, pid_step(&law, &best, 25.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.84F, law.integral_n);
}

/* 7 + 0.75 + 0.5 = 8.25 leaves the window; with the integral action of before, 0, the action is 7.75. */
void test_a_sample_that_leaves_the_window_only_by_its_own_integral_acts_without_it(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.75F, pid_step(&law, &best, 50.0F));
    TEST_ASSERT_TRUE(law.saturated);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.integral_n);
}

void test_without_ki_it_is_the_pd_law(void)
{
    pid_gains_t pd = wide;
    pd.ki_n_per_mm = 0.0F;
    for (int i = 0; i < 100; i++) {
        (void)pid_step(&law, &pd, 50.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.75F, pid_step(&law, &pd, 50.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.integral_n);
}

void test_taking_ki_away_takes_the_integral_action_away(void)
{
    pid_gains_t pd = wide;
    pd.ki_n_per_mm = 0.0F;
    (void)pid_step(&law, &wide, 50.0F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.75F, pid_step(&law, &pd, 50.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.integral_n);
}

void test_a_new_ki_does_not_move_the_integral_action_by_itself(void)
{
    pid_gains_t tenth = wide;
    tenth.ki_n_per_mm = 0.001F;
    (void)pid_step(&law, &wide, 50.0F);
    (void)pid_step(&law, &wide, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.5F, pid_step(&law, &tenth, 0.0F));
}

/* The law written once more, with a sum, as the seed's equation 8 and 4.2.2 have it. */
void test_it_is_the_seeds_law_for_any_errors(void)
{
    char seed[32];
    double sum = 0.0, last = 0.0;
    int clipped = 0;
    snprintf(seed, sizeof seed, "seed %u", SEED);
    TEST_MESSAGE(seed);
    for (int k = 0; k < 20000; k++) {
        const float error_mm = any(k % 100 < 50 ? 30.0F : 300.0F);
        const double pd = 7.0 + 0.015 * (double)error_mm + 0.008 * (k == 0 ? 0.0 : (double)error_mm - last);
        const double whole = pd + 0.01 * (sum + (double)error_mm);
        const bool outside = whole < 7.0 || whole > 8.0;
        const float found_n = pid_step(&law, &best, error_mm);
        if (fabs(whole - 7.0) < 1e-4 || fabs(whole - 8.0) < 1e-4) {
            sum = (double)law.integral_n / 0.01;
        } else {
            sum += outside ? 0.0 : (double)error_mm;
            clipped += outside;
            TEST_ASSERT_EQUAL_INT(outside, law.saturated);
            TEST_ASSERT_FLOAT_WITHIN(2e-3F, (float)fmin(fmax(pd + 0.01 * sum, 7.0), 8.0), found_n);
        }
        last = (double)error_mm;
    }
    TEST_ASSERT_INT_WITHIN(5000, 15000, clipped);
}

void test_any_gains_and_errors_stay_within_the_actuator(void)
{
    for (int k = 0; k < 20000; k++) {
        const pid_gains_t gains = {fabsf(any(1.0F)),   fabsf(any(1.0F)),   fabsf(any(1.0F)),
                                   fabsf(any(11.76F)), fabsf(any(11.76F)), fabsf(any(11.76F))};
        const float thrust_n = pid_step(&law, &gains, any(5500.0F));
        TEST_ASSERT_TRUE(thrust_n >= 0.0F && thrust_n <= THRUST_MAX_N);
        TEST_ASSERT_TRUE(isfinite(law.integral_n));
    }
}
