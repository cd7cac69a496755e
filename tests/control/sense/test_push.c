#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_thrust_arrives_through_the_lag_of_the_command(void)
{
    flown.thrust_n = 7.0F;
    flown.lag_s = 0.15F;
    sensed_thrust(&flown);
    NEAR(1.0F, senses.push.lagged_n); /* 0.025 / 0.175 */
    flown.step_s = 3.0F;
    sensed_thrust(&flown);
    NEAR(1.0F + 6.0F * 0.5F / 0.65F, senses.push.lagged_n); /* a pause counts as half a second */
}

void test_the_pushed_speed_is_the_models(void)
{
    flown.thrust_n = senses.push.lagged_n = 8.0F;
    flown.hover_n = 7.0F;
    senses.tilt.upright = 0.95F;
    senses.push.pushed.speed_mps = 0.2F;
    flown.damping_per_s = 2.0F;
    sensed_thrust(&flown);
    /* implicit: a = (1.4 (8 x 0.95 - 7) - 2 x 0.2) / (1 + 2 x 0.025) */
    NEAR(0.2F + 0.44F / 1.05F * 0.025F, senses.push.pushed.speed_mps);
    NEAR(0.025F, senses.push.pushed.running_s);
    VERY_NEAR(-(0.2F + 0.5F * 0.41905F * 0.025F) * 0.025F, senses.push.pushed.off_m);
}

void test_what_is_commanded_and_not_delivered_yet_has_the_sign_of_the_change(void)
{
    flown.thrust_n = 7.0F;
    senses.push.lagged_n = 9.0F;
    NEAR(1.4F * -2.0F * 0.95F * 0.025F, push_undelivered_mps(&senses.push, &flown, 0.95F));
    senses.push.lagged_n = 7.0F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, push_undelivered_mps(&senses.push, &flown, 0.95F));
}

void test_after_a_gap_the_thrusts_witness_tells_speed_and_way(void)
{
    rises_mps(0.15F);
    senses.push.pushed = (witness_t){.speed_mps = 0.5F, .off_m = 0.1F, .seen_m = 0.3F, .running_s = 0.51F};
    NEAR(0.5F + 0.4F * 0.3F, push_speed_mps(&senses.push, senses.heights.rise_mps));
    NEAR(0.2F, push_moved_m(&senses.push));
    senses.push.pushed.running_s = 0.5F;
    NEAR(0.15F, push_speed_mps(&senses.push, senses.heights.rise_mps));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, push_moved_m(&senses.push));
}
