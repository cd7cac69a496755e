#include "control/est/effect.h"
#include "unity.h"

#include <math.h>
#include <stdint.h>

#define FRAME_S 0.025F

static effect_t effect;
static uint32_t state;

void setUp(void)
{
    effect_init(&effect);
    state = 1U;
}

void tearDown(void) {}

/* White, with this rms. */
static float noise(float rms)
{
    state = state * UINT32_C(1664525) + UINT32_C(1013904223);
    return rms * 3.4641F * ((float)(state >> 8) / 16777216.0F - 0.5F);
}

typedef struct {
    float share;         /* of the commands that the vehicle does */
    float command_mps2;  /* rms of their quick changes */
    float noise_mps2;    /* rms of the accelerometer's noise */
    float felt_off_mps2; /* constant error of the accelerometer */
} flight_t;

/* Seconds until has_effect is `wanted`; `most_s` when it never is. */
static float until(const flight_t *flight, bool wanted, float most_s)
{
    float pushed_mps2 = 0.0F;

    for (float t_s = 0.0F; t_s < most_s; t_s += FRAME_S) {
        pushed_mps2 += 0.4F * (noise(2.0F * flight->command_mps2) - pushed_mps2); /* through the motors */
        effect_step(&effect, 9.8F + pushed_mps2,
                    flight->share * pushed_mps2 + noise(flight->noise_mps2) + flight->felt_off_mps2, FRAME_S);
        if (effect.has_effect == wanted) {
            return t_s;
        }
    }
    return most_s;
}

void test_a_vehicle_that_does_what_is_commanded_shows_it_within_seconds(void)
{
    for (float share = 0.8F; share <= 1.6F; share += 0.2F) {
        for (float error = -1.5F; error <= 1.5F; error += 1.5F) {
            const flight_t flight = {share, 0.35F, 0.4F, error};
            effect_init(&effect);
            const float shown_s = until(&flight, true, 60.0F);
            TEST_ASSERT_FLOAT_WITHIN(1.3F, 2.7F, shown_s); /* the means are over 1.5 s */
            TEST_ASSERT_EQUAL_FLOAT(60.0F, until(&flight, false, 60.0F));
        }
    }
}

void test_a_vehicle_that_a_pilot_flies_shows_none_but_by_chance_and_not_for_long(void)
{
    for (float command = 0.3F; command < 1.3F; command += 0.3F) {
        const flight_t flight = {0.0F, command, 0.5F, 0.1F};
        float shown_s = 0.0F;

        effect_init(&effect);
        for (float t_s = 0.0F; t_s < 600.0F; t_s += FRAME_S) {
            (void)until(&flight, true, FRAME_S);
            shown_s += effect.has_effect ? FRAME_S : 0.0F;
        }
        TEST_ASSERT_TRUE(shown_s < (command > 0.5F ? 0.1F : 20.0F));
    }
}

void test_a_third_of_an_effect_is_none(void)
{
    const flight_t flight = {0.33F, 0.8F, 0.3F, 0.0F};
    TEST_ASSERT_EQUAL_FLOAT(60.0F, until(&flight, true, 60.0F));
}

static bool swing(float mps2)
{
    effect_init(&effect);
    for (int i = 0; i < 1200; i++) { /* a pilot swings it at 0.7 Hz, and the commands go along with him */
        const float pushed_mps2 = mps2 * sinf(6.2832F * 0.7F * FRAME_S * (float)i);
        effect_step(&effect, pushed_mps2, pushed_mps2, FRAME_S);
    }
    return effect.has_effect;
}

void test_commands_that_swing_far_show_no_effect(void)
{
    TEST_ASSERT_FALSE(swing(2.6F));
    TEST_ASSERT_TRUE(swing(1.2F));
}

void test_commands_that_hardly_change_tell_nothing(void)
{
    const flight_t flight = {1.0F, 0.07F, 0.02F, 0.0F};
    TEST_ASSERT_EQUAL_FLOAT(60.0F, until(&flight, true, 60.0F));
}

void test_when_the_pilot_takes_over_the_effect_ends_within_seconds(void)
{
    const flight_t ours = {1.0F, 0.4F, 0.4F, 0.0F};
    const flight_t his = {0.0F, 0.6F, 0.4F, 0.0F};

    for (int again = 0; again < 10; again++) {
        TEST_ASSERT_TRUE(until(&ours, true, 60.0F) < 5.0F);
        (void)until(&ours, false, 5.0F);
        TEST_ASSERT_FLOAT_WITHIN(1.9F, 2.0F, until(&his, false, 60.0F));
    }
}

void test_slow_motions_of_the_vehicle_that_answer_nothing_count_little(void)
{
    for (int i = 0; i < 4000; i++) { /* 0.3 Hz, and the commands against the speed */
        const float phase = 6.2832F * 0.3F * FRAME_S * (float)i;
        effect_step(&effect, -0.8F * sinf(phase - 0.3F) + noise(0.2F), 0.5F * cosf(phase) + noise(0.4F),
                    FRAME_S);
        TEST_ASSERT_FALSE(effect.has_effect);
    }
}
