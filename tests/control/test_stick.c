/* Where the stick is, and when it is not believed. */
#include "control/stick.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define CYCLE_S 0.025F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1e-4F, expected, actual)

static stick_t stick;

void setUp(void)
{
    memset(&stick, 0, sizeof stick);
}

void tearDown(void) {}

static void hear(float pulse_us, int cycles)
{
    for (int i = 0; i < cycles; i++) {
        stick_step(&stick, true, pulse_us, CYCLE_S);
    }
}

static void silence(float for_s)
{
    for (float t_s = 0.0F; t_s < for_s - 1e-4F; t_s += CYCLE_S) {
        stick_step(&stick, false, 1500.0F, CYCLE_S);
    }
}

void test_without_a_wire_there_is_no_stick(void)
{
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    silence(100.0F);
    TEST_ASSERT_FALSE(stick_is_good(&stick));
}

void test_it_is_believed_from_the_third_pulse_on(void)
{
    hear(1500.0F, 2);
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    hear(1500.0F, 1);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
    NEAR(1500.0F, stick_pulse_us(&stick));
}

void test_a_short_pulse_is_up_and_beyond_its_way_it_is_at_the_end(void)
{
    static const struct {
        float pulse_us, up;
    } rows[] = {{1500.0F, 0.0F},  {1100.0F, 1.0F}, {1300.0F, 0.5F},
                {1900.0F, -1.0F}, {1000.0F, 1.0F}, {2100.0F, -1.0F}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        hear(rows[i].pulse_us, 3);
        NEAR(rows[i].up, stick_up(&stick, 1500.0F));
    }
}

void test_another_middle_moves_it(void)
{
    hear(1520.0F, 3);
    NEAR(0.0F, stick_up(&stick, 1520.0F));
    NEAR(-0.05F, stick_up(&stick, 1500.0F));
}

void test_a_single_wrong_pulse_does_not_move_it(void)
{
    hear(1500.0F, 50);
    hear(1000.0F, 1);
    NEAR(1500.0F, stick_pulse_us(&stick));
    hear(1500.0F, 1);
    NEAR(1500.0F, stick_pulse_us(&stick));
    TEST_ASSERT_TRUE(stick_is_good(&stick));
}

void test_a_pulse_out_of_range_or_nan_is_none(void)
{
    static const float none[] = {0.0F, 799.9F, 2200.1F, 21.0e6F, NAN, INFINITY};

    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        setUp();
        hear(none[i], 100);
        TEST_ASSERT_FALSE(stick_is_good(&stick));
        hear(1500.0F, 3);
        hear(none[i], 5);
        TEST_ASSERT_TRUE(stick_is_good(&stick));
        NEAR(1500.0F, stick_pulse_us(&stick));
        hear(none[i], 100);
        TEST_ASSERT_FALSE(stick_is_good(&stick));
    }
}

void test_it_is_lost_after_0_35_s_of_silence_and_needs_three_pulses_again(void)
{
    hear(1300.0F, 10);
    silence(0.325F);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
    silence(0.025F);
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    hear(1700.0F, 2);
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    hear(1700.0F, 1);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
    NEAR(1700.0F, stick_pulse_us(&stick));
}

/* A seed's law runs every 108 ms, and sees one pulse in each cycle. */
void test_a_slow_control_cycle_believes_it_too(void)
{
    for (int i = 0; i < 20; i++) {
        stick_step(&stick, true, 1400.0F, 0.108F);
        TEST_ASSERT_EQUAL(i >= 2, stick_is_good(&stick));
        stick_step(&stick, false, 0.0F, 0.15F);
    }
}

void test_a_hand_that_moves_it_from_end_to_end_is_no_noise(void)
{
    hear(1500.0F, 20);
    for (int i = 0; i < 40; i++) {
        const int phase = i % 16; /* 0.2 s each way */

        hear(1100.0F + 100.0F * (float)(phase < 8 ? phase : 16 - phase), 1);
        TEST_ASSERT_TRUE(stick_is_good(&stick));
    }
}

void test_a_stick_that_jumps_about_is_not_believed_until_it_is_quiet(void)
{
    hear(1500.0F, 20);
    for (int i = 0; i < 40; i++) {
        hear((i % 2 == 0) ? 1300.0F : 1700.0F, 1);
    }
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    hear(1500.0F, 10);
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    hear(1500.0F, 40);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
}

void test_what_it_was_before_a_silence_does_not_count_as_noise(void)
{
    for (int i = 0; i < 40; i++) {
        hear((i % 2 == 0) ? 1300.0F : 1700.0F, 1);
    }
    TEST_ASSERT_FALSE(stick_is_good(&stick));
    silence(1.0F);
    hear(1700.0F, 3);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
    hear(1650.0F, 1);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
    setUp();
    hear(1100.0F, 20);
    silence(1.0F);
    hear(1900.0F, 3);
    TEST_ASSERT_TRUE(stick_is_good(&stick));
}
