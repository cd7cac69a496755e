/* A bracket over a ground that the test draws: which ground is expected, and which is not. */
#include "control/est/ahead.h"
#include "unity.h"

#include <math.h>

#define SCAN_US 100000U
#define LATER_US \
    250000U /* from the rays to what a command does: 0.15 s of age, 0.1 s of dead time and lag \
             */
#define SETPOINT_M 0.6F
#define ALL 7U

static const float fore_m[MIRROR_COUNT] = {
    [MIRROR_FRONT] = 0.0F, [MIRROR_FORE] = 0.107F, [MIRROR_AFT] = -0.115F};

static ahead_t ahead;
static uint32_t now_us;
static float x_m;
static float height_m; /* altitude of the vehicle above the start */
static float ground_m; /* that its height counts from */
static uint32_t noise_state;

void setUp(void)
{
    ahead = (ahead_t){.known = false};
    now_us = UINT32_MAX - 3U * SCAN_US; /* the clock wraps */
    x_m = 0.0F;
    height_m = 0.6F;
    ground_m = 0.0F;
    noise_state = 1U;
}

void tearDown(void) {}

static float uniform(void)
{
    noise_state = noise_state * 1664525U + 1013904223U;
    return (float)(noise_state >> 8) / 16777216.0F;
}

/* The heights of three grounds in one scan; sigma_m of noise on each. */
static void scan(const float grounds_m[MIRROR_COUNT], uint16_t valid, float sigma_m)
{
    terrain_heights_t heights = {.valid = valid};

    now_us += SCAN_US;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float noise = uniform() + uniform() + uniform() + uniform() - 2.0F;

        heights.fore_m[m] = fore_m[m];
        heights.height_m[m] = height_m - grounds_m[m] + sigma_m * 1.732F * noise;
    }
    ahead_scan(&ahead, &heights, height_m, ground_m, now_us);
}

static float setpoint_of_m(float setpoint_m)
{
    static const cascade_gains_t gains = {.height_per_s = 2.0F, .up_mps = 0.7F, .down_mps = 1.0F};

    return ahead_setpoint_m(&ahead, &gains, setpoint_m, now_us + LATER_US);
}

static float rise_m(void)
{
    return setpoint_of_m(SETPOINT_M) - SETPOINT_M;
}

typedef float profile_t(float x_m);

static float edge_up(float x)
{
    return x > 1.0F ? 0.25F : 0.0F;
}

static float edge_down(float x)
{
    return x > 2.0F ? 0.0F : edge_up(x);
}

static float edge_far_down(float x)
{
    return x > 2.0F ? -0.5F : edge_up(x);
}

static float slope(float x)
{
    return 0.2F * x;
}

/* Flies over a profile until x; +1: nose first, -1: tail first. The height counts from the ground of the
 * middle. */
static void fly_to(profile_t *profile, float to_m, float speed_mps, float nose)
{
    while (x_m < to_m - 1e-4F) {
        float grounds_m[MIRROR_COUNT];

        x_m += speed_mps * 0.1F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            grounds_m[m] = profile(x_m + nose * fore_m[m]);
        }
        ground_m = grounds_m[MIRROR_FRONT];
        scan(grounds_m, ALL, 0.0F);
    }
}

TEST_CASE(0.3F, 1.0F)
TEST_CASE(0.5F, 1.0F)
TEST_CASE(1.0F, 1.0F)
TEST_CASE(0.3F, -1.0F)
TEST_CASE(0.5F, -1.0F)
void test_after_one_edge_the_next_is_expected_from_the_mirror_that_leads(float speed_mps, float nose)
{
    fly_to(edge_down, 1.5F, speed_mps, nose);
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.0F, rise_m());
    while (ahead.under_m[nose > 0.0F ? MIRROR_FORE : MIRROR_AFT] > 0.1F) {
        fly_to(edge_down, x_m + 0.5F * 0.1F * speed_mps, speed_mps, nose);
    }
    if (ground_m > 0.1F) { /* at 1 m/s one scan may show both */
        TEST_ASSERT_TRUE(rise_m() < -0.1F);
        TEST_ASSERT_TRUE(rise_m() >= -0.25F);
    }
    fly_to(edge_down, 3.0F, speed_mps, nose);
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.0F, rise_m());
}

void test_the_first_edge_of_all_moves_the_setpoint_little_since_the_direction_is_not_known(void)
{
    const float met_m[MIRROR_COUNT] = {[MIRROR_FORE] = 0.25F};
    const float level_m[MIRROR_COUNT] = {0.0F};

    for (int i = 0; i < 100; ++i) {
        scan(level_m, ALL, 0.0F);
    }
    scan(met_m, ALL, 0.0F);
    TEST_ASSERT_TRUE(rise_m() > 0.0F);
    TEST_ASSERT_TRUE(rise_m() < 0.06F);
}

/* A beam that is blocked far away looks like an edge of metres. */
void test_ground_out_of_reach_asks_for_no_more_than_ground_at_it(void)
{
    static const float at_m[] = {0.35F, 3.0F, -0.5F, -3.0F};
    const float level_m[MIRROR_COUNT] = {0.0F};
    float moved_m[4];

    for (int k = 0; k < 4; ++k) {
        const float met_m[MIRROR_COUNT] = {[MIRROR_FORE] = at_m[k]};

        setUp();
        scan(level_m, ALL, 0.0F);
        scan(met_m, ALL, 0.0F);
        ahead.nose = 0.5F;
        ahead.tail = 0.0F;
        moved_m[k] = rise_m();
    }
    TEST_ASSERT_TRUE(moved_m[0] > 0.05F && moved_m[2] < -0.05F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, moved_m[0], moved_m[1]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, moved_m[2], moved_m[3]);
}

void test_a_foot_under_one_mirror_again_and_again_moves_it_little(void)
{
    const float foot_m[MIRROR_COUNT] = {[MIRROR_FORE] = 0.25F};
    const float level_m[MIRROR_COUNT] = {0.0F};

    for (int i = 0; i < 200; ++i) {
        scan(i / 4 % 2 == 0 ? level_m : foot_m, ALL, 0.004F);
        TEST_ASSERT_TRUE(fabsf(rise_m()) < 0.1F);
    }
}

void test_over_an_edge_that_its_middle_never_meets_the_vehicle_expects_it_no_more(void)
{
    const float met_m[MIRROR_COUNT] = {[MIRROR_FORE] = 0.25F, [MIRROR_FRONT] = 0.0F, [MIRROR_AFT] = 0.0F};

    fly_to(edge_down, 1.6F, 0.4F, 1.0F);
    ahead.ground_m = ground_m = 0.0F;
    for (int i = 0; i < 20; ++i) {
        scan(met_m, ALL, 0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, rise_m());
}

void test_a_direction_that_turns_round_is_learned_anew(void)
{
    fly_to(edge_down, 1.5F, 0.4F, 1.0F);
    TEST_ASSERT_TRUE(ahead.nose > 0.5F);
    for (int i = 0; i < 8; ++i) { /* back over the edge it came from, tail first in its own axes */
        float grounds_m[MIRROR_COUNT];

        x_m -= 0.08F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            grounds_m[m] = edge_down(x_m + fore_m[m]);
        }
        ground_m = grounds_m[MIRROR_FRONT];
        scan(grounds_m, ALL, 0.0F);
    }
    TEST_ASSERT_TRUE(ahead.tail > ahead.nose);
}

void test_what_is_known_of_the_direction_is_forgotten_over_level_ground(void)
{
    fly_to(edge_up, 1.16F, 0.4F, 1.0F);
    TEST_ASSERT_TRUE(ahead.nose > 0.9F);
    const float known = ahead.nose;

    fly_to(edge_up, 1.16F + 0.4F * 5.0F, 0.4F, 1.0F);
    TEST_ASSERT_TRUE(ahead.nose < 0.05F + (known - 0.05F) / 2.718F + 0.01F);
    TEST_ASSERT_TRUE(ahead.nose > 0.15F);
    fly_to(edge_up, 1.16F + 0.4F * 60.0F, 0.4F, 1.0F);
    TEST_ASSERT_TRUE(ahead.nose < 0.05F && ahead.nose > 0.01F);
}

void test_grounds_that_step_alike_under_all_mirrors_tell_no_direction(void)
{
    const float high_m[MIRROR_COUNT] = {0.25F, 0.25F, 0.25F};
    const float level_m[MIRROR_COUNT] = {0.0F};

    for (int i = 0; i < 50; ++i) {
        const bool high = i / 10 % 2 != 0;

        ground_m = high ? 0.25F : 0.0F;
        scan(high ? high_m : level_m, ALL, 0.0F);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.0F, rise_m());
    }
    TEST_ASSERT_TRUE(ahead.nose < 0.3F && ahead.tail < 0.3F);
}

void test_an_early_descent_keeps_15_cm_above_what_the_tail_still_flies_over(void)
{
    float lowest_m = SETPOINT_M;

    fly_to(edge_far_down, 1.6F, 0.4F, 1.0F);
    while (ground_m > 0.0F) {
        fly_to(edge_far_down, x_m + 0.04F, 0.4F, 1.0F);
        if (ground_m > 0.0F) {
            lowest_m = fminf(lowest_m, setpoint_of_m(0.3F));
            TEST_ASSERT_TRUE(setpoint_of_m(0.3F) >= 0.15F - 1e-6F);
        }
    }
    TEST_ASSERT_TRUE(lowest_m < 0.16F); /* it would have gone down farther */
    /* the tail is over the platform yet, 0.75 m above the new ground */
    TEST_ASSERT_TRUE(ahead.under_m[MIRROR_AFT] > 0.2F);
}

void test_a_setpoint_below_15_cm_is_not_raised_by_an_edge_that_falls(void)
{
    fly_to(edge_far_down, 1.6F, 0.4F, 1.0F);
    while (ground_m > 0.0F) {
        TEST_ASSERT_TRUE(setpoint_of_m(0.1F) <= 0.1F + 1e-6F);
        fly_to(edge_far_down, x_m + 0.04F, 0.4F, 1.0F);
    }
}

void test_without_all_three_heights_nothing_is_expected(void)
{
    const float met_m[MIRROR_COUNT] = {[MIRROR_FORE] = 0.0F, [MIRROR_FRONT] = 0.25F, [MIRROR_AFT] = 0.25F};

    fly_to(edge_down, 1.6F, 0.4F, 1.0F);
    scan(met_m, ALL & ~(1U << MIRROR_AFT), 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(SETPOINT_M, setpoint_of_m(SETPOINT_M));
    scan(met_m, ALL, 0.0F); /* and what was known is forgotten */
    TEST_ASSERT_EQUAL_FLOAT(SETPOINT_M, setpoint_of_m(SETPOINT_M));
}

/* What blocks it looks like ground that comes nearer as the vehicle climbs. */
void test_a_mirror_that_is_disbelieved_ends_what_was_known(void)
{
    static const estimator_t estimator = {.terrain_height_m = 0.0F};
    static const altitude_t mirrors[MIRROR_COUNT];

    for (uint16_t doubted = 0U; doubted <= ALL; doubted++) {
        const terrain_sight_t sight = {
            .altitude = &mirrors[0], .mirrors = (doubted != 0U) ? mirrors : NULL, .doubted = doubted};

        setUp();
        ahead.known = true;
        ahead.nose = 0.9F;
        ahead.under_m[MIRROR_FORE] = 0.5F;
        ahead_look(&ahead, &estimator, &sight, now_us);
        TEST_ASSERT_EQUAL_INT((doubted == 0U) ? 1 : 0, ahead.known ? 1 : 0);
    }
}

void test_before_the_first_scan_nothing_is_expected(void)
{
    TEST_ASSERT_EQUAL_FLOAT(SETPOINT_M, setpoint_of_m(SETPOINT_M));
}

void test_ten_minutes_of_noise_over_level_ground_move_the_setpoint_by_less_than_a_millimetre_rms(void)
{
    const float level_m[MIRROR_COUNT] = {0.0F};
    float squares_m2 = 0.0F;

    for (int i = 0; i < 6000; ++i) {
        scan(level_m, ALL, 0.006F);
        squares_m2 += rise_m() * rise_m();
        TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.0F, rise_m());
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.0F, sqrtf(squares_m2 / 6000.0F));
}

void test_a_slope_is_expected_by_no_more_than_what_the_leading_mirror_shows(void)
{
    while (x_m < 4.0F) {
        fly_to(slope, x_m + 0.04F, 0.4F, 1.0F);
        TEST_ASSERT_TRUE(rise_m() > -0.001F);
        TEST_ASSERT_TRUE(rise_m() < 0.2F * 0.107F + 0.001F);
    }
}
