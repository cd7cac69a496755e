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

/* ---- what is lost */

static rule_case_t case_of(float felt_m, float pushed_m, float felt_s, float pushed_s)
{
    setUp();
    felt_is((witness_t){.seen_m = felt_m, .running_s = felt_s});
    pushed_is((witness_t){.seen_m = pushed_m, .running_s = pushed_s});
    return rules_case(&senses, &flown, felt_s > 0.5F);
}

void test_the_error_of_the_height_is_the_mean_of_the_witnesses_that_count(void)
{
    rule_case_t c = case_of(-0.52F, -0.30F, 2.0F, 2.0F);
    NEAR(-0.41F, rules_lost_m(&c));
    c = case_of(-0.52F, -0.30F, 0.4F, 2.0F);
    NEAR(-0.30F, rules_lost_m(&c));
    c = case_of(-0.52F, -0.30F, 2.0F, 0.4F);
    NEAR(-0.52F, rules_lost_m(&c));
}
