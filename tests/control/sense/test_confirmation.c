#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_a_step_towards_the_vehicle_is_unconfirmed_until_twelve_centimetres_of_climb(void)
{
    hover();
    content_for_s(0.3F);
    height(0.3F);
    TEST_ASSERT_TRUE(senses.confirmation.unconfirmed);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, senses.confirmation.near_m);
    height(0.36F);
    height(0.419F);
    TEST_ASSERT_TRUE(senses.confirmation.unconfirmed);
    height(0.421F);
    TEST_ASSERT_FALSE(senses.confirmation.unconfirmed);
}

void test_a_step_away_from_the_vehicle_confirms_at_once(void)
{
    hover();
    is_unconfirmed(true);
    came_near_at_m(5.0F);
    height(0.595F);
    TEST_ASSERT_TRUE(senses.confirmation.unconfirmed);
    height(0.70F);
    TEST_ASSERT_FALSE(senses.confirmation.unconfirmed);
}

void test_a_law_that_is_content_for_a_second_confirms(void)
{
    for (int i = 0; i < 2; i++) {
        hover();
        is_unconfirmed(true);
        content_for_s((i == 0) ? 1.0F : 1.01F);
        height(0.5F);
        TEST_ASSERT_EQUAL(i == 0, senses.confirmation.unconfirmed);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.confirmation.quiet_s); /* the law wants to climb */
    }
}

void test_contentment_begins_anew_whenever_the_law_wants_to_climb(void)
{
    hover();
    is_unconfirmed(true);
    for (int scan = 0; scan < 30; scan++) { /* 0.9 s of contentment, again and again */
        flown.wanted_m = (scan % 10 == 9) ? 0.11F : 0.0F;
        height(0.5F);
        TEST_ASSERT_TRUE(senses.confirmation.unconfirmed);
    }
    flown.wanted_m = 0.0F;
    for (int scan = 0; scan < 12; scan++) {
        TEST_ASSERT_TRUE(scan > 9 || senses.confirmation.unconfirmed);
        height(0.5F);
    }
    TEST_ASSERT_FALSE(senses.confirmation.unconfirmed);
}

void test_a_height_after_a_loss_confirms_because_nothing_contradicts_it(void)
{
    static const struct {
        float gap_s;
        bool unconfirmed;
    } rows[] = {{1.49F, true}, {1.5F, false}};
    for (int i = 0; i < 2; i++) {
        hover();
        is_unconfirmed(true);
        sensed_height(&flown, 0.5F, rows[i].gap_s, 0.0F);
        TEST_ASSERT_EQUAL(rows[i].unconfirmed, senses.confirmation.unconfirmed);
    }
}

/* So a step of WITNESS_STEP_M in one scan, which is no step of the terrain, is a climb. */
void test_a_climb_of_a_decimetre_in_one_scan_that_a_witness_tells_confirms(void)
{
    for (int told = 0; told < 2; told++) {
        hover();
        is_proved(false);
        is_unconfirmed(true);
        came_near_at_m(0.5F);
        felt_is((witness_t){.speed_mps = (told != 0) ? 1.0F : 0.0F, .running_s = 2.0F});
        height(0.64F);
        TEST_ASSERT_EQUAL(told == 0, senses.confirmation.unconfirmed);
        TEST_ASSERT_EQUAL(told != 0, senses.confirmation.proved);
    }
}

void test_a_jump_upwards_is_no_first_climb(void)
{
    for (int proved = 0; proved < 2; proved++) {
        hover();
        is_unconfirmed(true);
        is_proved(proved != 0);
        height(0.7F);
        TEST_ASSERT_EQUAL(proved == 0, senses.confirmation.unconfirmed);
        NEAR(proved == 0 ? 0.7F : 0.5F, senses.confirmation.near_m);
    }
}

void test_a_law_is_content_below_a_decimetre_of_wanted_climb(void)
{
    static const float rows[][2] = {{0.09F, 0.3F}, {0.10F, 0.0F}, {0.2F, 0.0F}, {-1.0F, 0.3F}, {NAN, 0.0F}};
    for (int i = 0; i < 5; i++) {
        hover();
        content_for_s(0.2F);
        flown.wanted_m = rows[i][0];
        height(0.5F);
        NEAR(rows[i][1], senses.confirmation.quiet_s);
    }
}

void test_the_first_climb_proves_the_heights_and_starts_the_pushed_speed_from_them(void)
{
    hover();
    is_proved(false);
    is_unconfirmed(true);
    came_near_at_m(0.4F);
    senses.push.pushed = (witness_t){.speed_mps = 2.0F, .off_m = 0.3F, .running_s = 1.0F};
    rises_mps(0.25F);
    senses.accelerometer.felt.off_m = 0.2F;
    height(0.521F);
    TEST_ASSERT_TRUE(senses.confirmation.proved);
    NEAR(0.25F, senses.push.pushed.speed_mps);
    NEAR(0.021F, senses.push.pushed.seen_m);
    NEAR(0.021F, senses.accelerometer.felt.seen_m);
    hover();
    is_unconfirmed(true); /* proved before: the witness knows better */
    came_near_at_m(0.3F);
    senses.push.pushed = (witness_t){.speed_mps = 2.0F, .running_s = 1.0F};
    height(0.5F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, senses.push.pushed.speed_mps);
}

void test_standing_takes_the_proof_back(void)
{
    hover();
    stands(true);
    terrain_fell(true);
    height(0.5F);
    TEST_ASSERT_FALSE(senses.confirmation.proved);
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
    TEST_ASSERT_TRUE(senses.confirmation.unconfirmed);
}

void test_deep_is_a_fall_of_the_terrain_beyond_forty_centimetres(void)
{
    hover();
    height(0.895F);
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
    hover();
    height(0.905F);
    TEST_ASSERT_TRUE(senses.confirmation.terrain_fell);
    height(0.84F);
    height(0.786F);
    TEST_ASSERT_TRUE(senses.confirmation.terrain_fell);
    height(0.784F);
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
    hover();
    height(0.905F); /* what climbs shows that the beam is not blocked, too */
    height(0.965F);
    height(1.024F);
    TEST_ASSERT_TRUE(senses.confirmation.terrain_fell);
    height(1.026F);
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
    hover();
    terrain_fell(true);
    height(0.2F); /* a step back */
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
}

void test_the_end_of_the_depth_lies_below_its_limit(void)
{
    hover();
    terrain_fell(true);
    senses.confirmation.after_fall_m = 0.12F;
    at_m(0.05F);
    height(0.0F);
    TEST_ASSERT_TRUE(senses.confirmation.terrain_fell);
    height(-0.001F);
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
}
