#include "control/laws/descent.h"
#include "unity.h"

#include <math.h>
#include <stdbool.h>

static descent_t descent;

void setUp(void)
{
    descent_start(&descent, -DESCENT_RATE_MM_S); /* it sinks as fast as it wants to */
}

void tearDown(void) {}

/* D v / g of the hover thrust: 2.4 * 0.3 / 9.81 = 7.3 %. */
void test_at_the_wanted_rate_the_thrust_is_seven_per_cent_below_hover(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.0F * (1.0F - 0.0734F),
                             descent_step(&descent, 7.0F, 2000.0F, -300.0F, 0.1F));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.0F, descent.trim_n);
}

void test_too_fast_is_more_thrust_and_too_slow_is_less(void)
{
    const float right_n = descent_step(&descent, 7.0F, 2000.0F, -300.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, right_n + 0.3407F, descent_step(&descent, 7.0F, 2000.0F, -500.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, right_n - 0.3407F, descent_step(&descent, 7.0F, 2000.0F, -100.0F, 0.0F));
}

/* A vehicle that sinks already: at the rate that it wants nothing is learned. */
static bool wants_mm_s(float sink_mm_s, float height_mm)
{
    descent_start(&descent, -1000.0F);
    (void)descent_step(&descent, 7.0F, height_mm, -sink_mm_s, 1.0F);
    return fabsf(descent.trim_n) < 1.0e-5F;
}

void test_the_wanted_rate_is_constant_above_0_6_m_and_half_of_it_at_the_ground(void)
{
    TEST_ASSERT_TRUE(wants_mm_s(300.0F, 3000.0F));
    TEST_ASSERT_TRUE(wants_mm_s(300.0F, 600.0F));
    TEST_ASSERT_TRUE(wants_mm_s(225.0F, 300.0F));
    TEST_ASSERT_TRUE(wants_mm_s(150.0F, 0.0F));
    TEST_ASSERT_TRUE(wants_mm_s(150.0F, -50.0F));
    TEST_ASSERT_FALSE(wants_mm_s(295.0F, 3000.0F));
    TEST_ASSERT_FALSE(wants_mm_s(305.0F, 3000.0F));
}

void test_the_wanted_rate_flares_without_a_jump(void)
{
    float before_mm_s = 150.0F;

    for (int height = -50; height <= 1000; height += 10) {
        descent_start(&descent, -1000.0F);
        (void)descent_step(&descent, 7.0F, (float)height, 0.0F, 0.0F);
        TEST_ASSERT_TRUE(descent.sink_mm_s >= before_mm_s && descent.sink_mm_s < before_mm_s + 2.6F);
        TEST_ASSERT_TRUE(height > 200 || descent.sink_mm_s <= 200.0F);
        before_mm_s = descent.sink_mm_s;
    }
    TEST_ASSERT_EQUAL_FLOAT(DESCENT_RATE_MM_S, before_mm_s);
}

void test_the_wanted_rate_starts_at_the_present_one_and_is_whole_after_a_second(void)
{
    static const float rates_mm_s[] = {0.0F, 400.0F, -120.0F, -299.0F, -1000.0F};

    for (int i = 0; i < 5; i++) {
        const float start_mm_s = fminf(fmaxf(-rates_mm_s[i], 0.0F), DESCENT_RATE_MM_S);

        descent_start(&descent, rates_mm_s[i]);
        for (int step = 0; step <= 10; step++) {
            const float wanted_mm_s = fminf(start_mm_s + 30.0F * (float)step, DESCENT_RATE_MM_S);

            TEST_ASSERT_FLOAT_WITHIN(0.01F, wanted_mm_s, descent.sink_mm_s);
            (void)descent_step(&descent, 7.0F, 2000.0F, rates_mm_s[i], 0.1F);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.01F, DESCENT_RATE_MM_S, descent.sink_mm_s);
    }
}

/* So the thrust of a vehicle that hovers begins at its hover thrust. */
void test_a_descent_from_rest_begins_without_a_jump_of_the_thrust(void)
{
    descent_start(&descent, 0.0F);
    float before_n = descent_step(&descent, 7.0F, 2000.0F, 0.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 7.0F, before_n);
    for (int i = 0; i < 10; i++) { /* 0.5 N for the sink, as much for the rate, and the trim, in a second */
        const float thrust_n = descent_step(&descent, 7.0F, 2000.0F, 0.0F, 0.1F);

        TEST_ASSERT_TRUE(thrust_n < before_n && thrust_n > before_n - 0.14F);
        before_n = thrust_n;
    }
}

void test_after_a_hold_the_rate_grows_again_from_nothing(void)
{
    descent.holds = true;
    (void)descent_step(&descent, 7.0F, 2000.0F, -300.0F, 0.1F);
    descent.holds = false;
    (void)descent_step(&descent, 7.0F, 2000.0F, -30.0F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 30.0F, descent.sink_mm_s);
}

void test_while_it_holds_it_wants_no_rate(void)
{
    descent.holds = true;
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 7.0F, descent_step(&descent, 7.0F, 2000.0F, 0.0F, 1.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descent.trim_n);
}

void test_while_it_holds_a_sway_about_the_height_adds_up_to_nothing(void)
{
    descent.holds = true;
    for (int i = 0; i < 80; i++) {
        (void)descent_step(&descent, 7.0F, 500.0F, (i % 8 < 4) ? 300.0F : -300.0F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, descent.trim_n);
}

/* 1 mN for each mm of way, and 3 mN while it climbs. */
void test_the_trim_is_learned_three_times_as_fast_while_it_climbs(void)
{
    static const float rows[][2] = {{-100.0F, -0.02F}, {0.0F, -0.03F}, {0.1F, -0.09003F}, {100.0F, -0.12F}};

    for (int i = 0; i < 4; i++) {
        setUp();
        (void)descent_step(&descent, 7.0F, 2000.0F, rows[i][0], 0.1F);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i][1], descent.trim_n);
    }
}

void test_the_trim_is_learned_slowly_and_within_two_newtons(void)
{
    for (int i = 0; i < 10; i++) {
        (void)descent_step(&descent, 7.0F, 2000.0F, 0.0F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -0.3F, descent.trim_n);
    for (int i = 0; i < 10000; i++) {
        (void)descent_step(&descent, 7.0F, 2000.0F, 1000.0F, 0.1F);
    }
    TEST_ASSERT_EQUAL_FLOAT(-2.0F, descent.trim_n);
    for (int i = 0; i < 10000; i++) {
        (void)descent_step(&descent, 7.0F, 2000.0F, -1000.0F, 0.1F);
    }
    TEST_ASSERT_EQUAL_FLOAT(2.0F, descent.trim_n);
}

void test_a_wild_sink_is_answered_with_at_most_two_newtons(void)
{
    const float right_n = descent_step(&descent, 7.0F, 2000.0F, -300.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, right_n + 2.0F, descent_step(&descent, 7.0F, 2000.0F, -3000.0F, 0.0F));
}

/* 0.0017 N for each mm/s, and 0.0051 N beyond an error of 1 m/s. */
void test_a_climb_is_braked_three_times_as_hard_beyond_a_metre_per_second_of_error(void)
{
    const float right_n = descent_step(&descent, 7.0F, 2000.0F, -300.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, right_n - 1.7033F, descent_step(&descent, 7.0F, 2000.0F, 700.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, right_n - 1.7033F - 0.511F,
                             descent_step(&descent, 7.0F, 2000.0F, 800.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 1.75F, descent_step(&descent, 7.0F, 2000.0F, 3000.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 2.5F, descent_step(&descent, 10.0F, 2000.0F, 3000.0F, 0.0F));
}

void test_a_quarter_of_the_hover_thrust_is_always_kept(void)
{
    for (int i = 0; i < 1000; i++) {
        TEST_ASSERT_TRUE(descent_step(&descent, 6.0F, 2000.0F, 3000.0F, 0.1F) >= 1.5F);
    }
}

void test_at_the_ground_the_thrust_only_falls_whatever_the_rate_says(void)
{
    float before_n = descent_step(&descent, 7.0F, 30.0F, -800.0F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 7.0F + 0.3F, before_n);
    for (int i = 0; i < 60; i++) {
        const float now_n = descent_step(&descent, 7.0F, (i % 2 == 0) ? 60.0F : 5.0F, -800.0F, 0.1F);
        TEST_ASSERT_TRUE(now_n < before_n || now_n == 0.0F);
        before_n = now_n;
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, before_n);
}

void test_a_height_of_90_mm_ends_what_holds_at_the_ground(void)
{
    (void)descent_step(&descent, 7.0F, 30.0F, -150.0F, 2.0F);
    TEST_ASSERT_TRUE(descent_step(&descent, 7.0F, 89.0F, -150.0F, 0.0F) < 4.0F);
    TEST_ASSERT_TRUE(descent_step(&descent, 7.0F, 91.0F, -150.0F, 0.0F) > 6.0F);
}

void test_a_new_descent_forgets_the_trim(void)
{
    (void)descent_step(&descent, 7.0F, 2000.0F, 0.0F, 0.1F);
    descent_start(&descent, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descent.trim_n);
}

void test_blind_it_starts_at_the_sinking_thrust(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.0F * (1.0F - 0.0734F), descent_blind(7.0F, 0.0F));
}

/* 2 N/s from half a newton above the hover thrust; while the tilt moves as in flight, from 0.9 N below it on
 * 0.2. */
void test_on_the_ground_the_thrust_fades_and_slowly_while_the_tilt_moves(void)
{
    float thrust_n[2] = {0.0F, 0.0F};

    for (int rocks = 0; rocks < 2; rocks++) {
        descent_start(&descent, 0.0F);
        for (int i = 0; i < 20; i++) {
            descent.rocks = rocks != 0;
            thrust_n[rocks] = descent_step(&descent, 7.0F, 0.0F, 0.0F, 0.1F);
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.3F, 7.0F + 0.5F - 4.0F, thrust_n[0] - descent.trim_n);
    TEST_ASSERT_FLOAT_WITHIN(0.3F, 7.0F + 0.5F - 1.4F - 0.26F, thrust_n[1] - descent.trim_n);
}

void test_blind_it_only_decreases_and_never_jumps_until_nothing_is_left(void)
{
    float before_n = descent_blind(8.5F, 0.0F);
    for (int i = 1; i <= 600; i++) {
        const float thrust_n = descent_blind(8.5F, 0.1F * (float)i);
        TEST_ASSERT_TRUE(thrust_n >= 0.0F);
        TEST_ASSERT_TRUE(thrust_n <= before_n && before_n - thrust_n < 0.05F);
        TEST_ASSERT_TRUE(thrust_n < before_n || thrust_n == 0.0F);
        before_n = thrust_n;
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, before_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descent_blind(7.0F, 45.0F));
}

/* Terminal speed at damping 2.4: from 3 m the ground comes after about 8 s. */
void test_blind_it_sinks_at_0_3_m_s_at_first_and_below_half_a_metre_per_second_for_3_m(void)
{
    double fallen_m = 0.0, speed_m_s = 0.0, t_s = 0.0;
    while (fallen_m < 3.0 && t_s < 60.0) {
        speed_m_s = 9.81 * (1.0 - (double)descent_blind(7.4F, (float)t_s) / 7.4) / 2.4;
        TEST_ASSERT_TRUE(t_s > 1.0 || fabs(speed_m_s - 0.3) < 0.01);
        fallen_m += speed_m_s * 0.01;
        t_s += 0.01;
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 8.0F, (float)t_s);
    TEST_ASSERT_TRUE(speed_m_s < 0.5);
}

void test_a_new_descent_begins_in_the_air(void)
{
    descent.near_ground_s = 2.0F;
    descent.rocks = descent.holds = true;
    descent_start(&descent, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descent.near_ground_s);
    TEST_ASSERT_FALSE(descent.rocks || descent.holds);
}
