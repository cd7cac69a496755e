/* A Kalman filter with a delayed time horizon, as in PX4's EKF2. A height is 70 ms old when it arrives. So
 * the filter stays at the instant of the latest rays, and keeps the IMU frames since then. A height is fused
 * at its own instant; then the frames predict the state up to now.
 * What breaks: after a reset the speed may be anything, and until two heights have told it nothing is
 * learned. "fitted": docs/control.md; make tune LAW=EST ARGS="--constants est" searches it again. */
#include "control/est/estimator.h"

#include <math.h>
#include <string.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/est/cascade.h"
#include "control/seconds.h"

#define FRAME_AGE_US UINT32_C(23600) /* 15 ms within the Razor (assumed), 8.6 ms on the wire */
#define TILT_AGE_US UINT32_C(50000)  /* the median of five frames is two frames of 25 ms old */
#define NO_RAYS_US UINT32_C(75000)   /* after other rays: a scan of 0.1 s, less a margin of a frame */
#define ANGLE_MAX_RAD 3.2F           /* pi, rounded up */

#define HEIGHT_NOISE_M 0.0013F   /* fitted */
#define SPEED_NOISE_MPS2 0.53F   /* fitted; what neither accelerometer nor model knows */
#define FRAME_S 0.025F           /* period of the IMU, seed 5.2.1.1 */
#define BIAS_DRIFT_MPS2 0.095F   /* fitted; m/s2 per root second */
#define TERRAIN_DRIFT_MPS 0.053F /* fitted; m/s per root second */
#define OVER_DRIFT_MPS2 0.02F    /* chosen: of the bias, while ramps are told from it; warmth is slower */
#define LEAN_MOST 1.0F           /* 45 degrees: beyond, tilt.c cuts the thrust */
#define NO_ACC_DRIFT_MPS2 0.4F   /* turbulence of 0.2 m/s2 for 0.5 s (quadrotor.c): 0.2 sqrt(2 / 0.5) */
#define UNCHECKED_AFTER_RESET 2U /* two heights give the speed again */

static bool before(uint32_t a_us, uint32_t b_us)
{
    return (int32_t)(a_us - b_us) < 0;
}

void estimator_init(estimator_t *estimator)
{
    memset(estimator, 0, sizeof *estimator); /* as in flight.c */
    estimator->upright = 1.0F;
    filter_reset_covariance(&estimator->filter);
    credit_init(&estimator->credit);
    roughness_init(&estimator->roughness);
}

static void predict_to(estimator_t *e, uint32_t to_us, const estimator_frame_t *frame)
{
    const float dt_s = seconds_between(e->delayed_us, to_us);

    e->terrain_height_m += e->filter.estimate.terrain_mps * dt_s;
    const float bias_mps2 = e->passes_over ? OVER_DRIFT_MPS2 : BIAS_DRIFT_MPS2;
    const filter_drift_t drift = {
        .bias_mps2 = e->felt ? bias_mps2 : NO_ACC_DRIFT_MPS2,
        .terrain_mps = e->passes_over ? 0.0F : TERRAIN_DRIFT_MPS,
    };

    filter_predict(&e->filter, &frame->motion, dt_s, &drift);
    terrain_predict(&e->terrain, &frame->motion, dt_s, bias_mps2);
    e->delayed_us = to_us;
}

static void drop_oldest_frames(estimator_t *e, uint16_t dropped)
{
    e->frame_count = (uint16_t)(e->frame_count - dropped);
    for (uint16_t i = 0U; i < e->frame_count; ++i) {
        e->frames[i] = e->frames[i + dropped];
    }
}

/* Predicts the filter through the kept frames up to an instant. */
static void predict_through(estimator_t *e, uint32_t to_us)
{
    uint16_t passed = 0U;

    while (passed < e->frame_count && !before(to_us, e->frames[passed].time_us)) {
        predict_to(e, e->frames[passed].time_us, &e->frames[passed]);
        ++passed;
    }
    if (passed > 0U) {
        drop_oldest_frames(e, passed);
    }
    if (before(e->delayed_us, to_us)) {
        predict_to(e, to_us, (e->frame_count > 0U) ? &e->frames[0] : &e->latest);
    }
}

static void predict_now(estimator_t *e)
{
    uint32_t time_us = e->delayed_us;

    e->now = e->filter.estimate;
    for (uint16_t i = 0U; i < e->frame_count; ++i) {
        e->now = filter_moved(&e->now, &e->frames[i].motion, seconds_between(time_us, e->frames[i].time_us));
        time_us = e->frames[i].time_us;
    }
    e->now_us = time_us;
}

static void restart_at_frame(estimator_t *e, uint32_t time_us, float up_mps2)
{
    e->has_frames = true;
    e->initialised = false;
    e->frame_count = 0U;
    e->delayed_us = time_us;
    e->rays_us = time_us;
    e->now_us = time_us;
    credit_restart(&e->credit, up_mps2);
}

/* The oldest frame is used up as soon as no rays can be older than it. So the work of a height is spread over
 * the cycles before it. */
static void append_frame(estimator_t *e, const estimator_frame_t *frame)
{
    const bool passed = before(e->frames[0].time_us, e->rays_us + NO_RAYS_US);

    if (e->frame_count == ESTIMATOR_FRAMES || (e->frame_count > 0U && passed)) {
        predict_through(e, e->frames[0].time_us);
    }
    e->frames[e->frame_count] = *frame;
    ++e->frame_count;
    if (before(e->now_us, frame->time_us)) {
        e->now = filter_moved(&e->now, &frame->motion, seconds_between(e->now_us, frame->time_us));
        e->now_us = frame->time_us;
    }
}

static bool has_tilt(const imu_sample_t *frame)
{
    return frame->ready && fabsf(frame->median.roll_rad) < ANGLE_MAX_RAD &&
           fabsf(frame->median.pitch_rad) < ANGLE_MAX_RAD;
}

/* Changes the source of the acceleration. The bias belongs to the source, so it restarts at 0. */
static void change_source(estimator_t *e, bool felt)
{
    e->felt = felt;
    e->filter.estimate.bias_mps2 = 0.0F;
    e->now.bias_mps2 = 0.0F;
    filter_reset_variance(&e->filter, FILTER_BIAS, filter_variance_start(FILTER_BIAS));
}

/* Drift of the speed, (m/s)2 a second, by the noise of an acceleration that lasts for one frame. */
static float drift_of(float measured_mps2, float modelled_mps2)
{
    return (SPEED_NOISE_MPS2 * SPEED_NOISE_MPS2 +
            (measured_mps2 * measured_mps2 + modelled_mps2 * modelled_mps2)) *
           FRAME_S;
}

/* Acceleration for the prediction: a weighted mean of accelerometer and model, or the model alone. */
static motion_t motion_of(estimator_t *e, const modelled_motion_t *model, float up_mps2)
{
    const float modelled_mps2 = model->known ? model->up_mps2 : 0.0F;

    if (!e->felt) {
        return (motion_t){
            .up_mps2 = modelled_mps2, .share = model->known ? 1.0F : 0.0F, .drift = drift_of(0.0F, 0.0F)};
    }
    const float mean_mps2 = e->has_frames ? 0.5F * (up_mps2 + e->up_mps2) : up_mps2;
    const float share = credit_share(&e->credit, model);
    return (motion_t){
        .up_mps2 = share * mean_mps2 + (1.0F - share) * modelled_mps2,
        .share = share,
        .drift = drift_of(share * e->credit.noise_mps2, (1.0F - share) * model->noise_mps2),
    };
}

/* A frame that was not used yet, with a tilt; and with accelerations, or they have been missing for long. */
static bool is_of_use(const estimator_t *e, const imu_sample_t *frame, bool usable)
{
    const uint32_t time_us = frame->arrival_us - FRAME_AGE_US;
    const bool lacks = !usable && e->felt && (uint32_t)(time_us - e->felt_us) <= ESTIMATOR_FRESH_US;

    return has_tilt(frame) && !lacks && (int32_t)(frame->sequence - e->sequence) > 0;
}

static void take_in(estimator_t *e, uint32_t time_us, float up_mps2)
{
    const int32_t gap_us = (int32_t)(time_us - e->now_us);

    if (!e->has_frames || gap_us > (int32_t)FRAME_GAP_US || gap_us < -(int32_t)FRAME_GAP_US) {
        restart_at_frame(e, time_us, up_mps2);
    } else if (before(e->delayed_us, time_us)) {
        append_frame(e, &e->latest);
    }
}

void estimator_predict(estimator_t *e, const imu_sample_t *frame, modelled_motion_t model)
{
    const uint32_t time_us = frame->arrival_us - FRAME_AGE_US;
    const imu_vertical_t told = imu_vertical(frame);
    const float up_mps2 = frame->has_acceleration ? told.up_mps2 : 0.0F;
    const bool usable = frame->has_acceleration && fabsf(up_mps2) < UP_MAX_MPS2;

    if (!is_of_use(e, frame, usable)) {
        return;
    }
    if (usable != e->felt) {
        change_source(e, usable);
    }
    e->felt_us = time_us;
    e->sequence = frame->sequence;
    e->latest = (estimator_frame_t){
        .time_us = time_us,
        .motion = motion_of(e, &model, up_mps2),
        .roll_rad = frame->median.roll_rad,
        .pitch_rad = frame->median.pitch_rad,
    };
    e->upright = told.upright;
    e->up_mps2 = usable ? up_mps2 : 0.0F;
    take_in(e, time_us, up_mps2);
    if (usable) {
        credit_measure_noise(&e->credit, up_mps2);
    }
}

static void reset_height(estimator_t *e, float height_m)
{
    e->filter.estimate.height_m = height_m;
    e->filter.estimate.terrain_mps = 0.0F;
    filter_reset_variance(&e->filter, FILTER_HEIGHT, HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    filter_reset_variance(&e->filter, FILTER_TERRAIN, filter_variance_start(FILTER_TERRAIN));
}

static void initialise_at(estimator_t *e, float height_m)
{
    filter_reset_covariance(&e->filter);
    e->filter.estimate.speed_mps = 0.0F;
    reset_height(e, height_m);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
    e->initialised = true;
}

/* The speed may be anything; one beyond a standard deviation of that does not survive. */
static void reset_to_height(estimator_t *e, float height_m)
{
    const float variance = filter_variance_most(FILTER_SPEED);
    const float most_mps = sqrtf(variance);

    filter_reset_variance(&e->filter, FILTER_SPEED, variance);
    filter_reset_variance(&e->filter, FILTER_BIAS, filter_variance_start(FILTER_BIAS));
    e->filter.estimate.speed_mps = between(-most_mps, e->filter.estimate.speed_mps, most_mps);
    reset_height(e, height_m);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
}

static height_outcome_t judge(estimator_t *e, uint16_t ground)
{
    if (e->unchecked_count > 0U) {
        --e->unchecked_count;
        innovation_untested(&e->test, ground);
        e->confirmed = false;
        return HEIGHT_FUSED;
    }
    const float variance_m2 = e->filter.covariance[FILTER_HEIGHT][FILTER_HEIGHT] +
                              HEIGHT_NOISE_M * HEIGHT_NOISE_M;
    const height_outcome_t outcome = innovation_test(&e->test, e->innovation_m, variance_m2,
                                                     e->roughness.noise_m, ground);

    e->confirmed = outcome != HEIGHT_REJECTED && outcome != HEIGHT_RESET;
    return outcome;
}

static height_outcome_t check_and_fuse(estimator_t *e, float height_m, uint16_t ground)
{
    e->innovation_m = height_m - e->filter.estimate.height_m;
    roughness_step(&e->roughness, height_m, e->innovation_m, e->delayed_us);
    const height_outcome_t outcome = judge(e, ground);

    if (outcome == HEIGHT_TERRAIN_STEP) {
        e->terrain_height_m -= e->innovation_m;
        reset_height(e, height_m);
    } else if (outcome == HEIGHT_RESET) {
        reset_to_height(e, height_m);
    } else if (outcome == HEIGHT_FUSED) {
        filter_correct(&e->filter, FILTER_HEIGHT, e->innovation_m,
                       HEIGHT_NOISE_M * HEIGHT_NOISE_M + roughness_variance_m2(&e->roughness));
    }
    return outcome;
}

/* The frame with the tilt at the instant of the rays. The median of five frames is 50 ms old. */
static const estimator_frame_t *frame_of_rays(const estimator_t *e, uint32_t rays_us)
{
    const uint32_t shown_us = rays_us + TILT_AGE_US - (uint32_t)(0.5e6F * FRAME_S);
    const estimator_frame_t *frame = &e->latest;

    for (uint16_t i = e->frame_count; i > 0U && !before(e->frames[i - 1U].time_us, shown_us); --i) {
        frame = &e->frames[i - 1U];
    }
    return frame;
}

static float height_at_rays_m(const estimator_t *e, const altitude_t *altitude, uint32_t rays_us)
{
    const estimator_frame_t *frame = frame_of_rays(e, rays_us);

    return altitude_at_tilt(altitude, frame->roll_rad, frame->pitch_rad) * 0.001F;
}

height_outcome_t estimator_fuse_height(estimator_t *e, const altitude_t *altitude, uint32_t rays_us,
                                       bool at_rest)
{
    height_outcome_t outcome = HEIGHT_RESET;

    if (!e->has_frames) {
        return HEIGHT_REJECTED;
    }
    const float height_m = height_at_rays_m(e, altitude, rays_us);
    predict_through(e, rays_us);
    e->rays_us = e->delayed_us;
    if (e->initialised) {
        outcome = check_and_fuse(e, height_m, altitude->ground);
    } else {
        initialise_at(e, height_m);
        innovation_untested(&e->test, altitude->ground);
    }
    if (at_rest) {
        filter_stand(&e->filter);
    }
    predict_now(e);
    return outcome;
}

/* The heights of the mirrors at the instant of `altitude`: each has its own. */
terrain_heights_t estimator_heights(const estimator_t *e, const terrain_sight_t *sight, uint32_t rays_us)
{
    const float pitch_rad = frame_of_rays(e, rays_us)->pitch_rad;
    terrain_heights_t heights = {.lean = between(-LEAN_MOST, sinf(pitch_rad) / cosf(pitch_rad), LEAN_MOST),
                                 .reach_m = (sight->altitude->slant_mm - sight->altitude->distance_mm) *
                                            0.001F * sinf(pitch_rad)};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const altitude_t *one = &sight->mirrors[m];
        const int32_t later_us = one->later_us - sight->altitude->later_us;

        heights.fore_m[m] = one->fore_mm * 0.001F;
        if (terrain_is_shown(sight, (mirror_t)m)) {
            heights.valid |= (uint16_t)(1U << m);
            heights.height_m[m] = height_at_rays_m(e, one, rays_us + (uint32_t)later_us) -
                                  e->filter.estimate.speed_mps * 1.0e-6F * (float)later_us;
        }
    }
    return heights;
}

void estimator_pass_over(estimator_t *e, bool passes_over)
{
    if (passes_over == e->passes_over) {
        return;
    }
    e->passes_over = passes_over;
    e->terrain.count = 0U;
    e->ground_mps = 0.0F;
    e->filter.estimate.terrain_mps = 0.0F;
    filter_reset_variance(&e->filter, FILTER_TERRAIN,
                          passes_over ? 0.0F : filter_variance_start(FILTER_TERRAIN));
}

/* The filter goes on from what the scan means. */
static void take_shown(estimator_t *e, const terrain_shown_t *shown)
{
    e->filter.estimate.height_m = shown->altitude_m - shown->ground_m;
    e->filter.estimate.speed_mps = shown->speed_mps;
    e->filter.estimate.bias_mps2 = shown->bias_mps2;
    filter_reset_variance(&e->filter, FILTER_HEIGHT, TERRAIN_OWN_M * TERRAIN_OWN_M);
    filter_reset_variance(&e->filter, FILTER_SPEED, shown->speed_variance);
    filter_reset_variance(&e->filter, FILTER_BIAS, shown->bias_variance);
    filter_bound(&e->filter);
    e->terrain_height_m = shown->ground_m;
}

/* The mean of two scans. A step is no rate. */
static void learn_ground_rate(estimator_t *e, float risen_m, float gap_s)
{
    if (fabsf(risen_m) < TERRAIN_STEP_M) {
        e->ground_mps += (risen_m - e->ground_mps * gap_s) / (2.0F * SCAN_S + gap_s);
    }
}

height_outcome_t estimator_fuse_over(estimator_t *e, const terrain_sight_t *sight, uint32_t rays_us)
{
    const terrain_heights_t heights = estimator_heights(e, sight, rays_us);
    const float gap_s = between(SCAN_LEAST_S, seconds_between(e->rays_us, rays_us), CYCLE_MAX_S);

    predict_through(e, rays_us);
    e->rays_us = e->delayed_us;
    const float height_m = e->filter.estimate.height_m;
    const float altitude_m = height_m + e->terrain_height_m;
    terrain_begin(&e->terrain, &e->filter, &heights, altitude_m, e->terrain_height_m);
    const terrain_shown_t shown = terrain_scan(&e->terrain, &heights, gap_s);
    take_shown(e, &shown);
    learn_ground_rate(e, height_m - e->filter.estimate.height_m, gap_s);
    e->innovation_m = shown.altitude_m - altitude_m;
    e->confirmed = e->unchecked_count == 0U;
    e->unchecked_count = (uint16_t)(e->unchecked_count - (e->unchecked_count > 0U));
    innovation_untested(&e->test, sight->altitude->ground);
    predict_now(e);
    return HEIGHT_FUSED;
}

void estimator_drop_accelerations(estimator_t *e)
{
    if (e->felt) {
        change_source(e, false);
    }
}

void estimator_forget_frame(estimator_t *e)
{
    e->latest.motion = (motion_t){.drift = drift_of(EST_FALL_MPS2, 0.0F)};
    filter_reset_variance(&e->filter, FILTER_BIAS, e->filter.covariance[FILTER_BIAS][FILTER_BIAS]);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
}

void estimator_amend(estimator_t *e, float height_m, float speed_mps, float bias_mps2)
{
    e->filter.estimate.height_m += height_m - e->now.height_m;
    e->filter.estimate.speed_mps += speed_mps - e->now.speed_mps;
    e->filter.estimate.bias_mps2 = bias_mps2;
    e->filter.estimate.terrain_mps = 0.0F;
    e->terrain.count = 0U;
    filter_reset_covariance(&e->filter);
    filter_bound(&e->filter);
    predict_now(e);
}

void estimator_start(estimator_t *e, float height_m, float speed_mps, float bias_mps2)
{
    const float variance = e->filter.covariance[FILTER_BIAS][FILTER_BIAS];

    estimator_amend(e, height_m, speed_mps, bias_mps2);
    filter_reset_variance(&e->filter, FILTER_BIAS, variance);
    e->test.rejected = 0U;
    e->unchecked_count = UNCHECKED_AFTER_RESET;
    e->initialised = true;
}

void estimator_move_ground(estimator_t *e, float by_mps, float bias_mps2)
{
    e->filter.estimate.speed_mps += by_mps;
    e->filter.estimate.terrain_mps += by_mps;
    e->filter.estimate.bias_mps2 = bias_mps2;
    predict_now(e);
}

void estimator_move_bias(estimator_t *e, float by_mps2)
{
    e->filter.estimate.bias_mps2 += by_mps2;
    e->now.bias_mps2 += by_mps2;
}
