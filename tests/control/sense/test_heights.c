#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_a_height_moves_the_rate_and_the_sums(void)
{
    hover();
    senses.accelerometer.felt = (witness_t){.speed_mps = 0.3F, .running_s = 2.0F};
    rises_mps(0.1F);
    senses.accelerometer.felt.off_m = 0.07F;
    senses.push.pushed.off_m = -0.02F;
    sensed_height(&flown, 0.53F, 0.1F, 0.1F);
    NEAR(0.1F + (0.3F - 0.1F) / 3.0F, senses.heights.rise_mps); /* 0.1 of 0.2 + 0.1 s */
    NEAR(0.13F, senses.accelerometer.felt.seen_m);              /* 0.07 + 0.03, and 0.3 m/s x 0.1 s of age */
    NEAR(0.1F - 0.18F * 0.13F, senses.accelerometer.felt.off_m);
    NEAR(0.3F + 0.081F * 0.13F, senses.accelerometer.felt.speed_mps);
    VERY_NEAR(-0.01F * 0.13F, senses.accelerometer.bias_mps2);
    NEAR(0.01F, senses.push.pushed.seen_m);
    VERY_NEAR(0.01F - 0.04F * 0.01F, senses.push.pushed.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.53F, senses.heights.height_m);
}

void test_a_young_witness_and_doubted_heights_correct_less(void)
{
    hover();
    senses.accelerometer.felt = (witness_t){.off_m = 0.1F, .running_s = 1.0F};
    height(0.5F);
    NEAR(0.1F - 0.09F * 0.1F, senses.accelerometer.felt.off_m);
    NEAR(0.0405F * 0.1F, senses.accelerometer.felt.speed_mps);
    VERY_NEAR(-0.005F * 0.1F, senses.accelerometer.bias_mps2);
    hover();
    doubted(DOUBT_SIGHT);
    senses.accelerometer.felt = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    height(0.5F);
    NEAR(0.082F, senses.accelerometer.felt.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.bias_mps2);
}

void test_the_bias_ends_at_one_and_a_half_to_either_side(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        hover();
        bias_is_mps2(-1.499F * side);
        senses.accelerometer.felt = (witness_t){.off_m = 0.45F * side, .running_s = 2.0F};
        height(0.5F);
        NEAR(-1.5F * side, senses.accelerometer.bias_mps2);
    }
}

void test_a_long_gap_leaks_all_of_a_sum_and_one_of_a_second_and_a_half_forgets(void)
{
    hover();
    senses.accelerometer.felt = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    senses.push.pushed = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    sensed_height(&flown, 0.5F, 1.4F, 0.0F);
    VERY_NEAR(0.0F, senses.accelerometer.felt.off_m);
    NEAR(0.044F, senses.push.pushed.off_m);
    hover();
    senses.accelerometer.felt = (witness_t){.off_m = 0.1F, .seen_m = 0.1F, .running_s = 2.0F};
    pushed_is(senses.accelerometer.felt);
    is_unconfirmed(true);
    sensed_height(&flown, 0.52F, 1.5F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, senses.accelerometer.felt.seen_m);
    TEST_ASSERT_FALSE(senses.confirmation.unconfirmed);
}

void test_what_neither_witness_explains_is_a_step_of_the_terrain(void)
{
    static const struct {
        float rise_m, felt_mps, pushed_mps;
        bool step;
    } rows[] = {{0.10F, 0.0F, 0.0F, false},   {0.125F, 0.0F, 0.0F, false}, {0.135F, 0.0F, 0.0F, true},
                {-0.125F, 0.0F, 0.0F, false}, {-0.135F, 0.0F, 0.0F, true}, {0.225F, 1.0F, 0.0F, false},
                {0.235F, 1.0F, 0.0F, true},   {0.225F, 0.0F, 1.0F, false}, {0.235F, 0.0F, 1.0F, true},
                {-0.135F, 1.0F, 1.0F, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hover();
        senses.accelerometer.felt = (witness_t){.speed_mps = rows[i].felt_mps, .running_s = 0.1F};
        senses.push.pushed = (witness_t){.speed_mps = rows[i].pushed_mps, .running_s = 0.1F};
        rises_mps(0.06F);
        height(0.5F + rows[i].rise_m);
        TEST_ASSERT_EQUAL(rows[i].step, senses.heights.stepped);
        if (rows[i].step) {
            TEST_ASSERT_EQUAL_FLOAT(0.06F, senses.heights.rise_mps);
            NEAR(0.1F * rows[i].felt_mps,
                 senses.accelerometer.felt.seen_m); /* taken as if the witness had been right */
            NEAR(0.1F * rows[i].pushed_mps, senses.push.pushed.seen_m);
        } else {
            NEAR(0.06F + (10.0F * rows[i].rise_m - 0.06F) / 3.0F, senses.heights.rise_mps);
            NEAR(rows[i].rise_m, senses.push.pushed.seen_m);
        }
    }
}

void test_witnesses_that_have_not_begun_explain_nothing(void)
{
    hover();
    senses.accelerometer.felt.speed_mps = senses.push.pushed.speed_mps = 1.0F;
    height(0.615F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.heights.rise_mps); /* a step */
    hover();
    height(0.595F);
    NEAR(0.95F / 3.0F, senses.heights.rise_mps);
    setUp();
    height(0.9F); /* the first height */
    TEST_ASSERT_TRUE(senses.heights.known);
}

void test_a_rate_is_of_ten_milliseconds_at_least(void)
{
    hover();
    sensed_height(&flown, 0.511F, 0.011F, 0.0F);
    NEAR(0.011F / 0.211F, senses.heights.rise_mps);
    hover();
    sensed_height(&flown, 0.505F, 0.005F, 0.0F);
    NEAR(0.5F * 0.005F / 0.205F, senses.heights.rise_mps);
}

/* ---- below the ground */

static bool accepts(float height_mm)
{
    return heights_can_be(&senses.heights, height_mm);
}

void test_the_lower_limit_of_a_height_belongs_to_it(void)
{
    TEST_ASSERT_TRUE(accepts(-50.0F));
    TEST_ASSERT_FALSE(accepts(-50.1F));
}

void test_what_is_no_number_is_no_height_and_the_next_height_is_one(void)
{
    static const float odd_mm[] = {NAN, -INFINITY};

    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_FALSE(accepts(odd_mm[i]));
        TEST_ASSERT_TRUE(accepts(500.0F));
    }
}

/* Three sigma of 6.4 mm higher, 19.2 mm. */
void test_a_height_below_the_ground_counts_again_when_no_noise_explains_it(void)
{
    TEST_ASSERT_FALSE(accepts(-50.1F));
    TEST_ASSERT_TRUE(senses.heights.below_ground);
    TEST_ASSERT_FALSE(accepts(-30.9F));
    TEST_ASSERT_TRUE(accepts(-30.7F));
    TEST_ASSERT_FALSE(senses.heights.below_ground);
    TEST_ASSERT_TRUE(accepts(-50.0F));
}
