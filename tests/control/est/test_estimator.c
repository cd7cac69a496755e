#include "control/est/estimator.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define SEED 31415U
#define GRAVITY 9.80665

static estimator_t e;
static uint32_t bits;
static uint32_t time_us; /* of the world; frames show it 23.6 ms later, heights 70.5 ms later */
static uint32_t sequence;
static double height_m, speed_mps, acceleration, bias, noise_rms;
static double past_m[400];
static uint32_t steps;

static double uniform(void)
{
    bits = bits * 1664525U + 1013904223U;
    return (double)(bits >> 8) / 16777216.0;
}

static double gauss(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += uniform();
    }
    return sum;
}

static uint16_t ground; /* its number, 0: not known */

void setUp(void)
{
    estimator_init(&e);
    bits = SEED;
    time_us = 0xFFF00000U; /* wraps after a second */
    sequence = 0U;
    steps = 0U;
    height_m = 0.5;
    speed_mps = acceleration = noise_rms = 0.0;
    bias = 0.15;
    ground = 0U;
}

void tearDown(void) {}

static altitude_t altitude(double metres)
{
    return (altitude_t){.valid = true,
                        .ground = ground,
                        .height_mm = (float)(metres * 1000.0),
                        .slant_mm = (float)(metres * 1000.0)};
}

static imu_sample_t frame(void)
{
    return (imu_sample_t){
        .sequence = ++sequence,
        .arrival_us = time_us + 23600U,
        .ready = true,
        .has_acceleration = true,
        .down_mps2 = (float)(GRAVITY + acceleration + bias + noise_rms * gauss()),
    };
}

static const modelled_motion_t no_model;

/* 5 ms of the world; frames every 25 ms. */
static void move(void)
{
    height_m += speed_mps * 0.005 + 0.5 * acceleration * 0.000025;
    speed_mps += acceleration * 0.005;
    time_us += 5000U;
    past_m[++steps % 400U] = height_m;
    if (steps % 5U == 0U) {
        const imu_sample_t f = frame();
        estimator_predict(&e, &f, no_model);
    }
}

static double seen_m(uint32_t steps_ago)
{
    return past_m[(steps - steps_ago) % 400U];
}

/* Seconds of flight along a gentle sine; heights every 100 ms, 15 steps old when they come. */
static void fly(double seconds, double sigma_m)
{
    for (int i = (int)(seconds * 200.0); i > 0; i--) {
        acceleration = 0.8 * cos(1.7 * steps * 0.005);
        move();
        if (steps % 20U == 17U && steps > 40U) {
            const altitude_t a = altitude(seen_m(15U) + sigma_m * gauss());
            (void)estimator_fuse_height(&e, &a, time_us - 75000U, false);
        }
    }
}

static void assert_sound(void)
{
    const float *x = &e.filter.estimate.height_m;
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(isfinite(x[i]));
        TEST_ASSERT_TRUE(e.filter.covariance[i][i] > 0.0F &&
                         e.filter.covariance[i][i] <= 1.0001F * filter_variance_most((filter_state_t)i));
        for (int j = i; j < 4; j++) {
            TEST_ASSERT_TRUE(isfinite(e.filter.covariance[i][j]));
            TEST_ASSERT_TRUE(e.filter.covariance[i][j] * e.filter.covariance[i][j] <=
                             1.01F * e.filter.covariance[i][i] * e.filter.covariance[j][j] + 1e-12F);
        }
    }
}

void test_height_speed_and_bias_are_found(void)
{
    fly(10.0, 0.003);
    TEST_ASSERT_TRUE(e.initialised);
    TEST_ASSERT_FLOAT_WITHIN(0.012F, (float)past_m[(steps - steps % 5U) % 400U], e.now.height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.08F, (float)speed_mps, e.now.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 0.15F, e.now.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, e.now.terrain_mps);
    assert_sound();
}

/* A climb at 1 m/s: taken for fresh, a height of 75 ms ago would be 75 mm wrong. */
void test_an_old_height_is_fused_where_it_belongs(void)
{
    bias = 0.0;
    speed_mps = 1.0;
    height_m = 0.2;
    for (int i = 0; i < 600; i++) {
        move();
        if (steps % 20U == 17U && steps > 40U) {
            const altitude_t a = altitude(seen_m(15U));
            (void)estimator_fuse_height(&e, &a, time_us - 75000U, false);
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, (float)height_m, e.now.height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 1.0F, e.now.speed_mps);
}

void test_no_height_no_estimate(void)
{
    for (int i = 0; i < 100; i++) {
        move();
    }
    TEST_ASSERT_FALSE(e.initialised);
    const altitude_t a = altitude(0.4);
    TEST_ASSERT_EQUAL(HEIGHT_RESET, estimator_fuse_height(&e, &a, time_us - 75000U, false));
    TEST_ASSERT_TRUE(e.initialised);
}

void test_no_frame_no_estimate(void)
{
    const altitude_t a = altitude(0.4);
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, estimator_fuse_height(&e, &a, time_us, false));
    TEST_ASSERT_FALSE(e.initialised);
}

void test_a_frame_seen_twice_or_out_of_order_counts_once(void)
{
    fly(3.0, 0.003);
    const estimator_t before = e;
    imu_sample_t f = frame();
    f.sequence = sequence - 1U;
    estimator_predict(&e, &f, no_model);
    f.sequence = sequence - 7U;
    estimator_predict(&e, &f, no_model);
    TEST_ASSERT_EQUAL_MEMORY(&before, &e, sizeof e);
}

void test_a_useless_frame_changes_nothing(void)
{
    static const float wrong[] = {NAN, INFINITY, 1e9F};
    fly(3.0, 0.003);
    const estimator_t before = e;
    for (unsigned i = 0; i < 4; i++) {
        imu_sample_t f = frame();
        f.has_acceleration = i != 3U;
        f.down_mps2 = i < 3U ? wrong[i] : 9.8F;
        estimator_predict(&e, &f, no_model);
        f = frame();
        f.median.roll_rad = i < 3U ? wrong[i] : 0.0F;
        f.has_acceleration = i != 3U;
        estimator_predict(&e, &f, no_model);
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &e, sizeof e);
}

void test_gravity_is_taken_out_of_a_tilted_frame(void)
{
    imu_sample_t f = frame();
    const float roll = 0.3F, pitch = -0.2F, felt = 9.80665F + 1.5F;
    f.forward_mps2 = -felt * sinf(pitch);
    f.right_mps2 = felt * cosf(pitch) * sinf(roll);
    f.down_mps2 = felt * cosf(pitch) * cosf(roll);
    f.median.roll_rad = roll;
    f.median.pitch_rad = pitch;
    estimator_predict(&e, &f, no_model);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 1.5F, e.up_mps2);
}

void test_the_tilt_at_the_rays_corrects_the_height(void)
{
    altitude_t a = {
        .valid = true, .slant_mm = 805.0F, .distance_mm = 105.0F, .leg_mm = 100.0F, .arm_mm = 220.0F};
    for (int i = 0; i < 20; i++) {
        imu_sample_t f = frame();
        time_us += 25000U;
        f.median.roll_rad = i < 15
                                ? 0.0F
                                : 0.1F; /* medians show 50 ms before: rolled since 75 ms ago at the newest */
        estimator_predict(&e, &f, no_model);
    }
    (void)estimator_fuse_height(&e, &a, time_us - 300000U, false);
    TEST_ASSERT_FLOAT_WITHIN(0.0005F, 0.6F, e.filter.estimate.height_m);
    (void)estimator_fuse_height(&e, &a, time_us - 50000U, false);
    TEST_ASSERT_FLOAT_WITHIN(0.0005F, 0.7F * cosf(0.1F) - 0.22F * sinf(0.1F) - 0.1F,
                             e.filter.estimate.height_m + 0.0F * e.innovation_m + 0.0F);
}

void test_the_accelerometers_noise_is_measured(void)
{
    static const double rms[] = {0.1, 0.4, 1.6};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        noise_rms = rms[i];
        fly(12.0, 0.003);
        TEST_ASSERT_FLOAT_WITHIN(0.3F * (float)rms[i], (float)rms[i], e.credit.noise_mps2);
    }
}

void test_noise_gives_the_expectation_its_share(void)
{
    const modelled_motion_t expected = {true, 0.0F, 0.84F, 0.0F};
    for (int i = 0; i < 300; i++) {
        imu_sample_t f = frame();
        time_us += 25000U;
        estimator_predict(&e, &f, expected);
    }
    TEST_ASSERT_TRUE(e.latest.motion.share > 0.95F);
    noise_rms = 1.6;
    for (int i = 0; i < 300; i++) {
        imu_sample_t f = frame();
        time_us += 25000U;
        estimator_predict(&e, &f, expected);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.84F * 0.84F / (0.84F * 0.84F + 1.6F * 1.6F), e.latest.motion.share);
}

void test_rest_tells_the_bias(void)
{
    for (int i = 0; i < 2000; i++) {
        move();
        if (steps % 20U == 17U && steps > 40U) {
            const altitude_t a = altitude(0.0);
            (void)estimator_fuse_height(&e, &a, time_us - 75000U, true);
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.15F, e.now.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.0F, e.now.speed_mps);
}

/* ---- heights that do not fit */

static height_outcome_t see(double metres)
{
    for (int i = 0; i < 20; i++) {
        acceleration = 0.0;
        speed_mps = 0.0;
        move();
    }
    const altitude_t a = altitude(metres);
    return estimator_fuse_height(&e, &a, time_us - 75000U, false);
}

static void hover(void)
{
    for (int i = 0; i < 60; i++) {
        (void)see(0.5);
    }
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5));
}

void test_one_glitch_is_not_fused(void)
{
    hover();
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.85));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.5F, e.now.height_m);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.15));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5));
}

/* By the number of the ground, which the belief gives. */
void test_over_the_same_ground_a_height_that_is_far_off_is_a_motion_and_no_step(void)
{
    ground = 7U;
    hover();
    const float terrain_m = e.terrain_height_m;

    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.85));
    TEST_ASSERT_TRUE(e.confirmed);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.85F, e.filter.estimate.height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, terrain_m, e.terrain_height_m);
    ground = 8U;
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.3));
    ground = 7U;
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.3)); /* the latest that was used lay over this one */
}

void test_two_that_agree_are_a_step_of_the_terrain(void)
{
    hover();
    const float terrain_m = e.terrain_height_m;
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.75));
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, see(0.76));
    TEST_ASSERT_FLOAT_WITHIN(0.015F, 0.76F, e.now.height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, e.now.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, terrain_m - 0.26F, e.terrain_height_m);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.75));
}

/* Four heights 0.4 m too far, and again: the second time nothing follows them. */
static void run_of_outliers(int heights, height_outcome_t second)
{
    for (int i = 0; i < heights; i++) {
        const height_outcome_t outcome = see(0.9);

        if (i == 1) {
            TEST_ASSERT_EQUAL(second, outcome);
        }
    }
}

static void six_right_ones(void)
{
    for (int i = 0; i < 6; i++) {
        (void)see(0.5);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.5F, e.now.height_m);
}

void test_outliers_that_came_back_are_not_followed_again(void)
{
    hover();
    run_of_outliers(4, HEIGHT_TERRAIN_STEP);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.9F, e.now.height_m);
    six_right_ones();
    for (int run = 0; run < 5; run++) {
        run_of_outliers(4, HEIGHT_REJECTED);
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.5F, e.now.height_m);
        six_right_ones();
    }
}

/* An edge after a dip is an edge, three heights late; and what rises is followed as ever. */
void test_after_a_dip_ground_that_stays_is_believed(void)
{
    hover();
    run_of_outliers(4, HEIGHT_TERRAIN_STEP);
    six_right_ones();
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.2));
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, see(0.2));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.9));
    }
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, see(0.9));
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.9F, e.now.height_m);
}

void test_the_third_in_a_row_starts_anew_whatever_it_says(void)
{
    hover();
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.9));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.1));
    TEST_ASSERT_EQUAL(HEIGHT_RESET, see(1.4));
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 1.4F, e.filter.estimate.height_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.filter.estimate.terrain_mps);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.5));
    for (int i = 0; i < 12; i++) {
        (void)see(0.5);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.5F, e.now.height_m);
}

/* The bound is at least 53 mm, and no more than 80 mm after any silence. */
void test_the_bound_is_never_more_than_80_mm(void)
{
    for (int silence = 0; silence < 40; silence += 4) {
        setUp();
        hover();
        for (int i = 0; i < 20 * silence; i++) {
            acceleration = speed_mps = 0.0;
            move();
        }
        const float before_m = e.now.height_m;
        TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see((double)before_m + 0.5 + 0.2 * silence));
    }
    setUp();
    hover();
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.545));
}

/* The fly-away of a bound without a way out: a wrong speed, and every height refused for ever. */
void test_from_any_wrong_state_it_recovers_within_two_seconds(void)
{
    for (int i = 0; i < 500; i++) {
        setUp();
        bits = SEED + (uint32_t)i;
        hover();
        e.filter.estimate.height_m += (float)(4.0 * uniform() - 2.0);
        e.filter.estimate.speed_mps = (float)(8.0 * uniform() - 4.0);
        e.filter.estimate.bias_mps2 = (float)(3.0 * uniform() - 1.5);
        e.filter.estimate.terrain_mps = (float)(uniform() - 0.5);
        for (int k = 0; k < 20; k++) {
            (void)see(0.5);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.5F, e.now.height_m);
        for (int k = 0; k < 20; k++) {
            (void)see(0.5);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.5F, e.now.height_m);
        TEST_ASSERT_FLOAT_WITHIN(0.25F, 0.0F, e.now.speed_mps);
    }
}

void test_after_any_rubbish_it_recovers_within_two_seconds(void)
{
    for (int i = 0; i < 200; i++) {
        setUp();
        bits = SEED * 3U + (uint32_t)i;
        hover();
        for (int k = 0; k < 30; k++) {
            (void)see(4.0 * uniform());
            assert_sound();
        }
        for (int k = 0; k < 40; k++) {
            (void)see(0.5);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.5F, e.now.height_m);
    }
}

/* ---- numbers */

void test_the_covariance_stays_positive_through_anything(void)
{
    char seed[32];
    snprintf(seed, sizeof seed, "seed %u", SEED);
    TEST_MESSAGE(seed);
    for (int32_t i = 0; i < 60000; i++) {
        noise_rms = (i / 5000) % 2 == 0 ? 0.4 : 4.0;
        acceleration = 30.0 * (uniform() - 0.5);
        speed_mps = 0.0;
        height_m = 2.0 + 2.0 * uniform();
        move();
        if (uniform() < 0.04 && (i / 3000) % 4 != 3) {
            const altitude_t a = altitude(uniform() < 0.8 ? height_m : 4.0 * uniform());
            (void)estimator_fuse_height(&e, &a, time_us - (uint32_t)(uniform() * 400000.0), uniform() < 0.1);
        }
        time_us += uniform() < 0.001 ? (uint32_t)(uniform() * 2e6) : 0U;
        assert_sound();
        TEST_ASSERT_TRUE(fabsf(e.now.speed_mps) <= 4.0F && fabsf(e.now.terrain_mps) <= 4.0F);
    }
}

void test_a_million_quiet_steps_do_not_wear_the_covariance_down(void)
{
    bias = 0.0;
    noise_rms = 0.01;
    for (int32_t i = 0; i < 50000; i++) {
        (void)see(0.5);
    }
    assert_sound();
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.52));
    TEST_ASSERT_TRUE(e.filter.estimate.height_m > 0.503F);
}

void test_after_a_gap_of_the_frames_it_starts_anew(void)
{
    hover();
    time_us += 400000U;
    imu_sample_t f = frame();
    estimator_predict(&e, &f, no_model);
    TEST_ASSERT_FALSE(e.initialised);
    const altitude_t a = altitude(0.7);
    TEST_ASSERT_EQUAL(HEIGHT_RESET, estimator_fuse_height(&e, &a, time_us - 75000U, false));
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.7F, e.now.height_m);
}

void test_after_a_gap_it_can_be_told_where_and_how_fast_the_vehicle_is(void)
{
    hover();
    time_us += 400000U;
    const imu_sample_t f = frame();
    estimator_predict(&e, &f, no_model);
    TEST_ASSERT_FALSE(e.initialised);
    estimator_start(&e, 0.8F, -0.6F, 0.1F);
    TEST_ASSERT_TRUE(e.initialised);
    TEST_ASSERT_EQUAL_FLOAT(0.8F, e.now.height_m);
    TEST_ASSERT_EQUAL_FLOAT(-0.6F, e.now.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, e.now.bias_mps2);
    const altitude_t a = altitude(0.4); /* far off, and fused all the same */
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, estimator_fuse_height(&e, &a, e.now_us, false));
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.4F, e.now.height_m);
}

/* Kalman's equations: gain P[i][0] / (P[0][0] + R), and P[i][j] less gain times P[0][j]. R is told by the
 * gain. */
void test_a_height_corrects_states_and_covariance_by_one_gain(void)
{
    fly(8.0, 0.005);
    const estimator_t before = e;
    const float(*const p)[FILTER_STATES] = before.filter.covariance;
    const altitude_t a = altitude((double)e.filter.estimate.height_m + 0.01);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, estimator_fuse_height(&e, &a, e.delayed_us, false));
    const float per_m = (e.filter.estimate.height_m - before.filter.estimate.height_m) / 0.01F / p[0][0];
    TEST_ASSERT_TRUE(per_m > 0.0F && per_m * p[0][0] < 0.9F);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.01F * per_m * p[0][1],
                             e.filter.estimate.speed_mps - before.filter.estimate.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.01F * per_m * p[0][2],
                             e.filter.estimate.bias_mps2 - before.filter.estimate.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.01F * per_m * p[0][3],
                             e.filter.estimate.terrain_mps - before.filter.estimate.terrain_mps);
    for (uint16_t i = 0U; i < FILTER_STATES; i++) {
        for (uint16_t j = i; j < FILTER_STATES; j++) {
            const float less = per_m * p[0][i] * p[0][j];
            TEST_ASSERT_FLOAT_WITHIN(1e-8F + 0.02F * fabsf(less), p[i][j] - less, e.filter.covariance[i][j]);
        }
    }
}

/* Nothing of before the gap may move the new state, nor look like noise of the accelerometer. */
void test_after_a_gap_nothing_of_before_is_left(void)
{
    hover();
    noise_rms = 0.0;
    const float noise_mps2 = e.credit.noise_mps2;
    time_us += 400000U;
    bias = 3.0;
    const imu_sample_t f = frame();
    estimator_predict(&e, &f, no_model);
    TEST_ASSERT_EQUAL_UINT16(0U, e.frame_count);
    TEST_ASSERT_EQUAL_UINT32(f.arrival_us - 23600U, e.now_us);
    TEST_ASSERT_EQUAL_UINT32(e.now_us, e.delayed_us);
    TEST_ASSERT_TRUE(e.credit.noise_mps2 <= noise_mps2);
    const imu_sample_t next = frame();
    estimator_predict(&e, &next, no_model);
    TEST_ASSERT_TRUE_MESSAGE(e.credit.noise_mps2 <= noise_mps2, "two equal frames show no noise");
}

void test_an_edge_that_comes_and_goes_is_a_bar_at_once(void)
{
    hover();
    (void)see(0.56);
    (void)see(0.56);
    TEST_ASSERT_TRUE_MESSAGE(e.roughness.noise_m < 0.02F, "an edge");
    (void)see(0.50);
    TEST_ASSERT_FLOAT_WITHIN(0.006F, 0.03F, e.roughness.noise_m);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(i % 2 == 0 ? 0.56 : 0.50));
        TEST_ASSERT_FLOAT_WITHIN(0.12F, 0.0F, e.now.speed_mps);
    }
}

/* Bars of 60 mm, every other scan over one: no steps of the terrain, but a rough floor, and the way is
 * between. */
void test_bars_on_the_floor_are_noise_and_a_single_edge_is_not(void)
{
    hover();
    TEST_ASSERT_TRUE(e.roughness.noise_m < 0.006F);
    (void)see(0.5 + 0.25);
    (void)see(0.5 + 0.25);
    TEST_ASSERT_TRUE(e.roughness.noise_m < 0.02F);
    for (int i = 0; i < 60; i++) {
        (void)see(0.75 + (i % 2 == 0 ? 0.06 : 0.0));
    }
    TEST_ASSERT_TRUE(e.roughness.noise_m > 0.04F && e.roughness.noise_m < 0.08F);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.75 + (i % 2 == 0 ? 0.06 : 0.0)));
        TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.78F, e.now.height_m);
    }
}

/* ---- terrain that is passed over */

/* One scan of three mirrors, whose grounds lie so high. */
static void see_over(const float *ground_m)
{
    altitude_t mirrors[MIRROR_COUNT];

    for (int m = 0; m < (int)MIRROR_COUNT; m++) {
        mirrors[m] = altitude(height_m - (double)ground_m[m]);
        mirrors[m].valid = true;
    }
    for (int i = 0; i < 4; i++) {
        time_us += 25000U;
        const imu_sample_t f = frame();
        estimator_predict(&e, &f, (modelled_motion_t){.known = false});
    }
    const terrain_sight_t sight = {&mirrors[0], mirrors, 0U, 0U};
    TEST_ASSERT_TRUE(terrain_sees_ground(&sight, e.passes_over));
    (void)estimator_fuse_over(&e, &sight, time_us - 75000U);
}

void test_ground_that_is_passed_over_moves_the_height_and_not_the_altitude(void)
{
    hover();
    const float before_m = e.now.height_m + e.terrain_height_m;

    estimator_pass_over(&e, true);
    for (int k = 0; k < 30; k++) {
        const float way_m = 0.04F * (float)(k - 10); /* an edge of 0.2 m, mirror by mirror */
        see_over((const float[]){way_m > 0.0F ? 0.2F : 0.0F, way_m > -0.1F ? 0.2F : 0.0F,
                                 way_m > 0.1F ? 0.2F : 0.0F});
    }
    TEST_ASSERT_FLOAT_WITHIN(0.02F, before_m, e.now.height_m + e.terrain_height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, before_m - 0.2F, e.now.height_m);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, e.now.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, e.now.terrain_mps);
}
