#include "control/sense/witness.h"
#include "unity.h"

#include <math.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

static witness_t witness;

void setUp(void)
{
    witness_start(&witness, 0.0F);
}

void tearDown(void) {}

void test_dead_reckoning_over_a_second_of_one_metre_per_second_squared(void)
{
    for (int i = 0; i < 40; i++) {
        witness_move(&witness, 1.0F, 0.025F);
    }
    NEAR(1.0F, witness.speed_mps);
    NEAR(-0.5F, witness.off_m); /* the way that a height has to show */
    NEAR(1.0F, witness.running_s);
}

void test_it_counts_after_half_a_second_and_is_old_after_two(void)
{
    witness_move(&witness, 0.0F, 0.5F);
    TEST_ASSERT_FALSE(witness_counts(&witness));
    witness_move(&witness, 0.0F, 0.01F);
    TEST_ASSERT_TRUE(witness_counts(&witness));
    witness_move(&witness, 0.0F, 5.0F);
    TEST_ASSERT_EQUAL_FLOAT(WITNESS_OLD_S, witness.running_s);
}

void test_a_height_that_shows_the_way_leaves_no_sum(void)
{
    witness_start(&witness, 0.5F);
    witness_move(&witness, 0.0F, 0.1F);
    witness_compare(&witness, 0.05F, 0.1F, 0.0F, 0.4F, 0.0F);
    NEAR(0.0F, witness.seen_m);
    NEAR(0.0F, witness.off_m);
}

void test_the_age_of_a_height_is_no_contradiction(void)
{
    witness_start(&witness, 0.5F);
    witness_move(&witness, 0.0F, 0.1F);
    witness_compare(&witness, 0.0F, 0.1F, 0.1F, 0.0F, 0.0F); /* its rays are as old as the climb */
    NEAR(0.0F, witness.seen_m);
}

void test_a_pull_corrects_the_speed_and_a_leak_the_sum(void)
{
    witness_compare(&witness, 0.2F, 0.1F, 0.0F, 2.0F, 0.8F);
    NEAR(0.2F, witness.seen_m);
    NEAR(0.2F - 0.2F * 0.2F, witness.off_m);
    NEAR(0.8F * 0.1F * 0.2F, witness.speed_mps);
}

void test_forgetting_clears_the_sums_and_keeps_the_speed(void)
{
    witness = (witness_t){.speed_mps = 0.3F, .off_m = 0.4F, .seen_m = 0.5F, .running_s = 2.0F};
    witness_forget(&witness);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, witness.off_m + witness.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, witness.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, witness.running_s);
}
