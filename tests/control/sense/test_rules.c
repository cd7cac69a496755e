/* Every limit of the rules about the thrust, from both sides. A limit that moves, or a condition that falls
 * out, changes what a flight doubts; it has to be changed here on purpose. */
#include "sense/judged.h"

void setUp(void)
{
    evidence_begin();
}

void tearDown(void) {}

/* ---- what is not the rules' to say */

void test_heights_that_contradict_both_witnesses_are_doubted_by_no_rule(void)
{
    static const float offs_m[] = {-5.0F, -0.7F, 0.7F, 5.0F};

    for (int felt = 0; felt < 4; felt++) {
        for (int pushed = 0; pushed < 4; pushed++) {
            setUp();
            TEST_ASSERT_EQUAL_UINT16(0U, judged(offs_m[felt], offs_m[pushed]));
        }
    }
}

/* ---- DOUBT_THRUST */

static uint16_t powerless(float push_n, float wanted_m, float felt_m, float pushed_m)
{
    setUp();
    flown.hover_n = 0.0F; /* so that the difference is exact */
    pushes_n(push_n);
    flown.wanted_m = wanted_m;
    return judged(felt_m, pushed_m);
}

void test_a_thrust_without_effect_is_doubted_where_heights_and_accelerometer_agree(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(0.71F, 0.5F, 0.0F, -1.31F));
    TEST_ASSERT_FALSE(verdict.held_down);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.seen_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(-0.71F, -0.16F, 0.0F, 1.31F));
    TEST_ASSERT_TRUE(verdict.held_down);
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 0.0F, -1.30F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.70F, 0.5F, 0.0F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.15F, 0.0F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(0.71F, 0.5F, 0.20F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 0.21F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, -0.21F, -1.31F));
}

void test_a_thrust_that_does_more_than_it_should_is_not_in_vain(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 0.0F, 1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(-0.71F, -0.5F, 0.0F, -1.31F));
}

void test_a_thrust_away_from_the_reference_is_not_in_vain(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, -0.5F, 0.0F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, NAN, 0.0F, -1.31F));
}

void test_a_thrust_that_was_never_proved_or_has_no_second_witness_is_not_doubted(void)
{
    pushes_n(HOVER_N);
    (void)judged(0.0F, 0.0F); /* so it does not push in vain */
    pushes_n(HOVER_N + 1.0F);
    is_proved(false);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, -1.4F));
    is_proved(true);
    senses.accelerometer.felt.running_s = 0.5F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, -1.4F));
    senses.accelerometer.felt.running_s = 2.0F;
    senses.push.pushed.running_s = 0.5F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, -1.4F));
    senses.push.pushed.running_s = 2.0F;
    doubted(DOUBT_IMU);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, -1.4F));
    doubted(0U);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, judged(0.0F, -1.4F));
    TEST_ASSERT_EQUAL_FLOAT(HOVER_N, verdict.held_n);
}

/* A noisy accelerometer contradicts less, so it agrees over a wider range. */
void test_what_a_shaken_accelerometer_tells_is_divided(void)
{
    static const struct {
        float felt_m;
        uint16_t doubts;
    } rows[] = {{0.39F, DOUBT_THRUST}, {0.41F, 0U}};

    for (int i = 0; i < 2; i++) {
        setUp();
        shaken_by(2.0F);
        pushes_n(HOVER_N + 1.0F);
        TEST_ASSERT_EQUAL_UINT16(rows[i].doubts, judged(rows[i].felt_m, -1.31F));
    }
}

/* ---- agreement, and what is lost */

static rule_case_t case_of(float felt_m, float pushed_m, float felt_s, float pushed_s, float moved_m)
{
    setUp();
    felt_is((witness_t){.seen_m = felt_m, .moved_m = moved_m, .running_s = felt_s});
    pushed_is((witness_t){.seen_m = pushed_m, .moved_m = moved_m, .running_s = pushed_s});
    return rules_case(&senses, &flown, felt_s > 0.5F);
}

void test_agreement_is_within_two_decimetres_of_each_witness_over_three_of_motion(void)
{
    static const struct {
        float felt_m, pushed_m, moved_m;
        bool agree;
    } rows[] = {{0.19F, -0.19F, 0.31F, true}, {0.21F, 0.0F, 0.31F, false},  {-0.21F, 0.0F, 0.31F, false},
                {0.0F, 0.21F, 0.31F, false},  {0.0F, -0.21F, 0.31F, false}, {0.0F, 0.0F, 0.29F, false}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const rule_case_t c = case_of(rows[i].felt_m, rows[i].pushed_m, 2.0F, 2.0F, rows[i].moved_m);
        TEST_ASSERT_EQUAL(rows[i].agree, rules_agree(&c));
    }
}

void test_a_witness_that_does_not_count_contradicts_nothing(void)
{
    rule_case_t c = case_of(5.0F, 0.0F, 0.4F, 2.0F, 0.31F);
    TEST_ASSERT_TRUE(rules_agree(&c));
    c = case_of(0.0F, 5.0F, 2.0F, 0.4F, 0.31F);
    TEST_ASSERT_TRUE(rules_agree(&c));
}

void test_the_error_of_the_height_is_the_mean_of_the_witnesses_that_count(void)
{
    rule_case_t c = case_of(-0.52F, -0.30F, 2.0F, 2.0F, 0.0F);
    NEAR(-0.41F, rules_lost_m(&c));
    c = case_of(-0.52F, -0.30F, 0.4F, 2.0F, 0.0F);
    NEAR(-0.30F, rules_lost_m(&c));
    c = case_of(-0.52F, -0.30F, 2.0F, 0.4F, 0.0F);
    NEAR(-0.52F, rules_lost_m(&c));
}
