#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

/* One frame of 25 ms of a still vehicle whose witnesses have these speeds, still_s after the tilt came to
 * rest; sums of standing and of stillness run from 0.3 s and still_s. */
static void lie_still(float felt_mps, float pushed_mps, float still_s)
{
    setUp();
    feel(0.0F);
    senses.accelerometer.felt = (witness_t){.speed_mps = felt_mps, .running_s = 2.0F};
    senses.push.pushed = (witness_t){.speed_mps = pushed_mps, .running_s = 2.0F};
    calm_for_s(still_s);
    stood_for_s(0.3F);
}

void test_it_stands_while_the_thrust_says_a_fall_of_0_8_that_is_not_felt(void)
{
    static const struct {
        float felt_mps, pushed_mps;
        bool stands;
    } rows[] = {{0.0F, -0.81F, true},  {0.0F, -0.79F, false}, {-0.1F, -0.89F, false},
                {-0.1F, -0.91F, true}, {0.5F, -0.79F, false}, {0.0F, 0.81F, false}};
    for (int i = 0; i < 6; i++) {
        lie_still(rows[i].felt_mps, rows[i].pushed_mps, 0.5F);
        senses.stand.calm_mps[0] = rows[i].felt_mps;
        senses.stand.calm_mps[1] = rows[i].pushed_mps;
        feel(0.0F);
        NEAR(rows[i].stands ? 0.325F : 0.0F, senses.stand.stands_s);
        NEAR(0.525F, senses.stand.calm_s);
    }
}

/* Since the tilt came to rest the speeds have changed from these: only the changes are compared then, and a
 * 80th of them has been taken into the means. */
void test_after_a_second_of_stillness_the_changes_of_the_speeds_tell_it_too(void)
{
    static const struct {
        float still_s, felt0_mps, pushed0_mps;
        bool stands;
    } rows[] = {{1.01F, -1.0F, -0.39F, true},
                {1.01F, -1.0F, -0.41F, false},
                {0.97F, -1.0F, -0.39F, false},
                {1.01F, -0.9F, -0.39F, false},
                {1.01F, -0.9F, -0.28F, true}};
    for (int i = 0; i < 5; i++) {
        lie_still(-1.0F, -0.9F, rows[i].still_s);
        senses.stand.calm_mps[0] = rows[i].felt0_mps;
        senses.stand.calm_mps[1] = rows[i].pushed0_mps;
        feel(0.0F);
        NEAR(rows[i].stands ? 0.325F : 0.0F, senses.stand.stands_s);
    }
}

void test_a_sway_or_a_witness_that_does_not_count_ends_the_standing(void)
{
    for (int what = 0; what < 4; what++) {
        lie_still(0.0F, -0.9F, 0.5F);
        sways_rad2((what == 1) ? 2.6e-4F : 2.5e-4F); /* a 60th is forgotten first */
        senses.sway.sway_rad2 += senses.sway.sway_rad2 / 59.5F * (what == 1);
        senses.accelerometer.felt.running_s = (what == 2) ? 0.5F : 0.51F;
        senses.push.pushed.running_s = (what == 3) ? 0.5F : 0.51F;
        feel(0.0F);
        NEAR((what == 0) ? 0.325F : 0.0F, senses.stand.stands_s);
        NEAR((what == 1) ? 0.0F : 0.525F, senses.stand.calm_s);
    }
}

void test_stillness_begins_anew_with_a_fall_and_keeps_the_speeds_of_that_time(void)
{
    lie_still(-0.41F, -0.2F, 0.5F);
    feel(0.0F);
    NEAR(0.025F, senses.stand.calm_s); /* felt: 0.41 m/s less than before */
    NEAR(-0.41F, senses.stand.calm_mps[0]);
    NEAR(-0.2F, senses.stand.calm_mps[1]);
    lie_still(-0.39F, -0.2F, 0.5F);
    feel(0.0F);
    NEAR(0.525F, senses.stand.calm_s);
    NEAR(-0.39F / 80.0F, senses.stand.calm_mps[0]); /* 25 ms of 2 s */
    NEAR(-0.2F / 80.0F, senses.stand.calm_mps[1]);
    lie_still(0.3F, 0.2F, 0.0F);
    feel(0.0F);
    NEAR(0.3F, senses.stand.calm_mps[0]);
    NEAR(0.2F, senses.stand.calm_mps[1]);
    lie_still(0.3F, 0.2F, 0.5F);
    sways_rad2(1.0e-3F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.stand.calm_s);
    NEAR(0.3F, senses.stand.calm_mps[0]);
}

void test_a_fall_and_a_rock_begin_beyond_their_limits(void)
{
    lie_still(-0.4F, -0.2F, 0.5F);
    feel_at_once(0.0F);
    NEAR(0.5F, senses.stand.calm_s);
    lie_still(0.0F, -0.8F, 0.5F);
    senses.stand.calm_mps[1] = -0.8F;
    feel_at_once(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.stand.stands_s);
    setUp();
    feel(0.0F);
    rock(0.017F, -0.017F);
    NEAR(0.05F, senses.sway.unrocked_s);
}
