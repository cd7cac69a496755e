#include "control/laws/pidt.h"
#include "unity.h"

#include <math.h>

static const pidt_gains_t gains = {6.3F, 0.95F, 3.1F, 7.0F, 10.0F, 4.0F};
static pidt_state_t state;

void setUp(void)
{
    pidt_reset(&state);
}

void tearDown(void) {}

static float step(float reference_m, float height_m, float dt_s)
{
    return pidt_step(&state, &gains, reference_m, height_m, dt_s);
}

void test_the_first_height_has_neither_derivative_nor_integral(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.0F + 6.3F * 0.1F, step(0.6F, 0.5F, 0.1F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, state.integral_n);
}

void test_the_integral_counts_seconds_not_samples(void)
{
    static const float steps_s[] = {0.025F, 0.1F, 0.2F};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        (void)step(0.6F, 0.5F, 0.1F);
        for (float t = 0.0F; t < 1.999F; t += steps_s[i]) {
            (void)step(0.6F, 0.5F, steps_s[i]);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.012F, 0.95F * 0.1F * 2.0F, state.integral_n);
    }
}

void test_the_derivative_is_of_the_height_and_low_passed(void)
{
    (void)step(0.6F, 0.5F, 0.1F);
    const float before_n = step(0.6F, 0.5F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, before_n + 6.3F * 0.2F,
                             step(0.8F, 0.5F, 0.1F)); /* a new reference: no kick */
    const float risen_n = step(0.8F, 0.55F, 0.1F);
    const float share = 0.1F / 0.1199F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.0F + 6.3F * 0.25F + state.integral_n - 3.1F * 0.5F * share, risen_n);
}

void test_while_it_pushes_out_of_the_window_the_integral_stands(void)
{
    (void)step(3.0F, 0.0F, 0.1F);
    for (int i = 0; i < 50; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.3F, 9.8F, step(3.0F, 0.0F, 0.1F));
    }
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.35F, state.integral_n); /* 7 + 6.3 * 0.4, and so much to 10 */
    state.integral_n = 2.0F;
    (void)step(3.0F, 3.4F, 0.3F);
    (void)step(3.0F, 3.4F, 0.3F);
    TEST_ASSERT_TRUE(state.integral_n < 2.0F); /* it may always come back */
}

void test_beyond_0_4_m_the_error_asks_for_no_more_thrust(void)
{
    (void)step(0.0F, 0.0F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 7.0F + 6.3F * 0.3F, step(0.3F, 0.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 7.0F + 6.3F * 0.4F, step(1.4F, 0.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 7.0F - 6.3F * 0.4F, step(-1.4F, 0.0F, 0.0F));
}

void test_the_integral_waits_while_a_far_reference_is_approached(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        for (int i = 0; i < 6; i++) { /* 0.5 m/s, from 1 m to 0.75 m off */
            (void)step(1.0F, 1.0F - (float)sign * (1.0F - 0.05F * (float)i), 0.1F);
        }
        const float far_n = state.integral_n;
        TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.0F, far_n);
        for (int i = 0; i < 10; i++) { /* it hangs there */
            (void)step(1.0F, 1.0F - (float)sign * 0.75F, 0.1F);
        }
        TEST_ASSERT_TRUE((float)sign * state.integral_n > 0.2F);
    }
}

void test_the_window_holds_for_any_height(void)
{
    uint32_t bits = 99U;
    for (int i = 0; i < 20000; i++) {
        bits = bits * 1664525U + 1013904223U;
        const float thrust_n = step((float)(bits >> 28) * 0.2F, (float)((bits >> 8) % 5000U) * 0.001F,
                                    (float)((bits >> 4) % 700U) * 0.001F);
        TEST_ASSERT_TRUE(thrust_n >= 4.0F && thrust_n <= 10.0F);
        TEST_ASSERT_TRUE(isfinite(state.integral_n) && isfinite(state.rate_mps));
    }
}

void test_a_pause_is_no_derivative(void)
{
    (void)step(0.6F, 0.5F, 0.1F);
    (void)step(0.6F, 0.5F, 0.1F);
    const float integral_n = state.integral_n;
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.0F - 6.3F * 0.3F + integral_n, step(0.6F, 0.9F, 0.6F));
    TEST_ASSERT_EQUAL_FLOAT(integral_n, state.integral_n);
    pidt_resume(&state);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.0F + 6.3F * 0.3F + integral_n, step(0.6F, 0.3F, 0.1F));
}

/* One step of 0.1 s from a height and an integral, at a rate of 0; gains 6.3, 0.95, 3.1; limits 4 and 10 N.
 */
static float from(float reference_m, float height_m, float integral_n, float dt_s)
{
    state = (pidt_state_t){.integral_n = integral_n, .height_m = height_m, .rate_mps = 0.2F, .primed = true};
    return step(reference_m, height_m, dt_s);
}

void test_a_gap_too_short_or_too_long_has_neither_derivative_nor_integral(void)
{
    static const float gaps_s[] = {0.0195F, 0.0205F, 0.2995F, 0.3005F};
    for (int i = 0; i < 4; i++) {
        const bool counts = i == 1 || i == 2;
        (void)from(0.6F, 0.5F, 0.3F, gaps_s[i]);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.3F + (counts ? 0.095F * gaps_s[i] : 0.0F), state.integral_n);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, counts ? 0.2F * 0.0199F / (gaps_s[i] + 0.0199F) : 0.0F,
                                 state.rate_mps);
    }
}

/* 7 N and 3.1 x 0.0332 against the rate that is left; an integral at the limit grows no further, and does
 * shrink. */
void test_the_integral_stops_at_a_limit_and_comes_back_from_it(void)
{
    static const struct {
        float error_m, integral_n;
        bool grows;
    } rows[] = {{0.0F, 2.0F, true},  {0.1F, 2.4F, true},     {0.1F, 2.55F, false},
                {-0.1F, 4.0F, true}, {-0.1F, -2.2F, true},   {-0.1F, -2.29F, false},
                {0.1F, -4.0F, true}, {0.0005F, 3.2F, false}, {-0.0005F, -3.2F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        (void)from(0.5F + rows[i].error_m, 0.5F, rows[i].integral_n, 0.1F);
        TEST_ASSERT_FLOAT_WITHIN(
            2e-6F, rows[i].integral_n + (rows[i].grows ? 0.095F * rows[i].error_m : 0.0F), state.integral_n);
    }
    TEST_ASSERT_EQUAL_FLOAT(10.0F, from(0.6F, 0.5F, 5.0F, 0.1F));
    TEST_ASSERT_EQUAL_FLOAT(4.0F, from(0.4F, 0.5F, -5.0F, 0.1F));
}

/* A height that swings by 0.2 m at 1 Hz: 1.2 N of proportional and some 4 N of derivative part. */
static float swing(float seconds, float amplitude_m)
{
    float most_n = 0.0F;
    for (float t = 0.0F; t < seconds; t += 0.1F) {
        const float thrust_n = step(0.6F, 0.6F + amplitude_m * sinf(6.2832F * t), 0.1F) - state.integral_n;
        most_n = fmaxf(most_n, fabsf(thrust_n - 7.0F));
    }
    return most_n;
}

void test_a_loop_that_swings_loses_gain_and_gets_it_back(void)
{
    const float full_n = swing(1.0F, 0.1F);
    (void)swing(8.0F, 0.1F);
    const float calm_n = swing(1.0F, 0.1F);
    TEST_ASSERT_TRUE(calm_n < 0.4F * full_n);
    (void)swing(30.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.1F * full_n, full_n, swing(1.0F, 0.1F));
}

void test_noise_and_an_edge_cost_no_gain(void)
{
    (void)swing(1.0F, 0.0F);
    const float full_n = step(0.7F, 0.6F, 0.1F) - 7.0F - state.integral_n;
    (void)swing(20.0F, 0.02F);
    (void)swing(1.0F, 0.0F);
    (void)step(0.6F, 0.85F, 0.1F);
    (void)step(0.6F, 0.5F, 0.1F);
    (void)swing(1.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, full_n, step(0.7F, 0.6F, 0.1F) - 7.0F - state.integral_n);
}

/* One step at the height of the step before, 0.1 m below the reference: 0.63 N are asked for. */
static float calmed(float swings, float peak_n, float error_m)
{
    state = (pidt_state_t){.height_m = 0.5F, .primed = true, .swings = swings, .peak_n = peak_n};
    return step(0.5F + error_m, 0.5F, 0.1F) - 7.0F - state.integral_n;
}

void test_swings_beyond_three_take_gain_twice_as_many_half_of_it(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F, calmed(3.0F / 0.99F, 1.0F, 0.1F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.75F * 0.63F,
                             calmed(4.0F / 0.99F, 1.0F, 0.1F)); /* a hundredth is forgotten */
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.5F * 0.63F, calmed(6.0F / 0.99F, 1.0F, 0.1F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F, calmed(1.0F, 1.0F, 0.1F));
}

void test_a_swing_is_a_turn_from_beyond_0_8_newtons(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        (void)calmed(2.0F, -0.81F * side, 0.1F * side);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.98F, state.swings);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F * side, state.peak_n);
        (void)calmed(2.0F, -0.79F * side, 0.1F * side);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.98F, state.swings);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F * side, state.peak_n);
        (void)calmed(2.0F, 0.9F * side, 0.1F * side);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.98F, state.swings);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.9F * side, state.peak_n);
        (void)calmed(2.0F, 0.5F * side, 0.1F * side);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.98F, state.swings);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.63F * side, state.peak_n);
    }
}
