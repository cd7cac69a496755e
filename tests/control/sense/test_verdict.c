/* How doubts come and go, from both sides of each limit. */
#include "sense/judged.h"

void setUp(void)
{
    evidence_begin();
}

void tearDown(void) {}

/* ---- the sight */

void test_mirrors_that_all_lie_are_doubted_at_once_whatever_the_witnesses_tell(void)
{
    static const float offs_m[] = {-0.7F, 0.0F, 0.7F};

    for (int i = 0; i < 9; i++) {
        setUp();
        TEST_ASSERT_EQUAL_UINT16(0U, judged(offs_m[i % 3], offs_m[i / 3]));
        all_lie(true);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(offs_m[i % 3], offs_m[i / 3]));
        TEST_ASSERT_EQUAL(VERDICT_BLIND, verdict_reason(&verdict));
    }
}

/* No mirror has told anything before: the world with all its probability is the first. */
void test_a_doubt_of_the_sight_keeps_the_height_of_the_blind_worlds_and_starts_the_sums_anew(void)
{
    senses.mirrors.belief.worlds[0] = (belief_world_t){.probability = 1.0F, .height_mm = 410.0F};
    all_lie(true);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(-0.52F, -0.30F));
    NEAR(0.41F, verdict.blind_height_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.off_m);
    senses.mirrors.belief.worlds[0].height_mm = 3000.0F;
    (void)judged(3.0F, 3.0F); /* the height is that when the doubt rose, not now */
    NEAR(0.41F, verdict.blind_height_m);
}

void test_the_sight_is_back_when_a_mirror_sees_a_motion_and_not_before(void)
{
    all_lie(true);
    (void)judged(0.0F, 0.0F);
    for (int scan = 0; scan < 100; scan++) { /* the belief wavers: neither sure of a lie nor of sight */
        all_lie(scan % 2 == 0);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(0.0F, 0.0F));
    }
    all_lie(false);
    one_sees_a_motion(true);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    TEST_ASSERT_EQUAL(VERDICT_NONE, verdict_reason(&verdict));
}

/* Witnesses drift while nothing corrects them: they do not say that the sight is back, nor that it is not. */
void test_the_witnesses_neither_end_nor_keep_a_doubt_of_the_sight(void)
{
    static const float offs_m[] = {0.0F, 3.0F};

    for (int i = 0; i < 2; i++) {
        setUp();
        doubted(DOUBT_SIGHT);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(offs_m[i], offs_m[i]));
        one_sees_a_motion(true);
        TEST_ASSERT_EQUAL_UINT16(0U, judged(offs_m[i], offs_m[i]));
    }
}

/* ---- the accelerometer */

void test_an_accelerometer_that_lies_is_doubted_and_the_sums_that_it_spoilt_start_anew(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, judged(5.0F, 0.0F));
    accelerometer_lies(true);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(5.0F, 0.0F));
    TEST_ASSERT_EQUAL(VERDICT_ALONE, verdict_reason(&verdict));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
}

void test_one_whose_bias_is_beyond_any_is_doubted_too(void)
{
    bias_is_beyond_s(0.9F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    bias_is_beyond_s(1.1F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, 0.0F));
    TEST_ASSERT_EQUAL(VERDICT_ALONE, verdict_reason(&verdict));
}

void test_a_lie_that_is_over_leaves_the_doubt_of_the_accelerometer_to_the_ground(void)
{
    accelerometer_lies(true);
    (void)judged(0.0F, 0.0F);
    accelerometer_lies(false);
    one_sees_a_motion(true);
    for (int scan = 0; scan < 100; scan++) {
        TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, 0.0F));
    }
}

void test_a_lie_that_lasts_does_not_clear_the_sums_again_and_again(void)
{
    accelerometer_lies(true);
    (void)judged(0.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, -0.5F));
    NEAR(-0.5F, senses.push.pushed.seen_m);
}

void test_mirrors_and_accelerometer_can_be_doubted_together_and_the_sight_is_named_first(void)
{
    all_lie(true);
    accelerometer_lies(true);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT | DOUBT_IMU, judged(0.0F, 0.0F));
    TEST_ASSERT_EQUAL(VERDICT_BLIND, verdict_reason(&verdict));
    all_lie(false);
    one_sees_a_motion(true);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, 0.0F));
    TEST_ASSERT_EQUAL(VERDICT_ALONE, verdict_reason(&verdict));
}

void test_at_rest_an_accelerometer_is_doubted_beyond_one_and_a_half_and_fit_again_below_one_point_two(void)
{
    static const struct {
        float rested_s, rest_mps2;
        uint16_t before, after;
    } rows[] = {{1.01F, 1.51F, 0U, DOUBT_IMU},
                {1.01F, -1.51F, 0U, DOUBT_IMU},
                {1.01F, 1.49F, 0U, 0U},
                {0.99F, 1.51F, 0U, 0U},
                {1.01F, 1.21F, DOUBT_IMU, DOUBT_IMU},
                {1.01F, 1.19F, DOUBT_IMU, 0U},
                {0.99F, 0.0F, DOUBT_IMU, DOUBT_IMU},
                {1.01F, 1.19F, 7U, DOUBT_SIGHT | DOUBT_THRUST}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        doubted(rows[i].before);
        has_rested_s(rows[i].rested_s);
        rests_at_mps2(rows[i].rest_mps2);
        verdict_rest(&verdict, &senses.accelerometer);
        TEST_ASSERT_EQUAL_UINT16(rows[i].after, verdict.doubts);
    }
}

/* ---- the thrust */

static uint16_t thrust_again(float contrary_s, bool no_effect)
{
    setUp();
    doubted(DOUBT_THRUST);
    has_told_the_contrary_for_s(contrary_s);
    has_no_effect(no_effect);
    return judged(0.0F, 0.0F);
}

void test_an_effect_for_a_second_and_a_half_ends_a_doubt_of_the_thrust(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, thrust_again(1.5F, false));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, verdict.contrary_s);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, thrust_again(1.49F, false));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, thrust_again(1.5F, true));
}

/* Fifteen scans, or more where some of them tell nothing; as many must tell the contrary again. */
void test_the_thrust_is_doubted_when_most_scans_of_a_second_and_a_half_tell_that_it_has_no_effect(void)
{
    static const struct {
        int every, scans; /* one of so many tells nothing */
    } rows[] = {{1000, 15}, {5, 25}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int scans = 0;

        setUp();
        pushes_n(HOVER_N + 1.0F);
        while (verdict.doubts == 0U && scans < 100) {
            scans++;
            has_no_effect(scans % rows[i].every != 0);
            senses.push.pushed.off_m = -0.4F;
            sensed_height(&flown, senses.heights.height_m, 0.1F, 0.0F);
        }
        TEST_ASSERT_INT_WITHIN(2, rows[i].scans, scans);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, verdict.doubts);
    }
}

void test_a_mirror_that_sees_does_not_give_the_thrust_back(void)
{
    doubted(DOUBT_THRUST);
    has_no_effect(true);
    one_sees_a_motion(true);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, judged(0.0F, 0.0F));
}

/* The belief has told it for long enough, and tells it in this scan too. */
static uint16_t powerless(float push_n, float wanted_m, float pushed_m)
{
    setUp();
    flown.hover_n = 0.0F; /* so that the difference is exact */
    has_told_the_contrary_for_s(1.5F);
    has_no_effect(true);
    pushes_n(push_n);
    flown.wanted_m = wanted_m;
    return judged(0.0F, pushed_m);
}

void test_a_thrust_that_pushes_in_vain_is_doubted_where_the_belief_tells_no_effect(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(0.71F, 0.5F, -0.01F));
    TEST_ASSERT_FALSE(verdict.held_down);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.seen_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(-0.71F, -0.01F, 0.01F));
    TEST_ASSERT_TRUE(verdict.held_down);
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.70F, 0.5F, -0.01F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(-0.70F, -0.5F, 0.01F));
}

void test_a_thrust_that_does_more_than_it_should_is_not_in_vain(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(-0.71F, -0.5F, -1.31F));
}

void test_a_thrust_away_from_the_reference_is_not_in_vain(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, -0.5F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, NAN, -1.31F));
}

static uint16_t in_vain(bool proved, bool no_effect)
{
    has_told_the_contrary_for_s(1.5F);
    is_proved(proved);
    has_no_effect(no_effect);
    return judged(0.0F, -1.4F);
}

void test_a_thrust_that_was_never_proved_or_may_have_an_effect_is_not_doubted(void)
{
    pushes_n(HOVER_N);
    (void)judged(0.0F, 0.0F); /* so it does not push in vain */
    pushes_n(HOVER_N + 1.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, in_vain(false, true));
    TEST_ASSERT_EQUAL_UINT16(0U, in_vain(true, false));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, in_vain(true, true));
    TEST_ASSERT_EQUAL_FLOAT(HOVER_N, verdict.held_n);
}

/* ---- who is judged */

/* What would raise each doubt. */
static void everything_lies(void)
{
    all_lie(true);
    accelerometer_lies(true);
    pushes_n(HOVER_N + 1.0F);
}

void test_on_the_ground_and_under_a_pilot_nothing_is_judged(void)
{
    everything_lies();
    flown.grounded = true;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.7F, -1.4F));
    TEST_ASSERT_EQUAL_FLOAT(-0.7F, senses.accelerometer.felt.seen_m);
    setUp();
    everything_lies();
    flown.ours = false;
    rises_mps(0.3F);
    senses.accelerometer.felt.speed_mps = 1.0F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.7F, -1.4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.running_s);
}

void test_on_the_ground_and_under_a_pilot_no_doubt_ends_either(void)
{
    for (int grounded = 0; grounded < 2; grounded++) {
        setUp();
        doubted(DOUBT_SIGHT);
        one_sees_a_motion(true);
        flown.grounded = grounded != 0;
        flown.ours = grounded != 0;
        TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(0.0F, 0.0F));
    }
}

void test_an_order_ends_the_doubts_of_sight_and_thrust_with_their_reasons(void)
{
    all_lie(true);
    accelerometer_lies(true);
    (void)judged(0.0F, 0.0F);
    verdict_order(&verdict, &senses);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, verdict.doubts);
    TEST_ASSERT_EQUAL(VERDICT_ALONE, verdict_reason(&verdict));
}
