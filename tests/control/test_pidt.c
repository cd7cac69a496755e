#include "control/pidt.h"
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
        TEST_ASSERT_EQUAL_FLOAT(10.0F, step(3.0F, 0.0F, 0.1F));
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, state.integral_n);
    state.integral_n = 2.0F;
    (void)step(3.0F, 3.4F, 0.5F);
    (void)step(3.0F, 3.4F, 0.5F);
    TEST_ASSERT_TRUE(state.integral_n < 2.0F); /* it may always come back */
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
