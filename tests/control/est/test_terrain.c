/* The ground under three mirrors, with the filter that the estimator uses: a vehicle that is told by an exact
 * accelerometer, over ground that each mirror sees at another place. */
#include "control/est/terrain.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define SCAN_S 0.1F
#define FRAMES 4
#define ALL 7U
#define SPEED_MPS 0.4F

static terrain_t terrain;
static filter_t filter;
static float plane_m;    /* terrain height that the filter's height counts from */
static float altitude_m; /* true */
static float x_m;        /* way flown */
static uint32_t noise;

void setUp(void)
{
    memset(&terrain, 0, sizeof terrain);
    memset(&filter, 0, sizeof filter);
    filter_reset_covariance(&filter);
    filter_reset_variance(&filter, FILTER_TERRAIN, 0.0F);
    altitude_m = 0.6F;
    filter.estimate.height_m = altitude_m;
    plane_m = 0.0F;
    x_m = -1.5F;
    noise = 1U;
}

void tearDown(void) {}

/* Within 4 mm. */
static float noise_m(void)
{
    noise = noise * 1103515245U + 12345U;
    return 0.008F * ((float)((noise >> 16) & 1023U) / 1023.0F - 0.5F);
}

/* A ramp of 0.28 m, a platform of 1.2 m, an edge: the seed's course. */
static float ground_m(float at_m, float height_m)
{
    if (at_m < 0.0F || at_m > 1.48F) {
        return 0.0F;
    }
    return (at_m < 0.28F) ? height_m * at_m / 0.28F : height_m;
}

static void predict(float up_mps2)
{
    const motion_t motion = {.up_mps2 = up_mps2, .share = 1.0F, .drift = 0.01F};
    const filter_drift_t drift = {.bias_mps2 = 0.02F};

    for (int i = 0; i < FRAMES; i++) {
        filter_predict(&filter, &motion, SCAN_S / FRAMES, &drift);
    }
}

static terrain_shown_t scan(const terrain_heights_t *heights)
{
    const terrain_shown_t shown = terrain_scan(&terrain, heights, filter.estimate.height_m + plane_m,
                                               filter.covariance[FILTER_HEIGHT][FILTER_HEIGHT], SCAN_S);

    filter_merge(&filter, &shown.merge);
    filter.estimate.height_m -= shown.ground_m - plane_m;
    plane_m = shown.ground_m;
    return shown;
}

static float known_m(void)
{
    return filter.estimate.height_m + plane_m;
}

/* Flies on for a scan. height_m: of the platform. */
static terrain_shown_t fly(float height_m, uint16_t valid)
{
    static const float ahead_m[MIRROR_COUNT] = {
        [MIRROR_FRONT] = 0.0F, [MIRROR_FORE] = 0.107F, [MIRROR_AFT] = -0.115F};
    terrain_heights_t heights = {.valid = valid};

    x_m += SPEED_MPS * SCAN_S;
    predict(0.0F);
    for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
        heights.height_m[m] = altitude_m - ground_m(x_m + ahead_m[m], height_m) + noise_m();
    }
    return scan(&heights);
}

void test_the_first_scan_tells_the_grounds_and_nothing_of_the_vehicle(void)
{
    const terrain_shown_t shown = fly(0.0F, ALL);

    TEST_ASSERT_EQUAL_FLOAT(0.0F, shown.merge.pull_per_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, shown.innovation_m);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, shown.merge.kept);
    TEST_ASSERT_EQUAL_HEX16(ALL, terrain.known);
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.0F, shown.ground_m);
}

void test_over_level_ground_the_heights_tell_the_altitude(void)
{
    for (int i = 0; i < 10; i++) {
        (void)fly(0.0F, ALL);
    }
    altitude_m += 0.02F;
    const terrain_shown_t shown = fly(0.0F, ALL);
    TEST_ASSERT_TRUE(shown.innovation_m > 0.01F && shown.innovation_m < 0.03F);
    for (int i = 0; i < 20; i++) {
        (void)fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.006F, altitude_m, known_m());
    TEST_ASSERT_TRUE(filter.covariance[FILTER_HEIGHT][FILTER_HEIGHT] < 3.0e-5F);
}

/* The altitude is kept over the ramp, the platform and the edge. Its largest error. */
static float worst_over_m(float height_m, uint16_t valid)
{
    float worst_m = 0.0F;

    while (x_m < 2.5F) {
        (void)fly(height_m, valid);
        worst_m = fmaxf(worst_m, fabsf(known_m() - altitude_m));
    }
    return worst_m;
}

void test_the_altitude_stays_over_ramp_platform_and_edge_of_10_to_40_cm(void)
{
    static const float heights_m[] = {0.1F, 0.15F, 0.2F, 0.25F, 0.3F, 0.4F, -0.25F};

    for (unsigned i = 0; i < sizeof heights_m / sizeof heights_m[0]; i++) {
        setUp();
        TEST_ASSERT_TRUE(worst_over_m(heights_m[i], ALL) < 0.03F);
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.0F, plane_m);
    }
}

/* 0.07 m/s is as slow as what the accelerometer may miss. */
void test_a_ramp_of_5_cm_costs_no_more_than_its_height(void)
{
    TEST_ASSERT_TRUE(worst_over_m(0.05F, ALL) < 0.06F);
}

void test_two_mirrors_tell_it_worse_and_one_does_not(void)
{
    const float two_m = worst_over_m(0.25F, (1U << MIRROR_FORE) | (1U << MIRROR_AFT));

    TEST_ASSERT_TRUE(two_m < 0.08F);
    setUp();
    TEST_ASSERT_TRUE(worst_over_m(0.25F, 1U << MIRROR_FRONT) > 0.08F);
}

void test_an_edge_under_one_mirror_moves_the_ground_of_that_one(void)
{
    for (int i = 0; i < 10; i++) {
        (void)fly(0.0F, ALL);
    }
    terrain_heights_t heights = {.valid = ALL, .height_m = {0.6F, 0.35F, 0.6F}};
    predict(0.0F);
    const terrain_shown_t shown = scan(&heights);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.25F, terrain.ground_m[MIRROR_FORE]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, terrain.ground_m[MIRROR_FRONT]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, terrain.ground_m[MIRROR_AFT]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, shown.ground_m); /* the middle one */
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.0F, shown.innovation_m);
}

void test_level_ground_that_falls_under_all_mirrors_alike_is_a_climb(void)
{
    for (int i = 0; i < 20; i++) {
        (void)fly(0.0F, ALL);
    }
    for (int i = 0; i < 20; i++) { /* nobody has told of 0.15 m/s */
        altitude_m += 0.015F;
        (void)fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.9F, known_m());
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.15F, filter.estimate.speed_mps);
}

void test_a_mirror_that_tells_nothing_keeps_its_ground_and_is_met_once(void)
{
    for (int i = 0; i < 5; i++) {
        (void)fly(0.0F, ALL & ~(1U << MIRROR_AFT));
    }
    TEST_ASSERT_EQUAL_HEX16(ALL & ~(1U << MIRROR_AFT), terrain.known);
    (void)fly(0.0F, ALL);
    TEST_ASSERT_EQUAL_HEX16(ALL, terrain.known);
    const float met_m = terrain.ground_m[MIRROR_AFT];
    (void)fly(0.0F, ALL & ~(1U << MIRROR_AFT));
    TEST_ASSERT_EQUAL_FLOAT(met_m, terrain.ground_m[MIRROR_AFT]);
}

void test_a_glitch_of_all_mirrors_leaves_the_altitude(void)
{
    for (int i = 0; i < 20; i++) {
        (void)fly(0.0F, ALL);
    }
    const terrain_heights_t heights = {.valid = ALL, .height_m = {0.95F, 0.95F, 0.95F}};
    predict(0.0F);
    (void)scan(&heights);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.6F, known_m());
    for (int i = 0; i < 5; i++) {
        (void)fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.6F, known_m());
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.0F, plane_m);
}

void test_one_mirror_or_doubted_ones_do_not_show_the_ground(void)
{
    altitude_t mirrors[MIRROR_COUNT] = {{.valid = true}, {.valid = true}, {.valid = true}};
    terrain_sight_t sight = {&mirrors[0], NULL, 0U, 0U};

    TEST_ASSERT_FALSE(terrain_sees_ground(&sight, false));
    sight.mirrors = mirrors;
    sight.doubted = (1U << MIRROR_FRONT) | (1U << MIRROR_AFT);
    TEST_ASSERT_FALSE(terrain_sees_ground(&sight, false));
    TEST_ASSERT_TRUE(terrain_sees_ground(&sight, true)); /* on a ramp they are, for a moment */
    sight.liars = sight.doubted;
    TEST_ASSERT_FALSE(terrain_sees_ground(&sight, true));
}
