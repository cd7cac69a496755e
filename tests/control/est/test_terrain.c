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

/* The spots of the default geometry, from the middle. */
static const float ahead_m[MIRROR_COUNT] = {
    [MIRROR_FRONT] = 0.0F, [MIRROR_FORE] = 0.107F, [MIRROR_AFT] = -0.115F};

static terrain_t terrain;
static terrain_shown_t shown;
static float altitude_m; /* true */
static float x_m;        /* way flown */
static float wanted_mps; /* speed over the ground */
static float speed_mps;
static float lean; /* that makes it: nose down accelerates, and moves the spots aft */
static uint32_t noise;

void setUp(void)
{
    filter_t filter = {.estimate = {.height_m = 0.6F}};

    filter_reset_covariance(&filter);
    memset(&terrain, 0, sizeof terrain);
    altitude_m = 0.6F;
    const terrain_heights_t heights = {.valid = ALL, .height_m = {0.6F, 0.6F, 0.6F}};

    terrain_begin(&terrain, &filter, &heights, altitude_m, 0.0F);
    x_m = -1.5F;
    speed_mps = wanted_mps = SPEED_MPS;
    lean = 0.0F;
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

    for (int i = 0; i < FRAMES; i++) {
        terrain_predict(&terrain, &motion, SCAN_S / FRAMES, 0.02F);
    }
}

/* Leans by 10 degrees at most towards the wanted speed; the air takes it in 3 s. */
static void travel(void)
{
    const float before = lean;

    lean = -((wanted_mps - speed_mps) / 0.3F + speed_mps / 3.0F) / 9.80665F;
    lean = fminf(fmaxf(lean, -0.17F), 0.17F);
    x_m += speed_mps * SCAN_S;
    speed_mps += (-9.80665F * 0.5F * (before + lean) - speed_mps / 3.0F) * SCAN_S;
}

/* Flies on for a scan. height_m: of the platform. */
static void fly(float height_m, uint16_t valid)
{
    terrain_heights_t heights = {.valid = valid};

    memcpy(heights.fore_m, ahead_m, sizeof ahead_m);

    travel();
    predict(0.0F);
    heights.lean = lean;
    heights.reach_m = altitude_m * lean;
    for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
        heights.height_m[m] = altitude_m - ground_m(x_m + heights.reach_m + ahead_m[m], height_m) + noise_m();
    }
    shown = terrain_scan(&terrain, &heights, SCAN_S);
}

static void see(const terrain_heights_t *heights)
{
    predict(0.0F);
    shown = terrain_scan(&terrain, heights, SCAN_S);
}

/* What the filter of a climb is off by is the vehicle's: taken for the ground's, it stayed for the flight. */
void test_the_first_scan_corrects_the_altitude_and_not_the_ground(void)
{
    for (float off_m = -0.04F; off_m < 0.05F; off_m += 0.02F) {
        filter_t filter = {.estimate = {.height_m = 0.6F + off_m}};

        filter_reset_covariance(&filter);
        filter_reset_variance(&filter, FILTER_HEIGHT, 0.03F * 0.03F);
        memset(&terrain, 0, sizeof terrain);
        const terrain_heights_t heights = {.valid = ALL, .height_m = {0.6F, 0.6F, 0.6F}};

        terrain_begin(&terrain, &filter, &heights, 0.85F + off_m, 0.25F);
        see(&heights);
        TEST_ASSERT_FLOAT_WITHIN(0.006F, 0.85F, shown.altitude_m);
        TEST_ASSERT_FLOAT_WITHIN(0.006F, 0.25F, shown.ground_m);
    }
}

void test_over_level_ground_the_heights_tell_the_altitude(void)
{
    for (int i = 0; i < 10; i++) {
        fly(0.0F, ALL);
    }
    const float before_m = shown.altitude_m;

    altitude_m += 0.02F;
    fly(0.0F, ALL);
    TEST_ASSERT_TRUE(shown.altitude_m > before_m + 0.01F && shown.altitude_m < before_m + 0.03F);
    for (int i = 0; i < 20; i++) {
        fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.006F, altitude_m, shown.altitude_m);
    TEST_ASSERT_TRUE(shown.speed_variance < 0.05F * 0.05F);
}

/* The altitude is kept over the ramp, the platform and the edge. Its largest error. */
static float worst_over_m(float height_m, uint16_t valid)
{
    float worst_m = 0.0F;

    while (x_m < 2.5F) {
        fly(height_m, valid);
        worst_m = fmaxf(worst_m, fabsf(shown.altitude_m - altitude_m));
    }
    return worst_m;
}

void test_the_altitude_stays_over_ramp_platform_and_edge_of_10_to_40_cm(void)
{
    static const float heights_m[] = {0.1F, 0.15F, 0.2F, 0.25F, 0.3F, 0.4F, -0.25F};

    for (unsigned i = 0; i < sizeof heights_m / sizeof heights_m[0]; i++) {
        setUp();
        TEST_ASSERT_TRUE(worst_over_m(heights_m[i], ALL) < 0.03F);
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.0F, shown.ground_m);
    }
}

/* 0.07 m/s is as slow as what the accelerometer may miss. */
void test_a_ramp_of_5_cm_costs_no_more_than_its_height(void)
{
    TEST_ASSERT_TRUE(worst_over_m(0.05F, ALL) < 0.06F);
}

void test_two_mirrors_tell_it_too_and_one_tells_it_worse(void)
{
    TEST_ASSERT_TRUE(worst_over_m(0.25F, (1U << MIRROR_FORE) | (1U << MIRROR_AFT)) < 0.03F);
    setUp();
    TEST_ASSERT_TRUE(worst_over_m(0.25F, 1U << MIRROR_FRONT) > 0.04F);
}

void test_an_edge_under_one_mirror_moves_the_ground_of_that_one(void)
{
    for (int i = 0; i < 10; i++) {
        fly(0.0F, ALL);
    }
    const float before_m = shown.altitude_m;

    see(&(terrain_heights_t){.valid = ALL, .height_m = {0.6F, 0.35F, 0.6F}});
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.25F, terrain.kept[0].x[terrain_ground_of((uint16_t)MIRROR_FORE)]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, terrain.kept[0].x[terrain_ground_of((uint16_t)MIRROR_FRONT)]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, terrain.kept[0].x[terrain_ground_of((uint16_t)MIRROR_AFT)]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, shown.ground_m); /* the middle one */
    TEST_ASSERT_FLOAT_WITHIN(0.005F, before_m, shown.altitude_m);
}

void test_level_ground_that_falls_under_all_mirrors_alike_is_a_climb(void)
{
    for (int i = 0; i < 20; i++) {
        fly(0.0F, ALL);
    }
    for (int i = 0; i < 20; i++) { /* nobody has told of 0.15 m/s */
        altitude_m += 0.015F;
        fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.9F, shown.altitude_m);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.15F, shown.speed_mps);
}

/* 0.3 m/s for 0.4 s, of which the accelerometer tells nothing. A ramp of that rate would be steep. */
void test_a_lurch_over_level_ground_is_no_ramp(void)
{
    for (int starts = 20; starts < 40; starts++) {
        const float step_m = (starts % 2 == 0) ? 0.03F : -0.03F;

        setUp();
        for (int k = 0; k < starts + 20; k++) {
            altitude_m += (k >= starts && k < starts + 4) ? step_m : 0.0F;
            x_m = -1.5F;
            fly(0.0F, ALL);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.015F, altitude_m, shown.altitude_m);
    }
}

/* Begun over a slope of 20 degrees, half over an edge, and with a mirror that tells nothing yet. */
void test_what_the_mirrors_differ_by_at_the_begin_is_the_ground_s(void)
{
    static const terrain_heights_t begins[] = {
        {.valid = ALL, .height_m = {0.6F, 0.56F, 0.64F}},
        {.valid = ALL, .height_m = {0.6F, 0.35F, 0.6F}},
        {.valid = ALL & ~(1U << MIRROR_AFT), .height_m = {0.6F, 0.6F, 0.0F}},
    };

    for (int k = 0; k < 3; k++) {
        const filter_t filter = {.estimate = {.height_m = 0.6F}};

        memset(&terrain, 0, sizeof terrain);
        terrain_begin(&terrain, &filter, &begins[k], 0.6F, 0.0F);
        for (int i = 0; i < 5; i++) {
            terrain_heights_t heights = begins[k];

            if (i == 4 && k == 2) { /* it shows a ground of 0.1 m at once */
                heights = (terrain_heights_t){.valid = ALL, .height_m = {0.6F, 0.6F, 0.5F}};
            }
            see(&heights);
            TEST_ASSERT_FLOAT_WITHIN(0.002F, 0.6F, shown.altitude_m);
            TEST_ASSERT_FLOAT_WITHIN(0.002F, 0.0F, shown.ground_m);
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.1F, terrain.kept[0].x[terrain_ground_of((uint16_t)MIRROR_AFT)]);
}

void test_a_mirror_that_tells_nothing_keeps_its_ground(void)
{
    const uint16_t aft = terrain_ground_of((uint16_t)MIRROR_AFT);

    fly(0.0F, ALL);
    see(&(terrain_heights_t){.valid = ALL, .height_m = {0.6F, 0.6F, 0.5F}});
    const float known_m = terrain.kept[0].x[aft];
    for (int i = 0; i < 5; i++) {
        fly(0.0F, ALL & ~(1U << MIRROR_AFT));
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001F, known_m, terrain.kept[0].x[aft]);
}

void test_a_glitch_of_all_mirrors_leaves_the_altitude(void)
{
    for (int i = 0; i < 20; i++) {
        fly(0.0F, ALL);
    }
    see(&(terrain_heights_t){.valid = ALL, .height_m = {0.95F, 0.95F, 0.95F}});
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.6F, shown.altitude_m);
    for (int i = 0; i < 5; i++) {
        fly(0.0F, ALL);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.6F, shown.altitude_m);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.0F, shown.ground_m);
}

/* One scan explains it by either; three do not. So more than one is kept meanwhile. */
void test_a_ramp_is_told_from_ground_that_falls_behind_over_some_scans(void)
{
    bool unsure = false;

    while (x_m < 0.3F) {
        fly(0.1F, ALL);
        unsure = unsure || terrain.count > 2U;
    }
    TEST_ASSERT_TRUE(unsure);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, altitude_m, shown.altitude_m);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, shown.speed_mps);
}

/* The fore mirror is on the ramp, and goes back down with the vehicle, which then goes on. */
void test_a_vehicle_that_sways_at_the_foot_of_a_ramp_keeps_its_altitude(void)
{
    for (float turn_s = 0.0F; turn_s < 1.5F; turn_s += 0.25F) {
        float worst_m = 0.0F;

        setUp();
        for (float t_s = -3.5F; t_s < 8.0F; t_s += SCAN_S) {
            const bool back = t_s > turn_s && t_s < turn_s + 1.0F;

            wanted_mps = back ? -0.3F : SPEED_MPS;
            fly(0.2F, ALL);
            worst_m = fmaxf(worst_m, fabsf(shown.altitude_m - altitude_m));
        }
        TEST_ASSERT_TRUE(worst_m < 0.05F);
        TEST_ASSERT_TRUE(x_m > 2.0F);
    }
}

void test_the_kept_are_the_most_probable_and_one_together(void)
{
    while (x_m < 2.5F) {
        float sum = 0.0F;

        fly(0.25F, ALL);
        TEST_ASSERT_TRUE(terrain.count >= 1U && terrain.count <= TERRAIN_KEPT);
        for (uint16_t i = 0U; i < terrain.count; i++) {
            TEST_ASSERT_TRUE(terrain.kept[i].share > 0.0F);
            sum += terrain.kept[i].share;
        }
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 1.0F, sum);
    }
}

void test_a_height_that_nothing_explains_changes_nothing(void)
{
    for (int i = 0; i < 20; i++) {
        fly(0.0F, ALL);
    }
    see(&(terrain_heights_t){.valid = ALL, .height_m = {3.0e4F, 3.0e4F, 3.0e4F}});
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.6F, shown.altitude_m);
    TEST_ASSERT_TRUE(terrain.count >= 1U);
    fly(0.0F, ALL);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.6F, shown.altitude_m);
}

/* In 32-bit arithmetic, over a course that never ends: half an hour. */
/* Steps and ramps as no ground has them, at tilts as no vehicle flies: two ways without any share were merged
 * to one that is no number, and the altitude was no number for a flight. */
void test_whatever_the_heights_are_everything_stays_a_number(void)
{
    for (uint32_t seed = 1U; seed <= 40U; seed++) {
        setUp();
        noise = seed;
        terrain_heights_t heights = {
            .valid = ALL, .height_m = {0.6F, 0.6F, 0.6F}, .fore_m = {0.0F, 0.1F, -0.1F}};

        for (int i = 0; i < 300; i++) {
            const uint32_t kind = (noise >> 8) & 7U;

            for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
                const float way_m = noise_m();

                heights.height_m[m] += (kind == 0U) ? 60.0F * way_m : (kind < 4U) ? 8.0F * way_m : way_m;
                heights.height_m[m] = fminf(fmaxf(heights.height_m[m], 0.05F), 3.0F);
            }
            heights.lean = 100.0F * noise_m();
            heights.reach_m = 0.6F * heights.lean;
            heights.valid = (kind == 7U) ? (uint16_t)(1U + ((noise >> 4) & 3U)) : ALL;
            see(&heights);
            TEST_ASSERT_FALSE(isnan(shown.altitude_m) || isnan(shown.ground_m) || isnan(shown.speed_mps));
            for (uint16_t k = 0U; k < terrain.count; k++) {
                TEST_ASSERT_TRUE(terrain.kept[k].share > 0.0F && terrain.kept[k].share <= 1.0F);
            }
        }
    }
}

void test_covariances_stay_symmetric_and_positive_for_half_an_hour(void)
{
    for (int k = 0; k < 18000; k++) {
        x_m = (x_m > 2.5F) ? -1.5F : x_m;
        fly(0.25F, (k % 97 == 50) ? ALL & ~(1U << MIRROR_AFT) : ALL);
        for (uint16_t h = 0U; h < terrain.count; h++) {
            const terrain_hypothesis_t *const one = &terrain.kept[h];

            for (int i = 0; i < (int)TERRAIN_STATES; i++) {
                TEST_ASSERT_TRUE(isfinite(one->x[i]));
                TEST_ASSERT_TRUE(one->p[i][i] > 0.0F);
                for (int j = 0; j < i; j++) {
                    const float most = sqrtf(one->p[i][i] * one->p[j][j]);

                    TEST_ASSERT_TRUE(fabsf(one->p[i][j]) <= 1.01F * most);
                    TEST_ASSERT_FLOAT_WITHIN(0.01F * most, one->p[i][j], one->p[j][i]);
                }
            }
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(2.0F, altitude_m, shown.altitude_m); /* what ramps leave adds up */
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
