#include "control/est/deadband.h"
#include "unity.h"

#include <math.h>

#define NEUTRAL 5.88F

static deadband_t deadband;

void setUp(void)
{
    deadband_init(&deadband);
}

void tearDown(void) {}

static float effect(float command_n, float band_n)
{
    const float off_n = command_n - NEUTRAL;
    return copysignf(fmaxf(fabsf(off_n) - band_n, 0.0F), off_n);
}

void test_without_a_band_commands_pass_bit_by_bit(void)
{
    for (float n = 0.0F; n < 11.76F; n += 0.0137F) {
        TEST_ASSERT_TRUE(deadband_compensate(&deadband, NEUTRAL, n) == n);
        TEST_ASSERT_TRUE(deadband_effect(&deadband, NEUTRAL, n) == n);
    }
}

void test_beyond_its_steep_middle_a_command_loses_nothing(void)
{
    deadband.band_n = 0.47F;
    for (float off_n = 0.1F; off_n < 4.0F; off_n += 0.05F) {
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, off_n,
                                 effect(deadband_compensate(&deadband, NEUTRAL, NEUTRAL + off_n), 0.47F));
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, -off_n,
                                 effect(deadband_compensate(&deadband, NEUTRAL, NEUTRAL - off_n), 0.47F));
    }
}

void test_in_its_middle_a_command_grows_without_a_jump(void)
{
    deadband.band_n = 0.47F;
    float before_n = deadband_compensate(&deadband, NEUTRAL, NEUTRAL - 0.2F);
    for (float off_n = -0.199F; off_n < 0.2F; off_n += 0.001F) {
        const float n = deadband_compensate(&deadband, NEUTRAL, NEUTRAL + off_n);
        TEST_ASSERT_TRUE(n > before_n && n < before_n + 0.007F);
        before_n = n;
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, NEUTRAL, deadband_compensate(&deadband, NEUTRAL, NEUTRAL));
}

void test_what_is_left_of_a_command_is_its_effect(void)
{
    deadband.band_n = 0.47F;
    for (float n = 2.0F; n < 10.0F; n += 0.013F) {
        TEST_ASSERT_FLOAT_WITHIN(2e-6F, effect(n, 0.47F), deadband_effect(&deadband, NEUTRAL, n) - NEUTRAL);
    }
}

/* A stick with a band, tried off_n to either side of neutral by turns. */
static void fly(float band_n, float off_n, float seconds)
{
    for (int i = 0; i < (int)(seconds / 0.025F); i++) {
        const float wish_n = ((i / 40) % 2 == 0) ? off_n : -off_n;
        const float command_n = deadband_compensate(&deadband, NEUTRAL, NEUTRAL + wish_n);
        const float expected_n = deadband_effect(&deadband, NEUTRAL, command_n) - NEUTRAL;
        deadband_learn(&deadband, expected_n, expected_n - effect(command_n, band_n), 0.025F);
    }
}

void test_a_band_is_found_within_two_seconds_and_forgotten_when_it_is_gone(void)
{
    fly(0.47F, 0.3F, 2.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.47F, deadband.band_n);
    fly(0.0F, 0.3F, 2.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.0F, deadband.band_n);
}

void test_the_band_stays_within_its_bounds(void)
{
    fly(4.0F, 0.3F, 20.0F);
    TEST_ASSERT_EQUAL_FLOAT(1.5F, deadband.band_n);
    for (int i = 0; i < 1000; i++) {
        deadband_learn(&deadband, 0.3F, -2.0F, 0.025F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, deadband.band_n);
}

void test_at_neutral_nothing_is_learnt(void)
{
    deadband.band_n = 0.3F;
    for (int i = 0; i < 1000; i++) {
        deadband_learn(&deadband, 0.0F, 1.0F, 0.025F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.3F, deadband.band_n);
}

void test_noise_leaves_the_band_where_it_is_on_average(void)
{
    unsigned random_bits = 99U;
    float sum = 0.0F;
    for (int i = 0; i < 8000; i++) {
        random_bits = (random_bits * 1664525U + 1013904223U) & 0xFFFFFFFFU;
        const float noise_n = 0.7F * ((float)(random_bits >> 8) / 8388608.0F - 1.0F);
        const float side = (i % 2 == 0) ? 1.0F : -1.0F;
        deadband_learn(&deadband, 0.25F * side, side * (0.47F - deadband.band_n) + noise_n, 0.025F);
        sum += (i >= 4000) ? deadband.band_n : 0.0F;
    }
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.47F, sum / 4000.0F);
}
