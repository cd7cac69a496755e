/* One hypothesis about vehicle, ramp and ground: against the estimator's own filter, and against arithmetic
 * by hand. */
#include "control/est/terrain_hypothesis.h"
#include "control/est/terrain.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define DT_S 0.025F
#define FORE ((uint16_t)MIRROR_FORE)

static terrain_hypothesis_t h;

void setUp(void)
{
    memset(&h, 0, sizeof h);
    h.share = 1.0F;
    h.x[TERRAIN_ALTITUDE] = 0.6F;
    h.x[TERRAIN_SPEED] = 0.2F;
    h.x[TERRAIN_BIAS] = 0.1F;
    h.x[TERRAIN_SLOPE] = 1.0F;
    h.x[TERRAIN_GROUND_SPEED] = 0.4F;
    h.p[TERRAIN_ALTITUDE][TERRAIN_ALTITUDE] = 1.0e-4F;
    h.p[TERRAIN_SPEED][TERRAIN_SPEED] = 0.04F;
    h.p[TERRAIN_BIAS][TERRAIN_BIAS] = 0.09F;
    h.p[TERRAIN_SLOPE][TERRAIN_SLOPE] = 0.16F;
}

void tearDown(void) {}

/* filter.c adds 4.7 mm per root second to the height; here the common noise is that. */
void test_it_is_predicted_as_the_estimators_filter_is(void)
{
    const motion_t motion = {.up_mps2 = 0.7F, .share = 0.6F, .drift = 0.02F};
    const filter_drift_t drift = {.bias_mps2 = 0.02F};
    filter_t filter = {.estimate = {.height_m = 0.6F, .speed_mps = 0.2F, .bias_mps2 = 0.1F}};

    for (int i = 0; i < 3; i++) {
        filter.covariance[i][i] = h.p[i][i];
    }
    for (int k = 0; k < 20; k++) {
        filter_predict(&filter, &motion, DT_S, &drift);
        terrain_hypothesis_predict(&h, &motion, DT_S, drift.bias_mps2);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, filter.estimate.height_m, h.x[TERRAIN_ALTITUDE]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, filter.estimate.speed_mps, h.x[TERRAIN_SPEED]);
    TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, filter.covariance[0][0], h.p[0][0]);
    for (int i = 0; i < 3; i++) {
        for (int j = (i == 0) ? 1 : i; j < 3; j++) {
            TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, filter.covariance[i][j], h.p[i][j]);
            TEST_ASSERT_EQUAL_FLOAT(h.p[i][j], h.p[j][i]);
        }
    }
}

/* variance 1e-4 + 36e-6: gain 0.735 */
void test_a_height_corrects_the_altitude_and_tells_its_density(void)
{
    const float sum = 1.0e-4F + TERRAIN_OWN_M * TERRAIN_OWN_M;
    const float height_m[MIRROR_COUNT] = {0.62F, 0.62F, 0.62F};
    const float density = terrain_innovation_density(terrain_hypothesis_innovation(&h, height_m), 1U << FORE);

    terrain_hypothesis_correct(&h, FORE, 0.62F);

    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.6F + 0.02F * 1.0e-4F / sum, h.x[TERRAIN_ALTITUDE]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-8F, 1.0e-4F * TERRAIN_OWN_M * TERRAIN_OWN_M / sum, h.p[0][0]);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, TERRAIN_OWN_M / sqrtf(sum) * expf(-0.5F * 4.0e-4F / sum), density);
    TEST_ASSERT_EQUAL_FLOAT(0.2F, h.x[TERRAIN_SPEED]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, h.x[TERRAIN_GROUND]); /* nothing is unknown of it */
}

/* The density of all at once is that of each, after those before it have corrected the hypothesis. */
void test_the_density_of_three_heights_is_that_of_one_after_the_other(void)
{
    const float height_m[MIRROR_COUNT] = {0.61F, 0.58F, 0.595F};
    float one_by_one = 1.0F;

    terrain_hypothesis_rise(&h, 1U << FORE, 0.0F, 0.1F);
    const float at_once = terrain_innovation_density(terrain_hypothesis_innovation(&h, height_m), 7U);
    for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
        one_by_one *= terrain_innovation_density(terrain_hypothesis_innovation(&h, height_m),
                                                 (uint16_t)(1U << m));
        terrain_hypothesis_correct(&h, m, height_m[m]);
    }
    TEST_ASSERT_TRUE(at_once > 1.0e-5F && at_once < 1.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F * at_once, at_once, one_by_one);
}

void test_ground_that_is_met_is_as_unsure_as_the_altitude_and_moves_with_it(void)
{
    terrain_hypothesis_meet(&h, FORE, 0.5F);
    const uint16_t ground = terrain_ground_of(FORE);

    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.1F, h.x[ground]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 1.0e-4F, h.p[ground][TERRAIN_ALTITUDE]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 1.0e-4F + TERRAIN_OWN_M * TERRAIN_OWN_M, h.p[ground][ground]);
    terrain_hypothesis_correct(&h, (uint16_t)MIRROR_AFT, 0.61F); /* its ground is known: 0 */
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, h.x[TERRAIN_ALTITUDE] - 0.5F, h.x[ground]);
}

/* 0.4 m/s for 0.1 s, and 50 mm by the tilt, on a slope of 1. */
void test_the_ground_on_a_ramp_rises_by_the_slope_times_the_way_of_the_spot(void)
{
    const uint16_t ground = terrain_ground_of(FORE);

    h.ramps = 1U << FORE;
    terrain_hypothesis_rise(&h, 1U << FORE, 0.05F, 0.1F);
    TEST_ASSERT_EQUAL_HEX16(1U << FORE, h.ramps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.09F, h.x[ground]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.09F * 0.16F, h.p[ground][TERRAIN_SLOPE]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.09F * 0.09F * 0.16F, h.p[ground][ground]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, h.x[terrain_ground_of((uint16_t)MIRROR_AFT)]);
    terrain_hypothesis_correct(&h, FORE, 0.49F); /* 20 mm more ground than that */
    TEST_ASSERT_TRUE(h.x[TERRAIN_SLOPE] > 1.1F && h.x[TERRAIN_SLOPE] < 1.25F);
    TEST_ASSERT_FLOAT_WITHIN(0.003F, 0.6F, h.x[TERRAIN_ALTITUDE]);
}

void test_one_that_joins_a_ramp_has_been_on_it_for_half_of_the_scan(void)
{
    const uint16_t ground = terrain_ground_of(FORE);

    h.p[TERRAIN_SLOPE][TERRAIN_SLOPE] = 0.0F;
    terrain_hypothesis_rise(&h, 1U << FORE, 0.0F, 0.1F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.02F, h.x[ground]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-7F, 0.04F * 0.04F / 12.0F, h.p[ground][ground]);
}

/* Neither derivative tells it: the mean of both is 0. */
void test_a_slope_and_a_speed_that_may_both_be_anything_make_a_rise_that_may_be_anything(void)
{
    const uint16_t ground = terrain_ground_of(FORE);

    h.ramps = 1U << FORE;
    h.x[TERRAIN_SLOPE] = h.x[TERRAIN_GROUND_SPEED] = 0.0F;
    h.p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED] = 0.09F;
    terrain_hypothesis_rise(&h, 1U << FORE, 0.0F, 0.1F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, h.x[ground]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-7F, 0.16F * 0.09F * 0.01F, h.p[ground][ground]);
}

/* 0.1 rad nose down for half a minute: 0.98 m/s2 for the 0.6 s in which it is forgotten. */
void test_the_tilt_tells_how_the_speed_over_the_ground_changes_and_not_what_it_is(void)
{
    for (int i = 0; i < 300; i++) {
        terrain_hypothesis_travel(&h, 0.098F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.588F, h.x[TERRAIN_GROUND_SPEED]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, TERRAIN_SPEED_UNTOLD_MPS,
                             sqrtf(h.p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED]));
    for (int i = 0; i < 6; i++) {
        terrain_hypothesis_travel(&h, 0.0F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.588F * expf(-1.0F), h.x[TERRAIN_GROUND_SPEED]);
    terrain_hypothesis_travel(&h, 0.0F, 1.0F); /* a gap is longer than that */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, h.x[TERRAIN_GROUND_SPEED]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, TERRAIN_SPEED_UNTOLD_MPS * TERRAIN_SPEED_UNTOLD_MPS,
                             h.p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED]);
}

/* Else a ramp that gets steeper was followed as far as the slope was unsure, and then no more. */
void test_a_slope_that_was_sure_is_less_so_a_second_later(void)
{
    h.p[TERRAIN_SLOPE][TERRAIN_SLOPE] = 0.0F;
    for (int i = 0; i < 10; i++) {
        terrain_hypothesis_travel(&h, 0.0F, 0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.1F, h.p[TERRAIN_SLOPE][TERRAIN_SLOPE]);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, h.x[TERRAIN_SLOPE]);
}

void test_grounds_that_are_bound_are_one_and_correct_the_altitude(void)
{
    const uint16_t aft = (uint16_t)MIRROR_AFT;
    const uint16_t ground = terrain_ground_of(FORE);

    h.p[TERRAIN_SLOPE][TERRAIN_SLOPE] = 0.0F;
    terrain_hypothesis_meet(&h, FORE, 0.38F); /* 0.22 m above the aft one's; on a slope of 1 that is 0.2 m */
    const terrain_tie_t tie = terrain_hypothesis_tie(&h, FORE, aft, 0.2F);

    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, -0.02F, tie.off_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 1.0e-4F + TERRAIN_OWN_M * TERRAIN_OWN_M + 0.012F * 0.012F,
                             tie.variance_m2);
    terrain_hypothesis_bind(&h, &tie);
    TEST_ASSERT_TRUE(h.x[ground] < 0.213F && h.x[ground] > 0.2F);
    TEST_ASSERT_TRUE(h.x[TERRAIN_ALTITUDE] < 0.595F);
    TEST_ASSERT_TRUE(h.p[TERRAIN_ALTITUDE][TERRAIN_ALTITUDE] < 0.7e-4F);
    const terrain_tie_t start = terrain_hypothesis_tie(&h, FORE, MIRROR_COUNT, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(-h.x[ground], start.off_m);
}

void test_two_that_are_merged_have_the_mean_and_the_spread_of_both(void)
{
    terrain_hypothesis_t other = h;

    h.share = 3.0F;
    other.x[TERRAIN_SPEED] = 0.6F;
    other.p[TERRAIN_SPEED][TERRAIN_SPEED] = 0.08F;
    terrain_hypothesis_merge(&h, &other);
    TEST_ASSERT_EQUAL_FLOAT(4.0F, h.share);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.3F, h.x[TERRAIN_SPEED]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.05F + 0.25F * 0.75F * 0.16F, h.p[TERRAIN_SPEED][TERRAIN_SPEED]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 1.0e-4F, h.p[TERRAIN_ALTITUDE][TERRAIN_ALTITUDE]);
}

void test_alike_are_those_with_the_same_mirrors_on_a_ramp_and_the_same_motion(void)
{
    terrain_hypothesis_t other = h;

    TEST_ASSERT_TRUE(terrain_hypothesis_alike(&h, &other));
    other.x[TERRAIN_SLOPE] = -0.4F; /* no mirror is on a ramp: its slope means nothing */
    TEST_ASSERT_TRUE(terrain_hypothesis_alike(&h, &other));
    h.ramps = 1U;
    TEST_ASSERT_FALSE(terrain_hypothesis_alike(&h, &other));
    other.ramps = 1U;
    TEST_ASSERT_FALSE(terrain_hypothesis_alike(&h, &other));
    other = h;
    other.x[TERRAIN_ALTITUDE] += 0.012F;
    TEST_ASSERT_FALSE(terrain_hypothesis_alike(&h, &other));
    other = h;
    other.x[TERRAIN_SPEED] -= 0.06F;
    TEST_ASSERT_FALSE(terrain_hypothesis_alike(&h, &other));
}
