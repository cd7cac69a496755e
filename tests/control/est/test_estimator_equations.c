/* The estimator one step at a time, each limit of estimator.h from both sides: which frames it uses, at which
 * instants, and which heights. How it behaves in flight is in test_estimator.c. */
#include "control/est/estimator.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define G_MPS2 9.80665F
#define N FILTER_STATES
#define T_US UINT32_C(4294000000) /* wraps within the tests */
#define FRAME_AGE_US UINT32_C(23600)
#define R_M2 (0.0013F * 0.0013F)
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

static estimator_t e;
static filter_t *const filter = &e.filter; /* its parts, which have headers and tests of their own */
static roughness_t *const roughness = &e.roughness;
static credit_t *const credit = &e.credit;
static imu_sample_t frame;
static modelled_motion_t model;

/* Running, at T_US, with a covariance that is small and has no correlations. */
void setUp(void)
{
    estimator_init(&e);
    e.initialised = e.has_frames = e.felt = true;
    e.delayed_us = e.rays_us = e.now_us = e.felt_us = T_US;
    filter->estimate.height_m = e.now.height_m = roughness->previous_m[0] = roughness->previous_m[1] = 0.5F;
    e.latest.time_us = T_US;
    frame = (imu_sample_t){.sequence = 1U,
                           .arrival_us = T_US + FRAME_AGE_US + 25000U,
                           .ready = true,
                           .has_acceleration = true,
                           .down_mps2 = G_MPS2};
    model = (modelled_motion_t){.known = false};
}

void tearDown(void) {}

static void predict(float up_mps2)
{
    frame.down_mps2 = G_MPS2 + up_mps2;
    estimator_predict(&e, &frame, model);
}

/* At the filter's own instant: nothing is predicted. */
static height_outcome_t see(float height_m)
{
    const altitude_t altitude = {.valid = true, .slant_mm = 1000.0F * height_m};
    return estimator_fuse_height(&e, &altitude, e.delayed_us, false);
}

void test_it_begins_with_nothing_but_assumptions(void)
{
    static const float start[N] = {1.0e-4F, 0.04F, 0.09F, 0.0025F};
    memset(&e, 0x55, sizeof e);
    estimator_init(&e);
    TEST_ASSERT_FALSE(e.initialised || e.has_frames || e.felt);
    NEAR(0.4F, credit->noise_mps2);
    NEAR(0.004F, roughness->noise_m);
    NEAR(1.0F, e.upright);
    for (uint16_t i = 0U; i < N; i++) {
        for (uint16_t j = i; j < N; j++) {
            TEST_ASSERT_EQUAL_FLOAT((i == j) ? start[i] : 0.0F, filter->covariance[i][j]);
        }
    }
}

/* ---- prediction */

/* The filter goes through its oldest frame, dt_s later, when a new one comes. */
static void pass_frame(uint32_t dt_us, float up_mps2, float share, float drift)
{
    e.frames[0] = (estimator_frame_t){.time_us = T_US + dt_us,
                                      .motion = {.up_mps2 = up_mps2, .share = share, .drift = drift}};
    e.frame_count = 1U;
    e.rays_us = T_US + dt_us;
    e.now_us = T_US + dt_us;
    frame.arrival_us = T_US + dt_us + FRAME_AGE_US + 25000U;
    predict(0.0F);
    TEST_ASSERT_EQUAL_UINT32(T_US + dt_us, e.delayed_us);
    TEST_ASSERT_EQUAL_UINT16(1U, e.frame_count);
}

void test_the_state_moves_as_its_equations_say(void)
{
    filter->estimate = (estimate_t){
        .height_m = 0.5F, .speed_mps = 0.3F, .bias_mps2 = 0.2F, .terrain_mps = 0.1F};
    e.terrain_height_m = 0.05F;
    pass_frame(200000U, 1.0F, 0.5F, 0.0F);
    NEAR(0.5F + (0.3F - 0.1F) * 0.2F + 0.5F * 0.9F * 0.04F, filter->estimate.height_m);
    NEAR(0.3F + 0.9F * 0.2F, filter->estimate.speed_mps);
    NEAR(0.2F, filter->estimate.bias_mps2);
    NEAR(0.08F, filter->estimate.terrain_mps);
    NEAR(0.05F + 0.1F * 0.2F, e.terrain_height_m);
}

/* ---- frames */

void test_a_frame_is_kept_and_moves_the_present_estimate(void)
{
    e.now = (estimate_t){.height_m = 0.5F, .speed_mps = 0.2F};
    e.up_mps2 = 1.0F;
    predict(2.0F);
    TEST_ASSERT_EQUAL_UINT16(1U, e.frame_count);
    TEST_ASSERT_EQUAL_UINT32(T_US + 25000U, e.now_us);
    TEST_ASSERT_EQUAL_UINT32(T_US, e.delayed_us);
    NEAR(1.5F, e.latest.motion.up_mps2); /* mean of the two frames */
    NEAR(1.0F, e.latest.motion.share);
    NEAR(0.2F + 1.5F * 0.025F, e.now.speed_mps);
    NEAR(2.0F, e.up_mps2);
    NEAR((0.53F * 0.53F + 0.4F * 0.4F) * 0.025F, e.latest.motion.drift);
    TEST_ASSERT_EQUAL_UINT32(1U, e.sequence);
}

void test_the_oldest_frame_is_used_up_when_no_rays_can_be_older(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        e.frames[0].time_us = T_US + 25000U;
        e.frame_count = 1U;
        e.rays_us = T_US + 25000U - 75000U + more_us; /* the next rays are 75 ms later or more */
        e.now_us = T_US + 25000U;
        frame.arrival_us += 25000U;
        predict(0.0F);
        TEST_ASSERT_EQUAL_UINT16(2U - more_us, e.frame_count);
        TEST_ASSERT_EQUAL_UINT32(T_US + 25000U * more_us, e.delayed_us);
    }
}

void test_of_more_than_sixteen_frames_the_oldest_is_used_up(void)
{
    e.rays_us = T_US - 1000000U;
    for (uint16_t i = 0U; i < 18U; i++) {
        predict(0.0F);
        frame.arrival_us += 25000U;
        frame.sequence++;
        TEST_ASSERT_EQUAL_UINT16((i < 16U) ? i + 1U : 16U, e.frame_count);
    }
    TEST_ASSERT_EQUAL_UINT32(T_US + 50000U, e.delayed_us);
    TEST_ASSERT_EQUAL_UINT32(T_US + 75000U, e.frames[0].time_us);
}

void test_a_gap_beyond_300_ms_starts_anew_and_one_of_300_does_not(void)
{
    static const struct {
        int32_t gap_us;
        bool initialised;
    } rows[] = {{300000, true}, {300001, false}, {-300000, true}, {-300001, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        frame.arrival_us = T_US + FRAME_AGE_US + (uint32_t)rows[i].gap_us;
        predict(0.3F);
        TEST_ASSERT_EQUAL(rows[i].initialised, e.initialised);
        if (!rows[i].initialised) {
            TEST_ASSERT_EQUAL_UINT32(T_US + (uint32_t)rows[i].gap_us, e.delayed_us);
            TEST_ASSERT_EQUAL_UINT32(e.delayed_us, e.rays_us);
            TEST_ASSERT_EQUAL_UINT32(e.delayed_us, e.now_us);
            NEAR(0.3F, credit->previous_mps2[0]);
            NEAR(0.0F, credit->previous_mps2[1] - 0.3F);
        }
    }
}

void test_accelerations_or_angles_out_of_reach_are_none(void)
{
    static const struct {
        float up_mps2, roll_rad, pitch_rad;
        uint32_t sequence;
    } rows[] = {{0.0F, 3.19F, 0.0F, 1U},  {0.0F, -3.19F, 3.19F, 1U}, {0.0F, 3.21F, 0.0F, 0U},
                {0.0F, 0.0F, -3.21F, 0U}, {199.9F, 0.0F, 0.0F, 1U},  {200.1F, 0.0F, 0.0F, 0U},
                {-200.1F, 0.0F, 0.0F, 0U}};
    for (int i = 0; i < 7; i++) {
        setUp();
        frame.median.roll_rad = rows[i].roll_rad;
        frame.median.pitch_rad = rows[i].pitch_rad;
        predict(rows[i].up_mps2);
        TEST_ASSERT_EQUAL_UINT32(rows[i].sequence, e.sequence);
    }
    setUp();
    frame.ready = false;
    predict(0.0F);
    TEST_ASSERT_EQUAL_UINT32(0U, e.sequence);
}

void test_the_source_changes_after_250_ms_without_accelerations(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        frame.has_acceleration = false;
        frame.arrival_us = T_US + FRAME_AGE_US + 250000U + more_us;
        filter->estimate.bias_mps2 = e.now.bias_mps2 = 0.7F;
        e.up_mps2 = 3.0F;
        filter->covariance[FILTER_BIAS][FILTER_BIAS] = 0.01F;
        filter->covariance[FILTER_HEIGHT][FILTER_BIAS] = filter->covariance[FILTER_BIAS][FILTER_TERRAIN] =
            0.001F;
        model = (modelled_motion_t){.known = true, .up_mps2 = 0.6F, .noise_mps2 = 0.8F};
        predict(5.0F);
        TEST_ASSERT_EQUAL(more_us == 0U, e.felt);
        NEAR((more_us == 0U) ? 0.7F : 0.0F, e.now.bias_mps2);
        NEAR((more_us == 0U) ? 0.7F : 0.0F, filter->estimate.bias_mps2);
        NEAR((more_us == 0U) ? 0.01F : 0.09F, filter->covariance[FILTER_BIAS][FILTER_BIAS]);
        NEAR((more_us == 0U) ? 0.001F : 0.0F, filter->covariance[FILTER_HEIGHT][FILTER_BIAS]);
        NEAR((more_us == 0U) ? 0.001F : 0.0F, filter->covariance[FILTER_BIAS][FILTER_TERRAIN]);
        if (more_us != 0U) {
            NEAR(0.6F, e.latest.motion.up_mps2);
            NEAR(1.0F, e.latest.motion.share);
            NEAR(0.53F * 0.53F * 0.025F, e.latest.motion.drift);
            TEST_ASSERT_EQUAL_FLOAT(0.0F, e.up_mps2);
        }
    }
}

void test_without_accelerations_and_model_nothing_is_assumed_to_push(void)
{
    e.felt = frame.has_acceleration = false;
    predict(5.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.latest.motion.up_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.latest.motion.share);
    NEAR(0.4F, credit->noise_mps2); /* and no noise is measured */
}

void test_accelerations_that_come_back_are_the_source_again(void)
{
    e.felt = false;
    filter->estimate.bias_mps2 = 0.5F;
    predict(0.0F);
    TEST_ASSERT_TRUE(e.felt);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->estimate.bias_mps2);
    filter->estimate.bias_mps2 = 0.5F;
    estimator_drop_accelerations(&e);
    TEST_ASSERT_FALSE(e.felt);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->estimate.bias_mps2);
    filter->estimate.bias_mps2 = 0.5F;
    estimator_drop_accelerations(&e);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, filter->estimate.bias_mps2);
}

void test_the_cosine_of_both_angles_is_kept(void)
{
    frame.median.roll_rad = 0.4F;
    frame.median.pitch_rad = -0.3F;
    predict(0.0F);
    NEAR(cosf(0.4F) * cosf(0.3F), e.upright);
    NEAR(0.4F, e.latest.roll_rad);
    NEAR(-0.3F, e.latest.pitch_rad);
}

/* ---- weights */

/* With 0.4 m/s2 of noise against 0.8 of the model: 0.64 / (0.64 + 0.16). How the weight falls: test_credit.c.
 */
void test_acceleration_and_model_are_mixed_by_their_weights(void)
{
    model = (modelled_motion_t){.known = true, .up_mps2 = 0.3F, .noise_mps2 = 0.8F};
    estimator_start(&e, 0.5F, 0.0F, 0.2F);
    predict(1.5F);
    frame.sequence++;
    frame.arrival_us += 25000U;
    const float from_mps = e.now.speed_mps;
    predict(1.5F); /* less 0.2 of bias and 0.3 of the model it is 1 m/s2 off */
    const float share = 0.64F / (0.64F + credit->noise_mps2 * credit->noise_mps2);
    TEST_ASSERT_FLOAT_WITHIN(3.0e-4F, (share * (1.5F - 0.2F) + (1.0F - share) * 0.3F) * 0.025F,
                             e.now.speed_mps - from_mps);
}

/* ---- heights */

void test_a_height_of_a_smooth_floor_has_a_noise_of_1_3_mm(void)
{
    memset(filter->covariance, 0, sizeof filter->covariance);
    filter->covariance[FILTER_HEIGHT][FILTER_HEIGHT] = R_M2;
    filter->covariance[FILTER_HEIGHT][FILTER_SPEED] = 1.0e-5F;
    filter->covariance[FILTER_SPEED][FILTER_SPEED] = 0.04F;
    roughness->previous_m[0] = roughness->previous_m[1] = 0.51F;
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.51F));
    TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, 0.505F,
                             filter->estimate.height_m); /* as sure as the filter: half of it */
    NEAR(0.01F * 1.0e-5F / (2.0F * R_M2), filter->estimate.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-8F, 0.5F * R_M2, filter->covariance[FILTER_HEIGHT][FILTER_HEIGHT]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-8F, 0.5e-5F, filter->covariance[FILTER_HEIGHT][FILTER_SPEED]);
    TEST_ASSERT_TRUE(e.confirmed);
    NEAR(0.01F, e.innovation_m);
}

/* Quiet heights leave 0.8 of the square of a floor's 30 mm; what is beyond 20 mm counts by half. */
void test_a_height_of_a_rough_floor_has_its_noise_too(void)
{
    memset(filter->covariance, 0, sizeof filter->covariance);
    filter->covariance[FILTER_HEIGHT][FILTER_HEIGHT] = 0.5F * (0.8F * 0.0009F - 0.0192F * 0.0192F) + R_M2;
    roughness->noise_m = 0.03F;
    roughness->in_a_row = 2U;
    roughness->previous_m[0] = roughness->previous_m[1] = 0.51F;
    (void)see(0.51F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.026833F, roughness->noise_m);
    TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, 0.505F, filter->estimate.height_m);
}

/* Whether an innovation passes at this variance of the height. */
static bool passes(float variance_m2, float floor_m, float innovation_m)
{
    setUp();
    filter->covariance[FILTER_HEIGHT][FILTER_HEIGHT] = variance_m2;
    roughness->noise_m = floor_m;
    roughness->in_a_row = 2U;
    roughness->previous_m[0] = roughness->previous_m[1] = 0.5F + innovation_m;
    return see(0.5F + innovation_m) == HEIGHT_FUSED && e.confirmed;
}

void test_the_bound_of_an_innovation_is_three_sigma_within_53_and_80_mm(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        TEST_ASSERT_TRUE(passes(1.0e-6F, 0.004F, 0.0525F * side));
        TEST_ASSERT_FALSE(passes(1.0e-6F, 0.004F, 0.0535F * side));
        TEST_ASSERT_TRUE(passes(6.0e-4F, 0.004F, 0.0733F * side)); /* 3 sqrt(6e-4 + 1.69e-6) = 73.6 mm */
        TEST_ASSERT_FALSE(passes(6.0e-4F, 0.004F, 0.0739F * side));
        TEST_ASSERT_TRUE(passes(0.01F, 0.004F, 0.0795F * side));
        TEST_ASSERT_FALSE(passes(0.01F, 0.004F, 0.0805F * side));
        TEST_ASSERT_TRUE(passes(1.0e-6F, 0.0264F, 0.1410F * side)); /* 6 x 23.6 mm */
        TEST_ASSERT_FALSE(passes(1.0e-6F, 0.0264F, 0.1425F * side));
        TEST_ASSERT_FALSE(passes(1.0e-6F, 0.0214F, 0.0800F * side)); /* 19.1 mm: smooth */
        TEST_ASSERT_TRUE(passes(1.0e-6F, 0.0216F, 0.0900F * side));  /* 19.3 mm: rough */
    }
}

/* Both 0.2 m off, as the one before, but for apart_m. */
static height_outcome_t second(float apart_m, uint16_t rejected)
{
    setUp();
    filter->estimate.terrain_mps = 0.2F;
    filter->estimate.speed_mps = 3.0F;
    for (uint16_t i = rejected; i > 0U; i--) {
        TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see((i == 2U) ? 0.9F : 0.7F));
    }
    return see(0.7F + apart_m);
}

void test_two_rejected_heights_within_53_mm_are_a_step_of_the_terrain(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, second(0.0495F, 1U));
    TEST_ASSERT_TRUE(e.confirmed);
    NEAR(-0.2495F, e.terrain_height_m);
    NEAR(0.7495F, filter->estimate.height_m);
    NEAR(0.0F, filter->estimate.terrain_mps);
    NEAR(3.0F, filter->estimate.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, R_M2, filter->covariance[FILTER_HEIGHT][FILTER_HEIGHT]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_HEIGHT][FILTER_SPEED]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_HEIGHT][FILTER_BIAS]);
    NEAR(0.0025F, filter->covariance[FILTER_TERRAIN][FILTER_TERRAIN]);
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(1.2F)); /* the first one again */
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, second(-0.0525F, 1U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, second(0.0535F, 1U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, second(-0.0535F, 1U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, second(0.0F, 0U)); /* the first agrees with none */
}

void test_a_rejected_height_changes_no_state(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.8F));
    NEAR(0.3F, e.innovation_m);
    NEAR(0.5F, filter->estimate.height_m);
    NEAR(0.0F, e.terrain_height_m);
    TEST_ASSERT_FALSE(e.confirmed);
}

void test_the_third_rejected_height_starts_the_filter_anew(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_RESET, second(0.1F, 2U));
    NEAR(0.8F, filter->estimate.height_m);
    NEAR(sqrtf(16.0F / 3.0F), filter->estimate.speed_mps); /* and no more */
    NEAR(16.0F / 3.0F, filter->covariance[FILTER_SPEED][FILTER_SPEED]);
    NEAR(0.09F, filter->covariance[FILTER_BIAS][FILTER_BIAS]);
    TEST_ASSERT_EQUAL_UINT16(2U, e.unchecked_count);
    TEST_ASSERT_FALSE(e.confirmed);
    for (uint16_t left = 2U; left > 0U; left--) {
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.2F + 0.5F * (float)left));
        TEST_ASSERT_EQUAL_UINT16(left - 1U, e.unchecked_count);
        TEST_ASSERT_FALSE(e.confirmed);
    }
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(3.0F));
}

void test_the_first_height_is_the_start(void)
{
    static const float start[N] = {R_M2, 0.04F, 0.09F, 0.0025F};
    e.initialised = false;
    filter->estimate.speed_mps = 2.0F;
    filter->covariance[FILTER_SPEED][FILTER_BIAS] = 0.01F;
    filter->covariance[FILTER_SPEED][FILTER_SPEED] = 0.9F;
    TEST_ASSERT_EQUAL(HEIGHT_RESET, see(0.9F));
    TEST_ASSERT_TRUE(e.initialised);
    NEAR(0.9F, e.now.height_m);
    NEAR(0.0F, e.now.speed_mps);
    TEST_ASSERT_EQUAL_UINT16(2U, e.unchecked_count);
    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = i; j < N; j++) {
            TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, (i == j) ? start[i] : 0.0F, filter->covariance[i][j]);
        }
    }
}

void test_rest_corrects_speed_and_slope_by_20_mm_a_second(void)
{
    const altitude_t altitude = {.valid = true, .slant_mm = 500.0F};
    memset(filter->covariance, 0, sizeof filter->covariance);
    filter->covariance[FILTER_SPEED][FILTER_SPEED] = filter->covariance[FILTER_TERRAIN][FILTER_TERRAIN] =
        0.0004F;
    filter->estimate.speed_mps = 0.1F;
    filter->estimate.terrain_mps = -0.06F;
    (void)estimator_fuse_height(&e, &altitude, e.delayed_us, true);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.05F, e.now.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.03F, e.now.terrain_mps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.0002F, filter->covariance[FILTER_SPEED][FILTER_SPEED]);
}

/* A median shows 50 ms before, a frame stands for 12.5 ms to either side: rays at T are shown by the frame
 * nearest to T + 50 ms. */
void test_the_tilt_of_a_height_is_that_of_the_nearest_frame(void)
{
    for (uint32_t late = 0U; late < 2U; late++) {
        setUp();
        e.initialised = false;
        for (uint16_t i = 0U; i < 5U; i++) {
            e.frames[i] = (estimator_frame_t){.time_us = T_US + UINT32_C(25000) * (i + 1U),
                                              .roll_rad = 0.1F * (float)i,
                                              .pitch_rad = -0.1F * (float)i};
        }
        e.frame_count = 5U;
        e.latest = e.frames[4];
        const altitude_t altitude = {.valid = true, .slant_mm = 1000.0F, .arm_mm = 200.0F};
        (void)estimator_fuse_height(&e, &altitude, T_US + 12490U + 20U * late,
                                    false); /* shown at T + 50 ms, and later */
        const float roll_rad = 0.1F * (float)(1U + late);
        NEAR(cosf(roll_rad) * cosf(roll_rad) - 0.2F * sinf(roll_rad), filter->estimate.height_m);
        TEST_ASSERT_EQUAL_UINT32(T_US + 12490U + 20U * late, e.delayed_us);
        TEST_ASSERT_EQUAL_UINT32(e.delayed_us, e.rays_us);
        TEST_ASSERT_EQUAL_UINT16(5U, e.frame_count);
        TEST_ASSERT_EQUAL_UINT32(T_US + 125000U, e.now_us);
    }
}

void test_before_the_first_frame_a_height_is_refused(void)
{
    e.has_frames = false;
    const estimator_t before = e;
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.5F));
    TEST_ASSERT_EQUAL_MEMORY(&before, &e, sizeof e);
}

/* ---- from outside */

void test_an_amended_estimate_is_the_given_one(void)
{
    filter->estimate = (estimate_t){
        .height_m = 0.4F, .speed_mps = 0.1F, .bias_mps2 = 0.3F, .terrain_mps = 0.2F};
    e.frames[0] = (estimator_frame_t){.time_us = T_US + 100000U, .motion.up_mps2 = 1.0F};
    e.frames[1] = (estimator_frame_t){.time_us = T_US + 300000U,
                                      .motion.up_mps2 = 5.0F}; /* used up long ago */
    e.frame_count = 1U;
    e.now = (estimate_t){.height_m = 0.415F, .speed_mps = 0.2F, .bias_mps2 = 0.3F};
    filter->covariance[FILTER_SPEED][FILTER_BIAS] = 0.01F;
    filter->covariance[FILTER_SPEED][FILTER_SPEED] = 0.9F;
    estimator_amend(&e, 0.7F, 0.6F, -0.2F);
    NEAR(0.4F + 0.7F - 0.415F, filter->estimate.height_m);
    NEAR(0.5F, filter->estimate.speed_mps);
    NEAR(-0.2F, filter->estimate.bias_mps2);
    NEAR(0.0F, filter->estimate.terrain_mps);
    NEAR(0.6F, e.now.speed_mps);
    NEAR(filter->estimate.height_m + 0.05F + 0.005F, e.now.height_m);
    TEST_ASSERT_EQUAL_UINT32(T_US + 100000U, e.now_us);
    NEAR(0.04F, filter->covariance[FILTER_SPEED][FILTER_SPEED]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_SPEED][FILTER_BIAS]);
    estimator_amend(&e, 0.7F, 6.0F, 3.0F);
    NEAR(4.0F, filter->estimate.speed_mps);
    NEAR(1.5F, filter->estimate.bias_mps2);
}

void test_moved_ground_takes_the_vehicle_with_it(void)
{
    filter->estimate = (estimate_t){
        .height_m = 0.4F, .speed_mps = 0.1F, .bias_mps2 = 0.3F, .terrain_mps = 0.2F};
    estimator_move_ground(&e, 0.5F, -0.1F);
    NEAR(0.4F, filter->estimate.height_m);
    NEAR(0.6F, filter->estimate.speed_mps);
    NEAR(0.7F, filter->estimate.terrain_mps);
    NEAR(-0.1F, filter->estimate.bias_mps2);
    NEAR(0.6F, e.now.speed_mps);
}

void test_a_moved_bias_moves_at_both_instants(void)
{
    filter->estimate.bias_mps2 = 0.1F;
    e.now.bias_mps2 = 0.2F;
    estimator_move_bias(&e, 0.05F);
    NEAR(0.15F, filter->estimate.bias_mps2);
    NEAR(0.25F, e.now.bias_mps2);
}

void test_a_forgotten_frame_leaves_the_speed_to_the_heights(void)
{
    predict(2.0F);
    filter->covariance[FILTER_BIAS][FILTER_BIAS] = 0.03F;
    filter->covariance[FILTER_SPEED][FILTER_BIAS] = filter->covariance[FILTER_HEIGHT][FILTER_BIAS] = 0.001F;
    estimator_forget_frame(&e);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.latest.motion.up_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.latest.motion.share);
    NEAR((0.53F * 0.53F + 3.96F * 3.96F) * 0.025F, e.latest.motion.drift);
    NEAR(0.03F, filter->covariance[FILTER_BIAS][FILTER_BIAS]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_SPEED][FILTER_BIAS]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_HEIGHT][FILTER_BIAS]);
    TEST_ASSERT_EQUAL_UINT16(2U, e.unchecked_count);
}

void test_a_started_estimate_is_the_given_one_and_keeps_what_is_known_of_the_bias(void)
{
    e.initialised = false;
    filter->covariance[FILTER_BIAS][FILTER_BIAS] = 0.03F;
    filter->covariance[FILTER_SPEED][FILTER_BIAS] = 0.001F;
    estimator_start(&e, 0.8F, 0.3F, 0.2F);
    TEST_ASSERT_TRUE(e.initialised);
    NEAR(0.8F, e.now.height_m);
    NEAR(0.3F, e.now.speed_mps);
    NEAR(0.2F, e.now.bias_mps2);
    NEAR(0.03F, filter->covariance[FILTER_BIAS][FILTER_BIAS]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter->covariance[FILTER_SPEED][FILTER_BIAS]);
    NEAR(0.04F, filter->covariance[FILTER_SPEED][FILTER_SPEED]);
    TEST_ASSERT_EQUAL_UINT16(2U, e.unchecked_count);
}

void test_a_start_forgets_the_rejected_heights_of_before(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, second(0.1F, 1U));
    estimator_start(&e, 0.5F, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.9F));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5F));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.9F)); /* the first, not the third */
}
