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

void test_a_slant_of_noise_is_no_contentment(void)
{
    for (uint16_t still = 0U; still < 2U; still++) {
        hover();
        content_for_s(0.2F);
        still_scans(still);
        flown.wanted_m = 0.0F;
        height(0.5F);
        NEAR(still == 0U ? 0.3F : 0.0F, senses.confirmation.quiet_s);
    }
}

void test_a_slant_with_a_step_in_it_proves_no_contentment_until_twelve_scans_later(void)
{
    static const struct {
        uint16_t scans;
        float quiet_s;
    } rows[] = {{0U, 0.3F}, {1U, 0.0F}, {11U, 0.0F}, {12U, 0.3F}};
    for (int i = 0; i < 4; i++) {
        hover();
        content_for_s(0.2F);
        slants_known(rows[i].scans);
        flown.wanted_m = 0.0F;
        height(0.5F);
        NEAR(rows[i].quiet_s, senses.confirmation.quiet_s);
    }
}

void test_the_ground_is_the_latest_height_in_state_ground_but_none_that_a_pilot_lifts_it_to(void)
{
    static const struct {
        bool grounded;
        float height_m, ground_m;
    } rows[] = {{true, -0.02F, -0.02F}, {true, 0.01F, 0.0F}, {true, 0.9F, 0.0F}, {false, -0.02F, -0.01F}};
    for (int i = 0; i < 4; i++) {
        hover();
        flown.grounded = rows[i].grounded;
        flown.standing = true;
        ground_is_m(-0.01F);
        height(rows[i].height_m);
        NEAR(rows[i].ground_m, senses.confirmation.ground_m);
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
    terrain_fell(true);
    height(0.2F); /* a step back */
    TEST_ASSERT_FALSE(senses.confirmation.terrain_fell);
}

void test_the_least_felt_error_is_kept_while_unconfirmed(void)
{
    hover();
    is_unconfirmed(true);
    felt_least_is_m(-0.05F);
    senses.accelerometer.felt.off_m = -0.1F;
    height(0.5F);
    NEAR(-0.1F, verdict.rules.felt_least_m);
    senses.accelerometer.felt.off_m = 0.1F;
    height(0.5F);
    NEAR(-0.1F, verdict.rules.felt_least_m);
    is_unconfirmed(false);
    height(0.5F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, verdict.rules.felt_least_m);
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
