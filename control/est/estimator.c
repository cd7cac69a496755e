/* A Kalman filter with a delayed time horizon, as in PX4's EKF2. A height is 70 ms old when it arrives. So
 * the filter stays at the instant of the latest rays, and keeps the IMU frames since then. A height is fused
 * at its own instant; then the frames predict the state up to now. Theory: any text on Kalman filters. The
 * update is Joseph's form, because the short form loses its symmetry in 32-bit floats.
 * What breaks: a covariance that is not symmetric or not bounded lets a state diverge. An innovation test
 * without a reset rejects heights for ever once the state is wrong (in simulation the vehicle flew away to
 * 11 m). So three rejections reset the height. Constants marked "fitted": docs/control.md;
 * make tune LAW=EST ARGS="--constants est" searches them again. */
#include "control/est/estimator.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"

#define FRAME_AGE_US UINT32_C(23600) /* 15 ms within the Razor (assumed), 8.6 ms on the wire */
#define TILT_AGE_US UINT32_C(50000)  /* the median of five frames is two frames of 25 ms old */
#define NO_RAYS_US UINT32_C(75000)   /* after other rays: a scan of 0.1 s, less a margin of a frame */
#define ANGLE_MAX_RAD 3.2F           /* pi, rounded up */

#define HEIGHT_NOISE_M 0.0013F /* fitted */
#define OFF_MODEL_SHARE 0.4F   /* chosen: a mean over three frames */
#define OFF_MODEL_MPS2 2.0F    /* chosen: as ACCUSED_MPS2; full weight below it */
#define ACCUSED_MPS2 2.0F      /* chosen: as OFF_MODEL_MPS2; another airframe is off by 1.5 while it brakes */
#define ACCUSED_SIGMAS 1.5F    /* chosen: of the noise, on a mean of three frames: 3 sigma */
#define ACCUSED_NOISES 3.0F    /* chosen: of the heights' noise; rarer by chance on a mean */
#define ACCUSED_HEIGHTS 8U     /* chosen: an edge is corrected within 0.8 s */
#define ACCUSED_SHARE 0.5F     /* chosen: mean over two heights */
#define ACCUSED_CREDIT 0.02F   /* chosen: next to nothing */
#define CLEARED_FRAMES 32U     /* chosen: 0.8 s, until then doubt IMU has decided */
#define FLOOR_START_M 0.004F   /* chosen: about the noise of a height over a smooth floor */
#define FLOOR_SMOOTH_M 0.020F  /* chosen: edges and the vehicle's own motion measure less */
#define FLOOR_MAX_M 0.080F     /* chosen: as INNOVATION_LIMIT_MAX_M */
#define FLOOR_SHARE 0.20F      /* tried: a slower mean knows bars of 60 mm only after the take-off */
#define FLOOR_CLIP 9.0F        /* chosen: 3 sigma, so that one edge counts little */
#define FLOOR_SIGMAS 6.0F      /* tried: both edges of a bar pass the test, from a wrong speed too */
#define FLOOR_VARIANCE 0.5F    /* tried: more, and the vehicle swings by the thrust model alone */
#define BAR_US UINT32_C(1000000) /* chosen: two edges within that time are a bar, and more will follow */
#define BAR_LEAST_M 0.040F       /* chosen: ten times the noise of a height */
#define BAR_MOST_M 0.15F         /* chosen: higher ones are edges or wrong scans, which are rejected */
#define BAR_SHARE 0.5F           /* rms of a height that is half of the time on the bar */
#define HEIGHT_DRIFT_M 0.0047F   /* fitted; m per root second */
#define SPEED_NOISE_MPS2 0.53F   /* fitted; what neither accelerometer nor model knows */
#define FRAME_S 0.025F           /* period of the IMU, seed 5.2.1.1 */
#define BIAS_DRIFT_MPS2 0.095F   /* fitted; m/s2 per root second */
#define NO_ACC_DRIFT_MPS2 0.4F   /* tried 0.1 to 0.8: more follows gusts better and shakes the thrust more */
#define NO_ACC_NOISE_MPS2 0.4F   /* tried 0.1 to 1.5: hardly matters below 1 */
#define LATE_NOISE_MPS2 3.0F     /* chosen: what law PIDT accelerates by */
#define TERRAIN_DRIFT_MPS 0.053F /* fitted; m/s per root second */
#define TERRAIN_TIME_S 1.0F      /* chosen: a slope lasts about a second */
#define NOISE_START_MPS2 0.4F    /* assumed of a Razor on a flying frame */
#define NOISE_MIN_MPS2 0.05F     /* chosen: a limit to the trust in the accelerometer */
#define NOISE_MAX_MPS2 5.0F      /* chosen: never quite ignored */
#define NOISE_SHARE 0.02F        /* chosen: mean over 50 frames */
#define NOISE_CLIP 16.0F         /* chosen: 4 sigma, so that one spike counts little */

#define INNOVATION_LIMIT_MIN_M 0.053F /* fitted */
#define INNOVATION_LIMIT_MAX_M 0.080F /* tried: with a wider one a half-seen edge made it fly away */
#define INNOVATION_LIMIT_SIGMAS 3.0F  /* usual */
#define STEP_AGREEMENT_M 0.050F       /* chosen: noise of two heights and 0.1 s of climb */
#define REJECTIONS_MAX 3U             /* chosen: the third height is used whatever it is */
#define UNCHECKED_AFTER_RESET 2U      /* chosen: two heights give the speed again */
#define REST_SIGMA_MPS 0.02F          /* chosen: a vehicle on the ground may still shake */

#define SPEED_MAX_MPS 4.0F       /* chosen: above what the vehicle reaches */
#define TERRAIN_MAX_MPS 0.5F     /* chosen: the seed's ramp rises by 0.36 m/s */
#define SPEED_RESET_MAX_MPS 1.0F /* chosen: limit of the speed that survives a reset */

enum { HEIGHT, SPEED, BIAS, TERRAIN };

#define VARIANCE_MIN 1.0e-7F /* of any state; chosen: above the rounding of 32-bit floats */

/* Of height (m2), speed (m2/s2), bias (m2/s4), terrain rate (m2/s2). Chosen. Highest: 1 m, 1 m/s, 0.5 m/s2,
 * 0.5 m/s. At the start: 1 cm, 0.2 m/s, 0.3 m/s2, 0.05 m/s. */
static const float variance_max[ESTIMATOR_STATES] = {1.0F, 1.0F, 0.25F, 0.25F};
static const float variance_start[ESTIMATOR_STATES] = {1.0e-4F, 0.04F, 0.09F, 0.0025F};

static bool before(uint32_t a_us, uint32_t b_us)
{
    return (int32_t)(a_us - b_us) < 0;
}

static inline float *covariance_of(float p[ESTIMATOR_STATES][ESTIMATOR_STATES], uint16_t i, uint16_t j)
{
    return (i < j) ? &p[i][j] : &p[j][i];
}

/* Gives one state a new variance and removes its covariances with the other states. */
static void reset_variance(estimator_t *e, uint16_t state, float variance)
{
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        *covariance_of(e->covariance, state, i) = 0.0F;
    }
    e->covariance[state][state] = variance;
}

static void reset_covariance(estimator_t *e)
{
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        reset_variance(e, i, variance_start[i]);
    }
}

void estimator_init(estimator_t *estimator)
{
    *estimator = (estimator_t){.noise_mps2 = NOISE_START_MPS2, .floor_m = FLOOR_START_M, .upright = 1.0F};
    reset_covariance(estimator);
}

static void bound_states(estimate_t *x)
{
    x->speed_mps = between(-SPEED_MAX_MPS, x->speed_mps, SPEED_MAX_MPS);
    x->bias_mps2 = between(-BIAS_MAX_MPS2, x->bias_mps2, BIAS_MAX_MPS2);
    x->terrain_mps = between(-TERRAIN_MAX_MPS, x->terrain_mps, TERRAIN_MAX_MPS);
}

static inline void propagate(estimate_t *x, const estimator_frame_t *frame, float dt_s)
{
    const float acceleration_mps2 = frame->up_mps2 - frame->share * x->bias_mps2;

    x->height_m += (x->speed_mps - x->terrain_mps + 0.5F * acceleration_mps2 * dt_s) * dt_s;
    x->speed_mps += acceleration_mps2 * dt_s;
    x->terrain_mps *= at_least(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    bound_states(x);
}

static float limit_variance(float p[ESTIMATOR_STATES][ESTIMATOR_STATES], uint16_t state)
{
    const float scale = sqrtf(variance_max[state] / p[state][state]);

    for (uint16_t j = 0U; j < ESTIMATOR_STATES; ++j) {
        *covariance_of(p, state, j) *= scale;
    }
    return p[state][state] * scale;
}

/* Row and column are scaled together, so that the matrix stays positive. */
static inline void bound_variance(float p[ESTIMATOR_STATES][ESTIMATOR_STATES], uint16_t state)
{
    float variance = p[state][state];

    if (variance > variance_max[state]) {
        variance = limit_variance(p, state);
    }
    p[state][state] = at_least(variance, VARIANCE_MIN);
}

static inline void bound_covariance(float p[ESTIMATOR_STATES][ESTIMATOR_STATES])
{
    bound_variance(p, HEIGHT);
    bound_variance(p, SPEED);
    bound_variance(p, BIAS);
    bound_variance(p, TERRAIN);
}

/* P = F P F' + Q, on one half of the symmetric matrix. Row of F: height 1, dt, -half, -dt; speed 0, 1,
 * -slope, 0; bias 0, 0, 1, 0; terrain 0, 0, 0, decay. */
static void propagate_covariance(estimator_t *e, const estimator_frame_t *frame, float dt_s)
{
    float(*const p)[ESTIMATOR_STATES] = e->covariance;
    const float decay = at_least(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    const float slope = frame->share * dt_s;
    const float half = 0.5F * slope * dt_s;
    const float drift_mps2 = e->felt ? BIAS_DRIFT_MPS2 : NO_ACC_DRIFT_MPS2;
    const float speed_bias = p[SPEED][BIAS] - slope * p[BIAS][BIAS];
    const float height_speed = p[HEIGHT][SPEED] + dt_s * (p[SPEED][SPEED] - p[SPEED][TERRAIN]) -
                               half * p[SPEED][BIAS];
    const float height_bias = p[HEIGHT][BIAS] + dt_s * (p[SPEED][BIAS] - p[BIAS][TERRAIN]) -
                              half * p[BIAS][BIAS];
    const float height_terrain = p[HEIGHT][TERRAIN] + dt_s * (p[SPEED][TERRAIN] - p[TERRAIN][TERRAIN]) -
                                 half * p[BIAS][TERRAIN];

    p[HEIGHT][HEIGHT] += dt_s * (p[HEIGHT][SPEED] - p[HEIGHT][TERRAIN]) - half * p[HEIGHT][BIAS] +
                         dt_s * (height_speed - height_terrain) - half * height_bias +
                         HEIGHT_DRIFT_M * HEIGHT_DRIFT_M * dt_s;
    p[HEIGHT][SPEED] = height_speed - slope * height_bias;
    p[HEIGHT][BIAS] = height_bias;
    p[HEIGHT][TERRAIN] = height_terrain * decay;
    p[SPEED][SPEED] += frame->drift * dt_s - slope * (p[SPEED][BIAS] + speed_bias);
    p[SPEED][TERRAIN] = (p[SPEED][TERRAIN] - slope * p[BIAS][TERRAIN]) * decay;
    p[SPEED][BIAS] = speed_bias;
    p[BIAS][BIAS] += drift_mps2 * drift_mps2 * dt_s;
    p[BIAS][TERRAIN] *= decay;
    p[TERRAIN][TERRAIN] = p[TERRAIN][TERRAIN] * decay * decay + TERRAIN_DRIFT_MPS * TERRAIN_DRIFT_MPS * dt_s;
    bound_covariance(p);
}

static void predict_to(estimator_t *e, uint32_t to_us, const estimator_frame_t *frame)
{
    const float dt_s = seconds_between(e->delayed_us, to_us);

    e->terrain_height_m += e->delayed.terrain_mps * dt_s;
    propagate(&e->delayed, frame, dt_s);
    propagate_covariance(e, frame, dt_s);
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

    e->now = e->delayed;
    for (uint16_t i = 0U; i < e->frame_count; ++i) {
        propagate(&e->now, &e->frames[i], seconds_between(time_us, e->frames[i].time_us));
        time_us = e->frames[i].time_us;
    }
    e->now_us = time_us;
}

/* The second difference of white noise has six times its variance; what the vehicle does adds little to it.
 */
static void measure_noise(estimator_t *e, float up_mps2)
{
    const float difference_mps2 = up_mps2 - 2.0F * e->previous_mps2[0] + e->previous_mps2[1];
    const float variance = e->noise_mps2 * e->noise_mps2;
    const float seen = at_most(difference_mps2 * difference_mps2 / 6.0F, NOISE_CLIP * variance);

    e->noise_mps2 = between(NOISE_MIN_MPS2, sqrtf(variance + NOISE_SHARE * (seen - variance)),
                            NOISE_MAX_MPS2);
    e->previous_mps2[1] = e->previous_mps2[0];
    e->previous_mps2[0] = up_mps2;
}

static void restart_at_frame(estimator_t *e, uint32_t time_us, float up_mps2)
{
    e->has_frames = true;
    e->initialised = false;
    e->frame_count = 0U;
    e->delayed_us = time_us;
    e->rays_us = time_us;
    e->now_us = time_us;
    e->previous_mps2[0] = up_mps2;
    e->previous_mps2[1] = up_mps2;
}

static float accelerometer_share(const estimator_t *e, const modelled_motion_t *model)
{
    const float measured = e->noise_mps2 * e->noise_mps2;
    const float modelled = model->noise_mps2 * model->noise_mps2;
    return model->known ? modelled / (modelled + measured) : 1.0F;
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
        propagate(&e->now, frame, seconds_between(e->now_us, frame->time_us));
        e->now_us = frame->time_us;
    }
}

/* The accelerometer is wrong when thrust model and heights show the same error of it. The thrust model alone
 * may be wrong in a gust, the heights alone over a slope of the terrain. */
static void accuse(estimator_t *e)
{
    const float off_mps2 = at_least(ACCUSED_MPS2, ACCUSED_SIGMAS * e->noise_mps2);
    const bool thrust_tells = fabsf(e->off_model_mps2) > off_mps2;
    const bool heights_tell = fabsf(e->mean_innovation_m) > ACCUSED_NOISES * e->floor_m;

    if (thrust_tells && heights_tell && e->mean_innovation_m * e->off_model_mps2 < 0.0F) {
        e->accused_frames = CLEARED_FRAMES;
    } else if (e->accused_frames > 0U) {
        --e->accused_frames;
    }
}

/* Weight of the accelerometer, 0 .. 1. It falls when the low-passed difference between measured and modelled
 * acceleration is large. When the heights show the error too, it is next to 0 until doubt IMU is decided. */
static float credit(estimator_t *e, const modelled_motion_t *model, float up_mps2)
{
    const float off_mps2 = model->known ? up_mps2 - e->now.bias_mps2 - model->up_mps2 : 0.0F;

    e->off_model_mps2 += OFF_MODEL_SHARE * (off_mps2 - e->off_model_mps2);
    accuse(e);
    if (estimator_accuses(e) && model->known) {
        return ACCUSED_CREDIT;
    }
    const float excess = OFF_MODEL_MPS2 / at_least(fabsf(e->off_model_mps2), OFF_MODEL_MPS2);
    return excess * excess * excess * excess;
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
    e->delayed.bias_mps2 = 0.0F;
    e->now.bias_mps2 = 0.0F;
    e->off_model_mps2 = 0.0F;
    reset_variance(e, BIAS, variance_start[BIAS]);
}

/* Drift of the speed, (m/s)2 a second, by the noise of an acceleration that lasts for one frame. */
static float drift_of(float measured_mps2, float modelled_mps2)
{
    return (SPEED_NOISE_MPS2 * SPEED_NOISE_MPS2 +
            (measured_mps2 * measured_mps2 + modelled_mps2 * modelled_mps2)) *
           FRAME_S;
}

/* Acceleration for the prediction: a weighted mean of accelerometer and model, or the model alone. */
static estimator_frame_t motion_of(estimator_t *e, const modelled_motion_t *model, float up_mps2)
{
    const float modelled_mps2 = model->known ? model->up_mps2 : 0.0F;

    if (!e->felt) {
        return (estimator_frame_t){.up_mps2 = modelled_mps2,
                                   .share = model->known ? 1.0F : 0.0F,
                                   .drift = drift_of(0.0F, NO_ACC_NOISE_MPS2)};
    }
    const float mean_mps2 = e->has_frames ? 0.5F * (up_mps2 + e->up_mps2) : up_mps2;
    const float share = accelerometer_share(e, model) * credit(e, model, mean_mps2);
    return (estimator_frame_t){
        .up_mps2 = share * mean_mps2 + (1.0F - share) * modelled_mps2,
        .share = share,
        .drift = drift_of(share * e->noise_mps2, (1.0F - share) * model->noise_mps2),
    };
}

void estimator_predict(estimator_t *e, const imu_sample_t *frame, modelled_motion_t model)
{
    const uint32_t time_us = frame->arrival_us - FRAME_AGE_US;
    const int32_t gap_us = (int32_t)(time_us - e->now_us);
    float upright;
    const float told_mps2 = imu_up_and_upright(frame, &upright);
    const float up_mps2 = frame->has_acceleration ? told_mps2 : 0.0F;
    const bool usable = frame->has_acceleration && fabsf(up_mps2) < UP_MAX_MPS2;
    const bool lacks = !usable && e->felt && (uint32_t)(time_us - e->felt_us) <= ESTIMATOR_FRESH_US;

    if (!has_tilt(frame) || lacks || (int32_t)(frame->sequence - e->sequence) <= 0) {
        return;
    }
    if (usable != e->felt) {
        change_source(e, usable);
    }
    e->felt_us = time_us;
    e->sequence = frame->sequence;
    e->latest = motion_of(e, &model, up_mps2);
    e->latest.time_us = time_us;
    e->latest.roll_rad = frame->median.roll_rad;
    e->latest.pitch_rad = frame->median.pitch_rad;
    e->upright = upright;
    e->up_mps2 = usable ? up_mps2 : 0.0F;
    if (!e->has_frames || gap_us > (int32_t)FRAME_GAP_US || gap_us < -(int32_t)FRAME_GAP_US) {
        restart_at_frame(e, time_us, up_mps2);
    } else if (before(e->delayed_us, time_us)) {
        append_frame(e, &e->latest);
    }
    if (usable) {
        measure_noise(e, up_mps2);
    }
}

/* One row of P - K row' + K (R K - (row - K row))'. */
static inline void correct_row(float *p, uint16_t i, const float *row, const float *gain, uint16_t state,
                               float variance)
{
    const float more = variance * gain[i] - (row[i] - gain[i] * row[state]);

    for (uint16_t j = i; j < ESTIMATOR_STATES; ++j) {
        p[j] += gain[j] * more - gain[i] * row[j];
    }
}

/* A measurement of one state: Joseph's form, which keeps the covariance positive in spite of rounding. Only
 * one half of the symmetric matrix is kept, so it stays symmetric. */
static void correct(estimator_t *e, uint16_t state, float innovation, float variance)
{
    float(*const p)[ESTIMATOR_STATES] = e->covariance;
    const float per_sum = 1.0F / (p[state][state] + variance);
    float row[ESTIMATOR_STATES];
    float gain[ESTIMATOR_STATES];

    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        row[i] = *covariance_of(p, state, i);
        gain[i] = row[i] * per_sum;
    }
    e->delayed.height_m += gain[HEIGHT] * innovation;
    e->delayed.speed_mps += gain[SPEED] * innovation;
    e->delayed.bias_mps2 += gain[BIAS] * innovation;
    e->delayed.terrain_mps += gain[TERRAIN] * innovation;
    correct_row(p[HEIGHT], HEIGHT, row, gain, state, variance);
    correct_row(p[SPEED], SPEED, row, gain, state, variance);
    correct_row(p[BIAS], BIAS, row, gain, state, variance);
    correct_row(p[TERRAIN], TERRAIN, row, gain, state, variance);
    bound_states(&e->delayed);
    bound_covariance(p);
}

static void reset_height(estimator_t *e, float height_m)
{
    e->delayed.height_m = height_m;
    e->delayed.terrain_mps = 0.0F;
    reset_variance(e, HEIGHT, HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    reset_variance(e, TERRAIN, variance_start[TERRAIN]);
    e->rejected_count = 0U;
}

static void initialise_at(estimator_t *e, float height_m)
{
    reset_covariance(e);
    e->delayed.speed_mps = 0.0F;
    reset_height(e, height_m);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
    e->initialised = true;
}

static void reset_to_height(estimator_t *e, float height_m)
{
    reset_variance(e, SPEED, variance_max[SPEED]);
    reset_variance(e, BIAS, variance_start[BIAS]);
    e->delayed.speed_mps = between(-SPEED_RESET_MAX_MPS, e->delayed.speed_mps, SPEED_RESET_MAX_MPS);
    reset_height(e, height_m);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
}

/* The second difference of white noise has six times its variance. This measures the noise of the heights
 * alone; innovations would also contain the noise of the accelerometer. */
static void measure_floor(estimator_t *e, float height_m)
{
    const float difference_m = height_m - 2.0F * e->previous_m[0] + e->previous_m[1];
    const float variance = e->floor_m * e->floor_m;
    const float seen = at_most(difference_m * difference_m / 6.0F, FLOOR_CLIP * variance);

    e->floor_m = between(FLOOR_START_M, sqrtf(variance + FLOOR_SHARE * (seen - variance)), FLOOR_MAX_M);
    e->previous_m[1] = e->previous_m[0];
    e->previous_m[0] = height_m;
}

/* Variance of a height: noise of the sensor plus roughness of the floor, without what a step or a climb
 * adds. */
static float height_variance_m2(const estimator_t *e)
{
    const float rough_m2 = at_least(e->floor_m * e->floor_m - FLOOR_SMOOTH_M * FLOOR_SMOOTH_M, 0.0F);
    return HEIGHT_NOISE_M * HEIGHT_NOISE_M + FLOOR_VARIANCE * rough_m2;
}

static bool innovation_accepted(const estimator_t *e, float innovation_m)
{
    const float sigma_m = sqrtf(e->covariance[HEIGHT][HEIGHT] + HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    const float floor_m = (e->floor_m > FLOOR_SMOOTH_M) ? FLOOR_SIGMAS * e->floor_m : 0.0F;
    const float limit_m = between(INNOVATION_LIMIT_MIN_M, INNOVATION_LIMIT_SIGMAS * sigma_m,
                                  INNOVATION_LIMIT_MAX_M);
    return fabsf(innovation_m) <= at_least(limit_m, floor_m);
}

/* An edge that comes and goes is a bar, and more will follow. The filter takes small edges for speed, and
 * after a large one the next change of the height. So over bars the heights get the variance of a rough floor
 * at once. */
static void watch_bars(estimator_t *e, float innovation_m)
{
    if (fabsf(innovation_m) < BAR_LEAST_M || fabsf(innovation_m) > BAR_MOST_M) {
        return;
    }
    if (innovation_m * e->edge_m < 0.0F && e->delayed_us - e->edge_us < BAR_US) {
        const float bar_m = at_most(fabsf(innovation_m), fabsf(e->edge_m));
        e->floor_m = between(e->floor_m, BAR_SHARE * bar_m, FLOOR_MAX_M);
    }
    e->edge_m = innovation_m;
    e->edge_us = e->delayed_us;
}

static height_outcome_t reject(estimator_t *e, float height_m, float innovation_m)
{
    const float apart_m = fabsf(innovation_m - e->rejected_innovation_m);
    const bool agrees = e->rejected_count > 0U && apart_m <= STEP_AGREEMENT_M;

    ++e->rejected_count;
    e->mean_innovation_m = 0.0F; /* an edge, and the braking after it, say nothing about the accelerometer */
    e->fused_count = 0U;
    e->rejected_innovation_m = innovation_m;
    if (agrees) {
        e->terrain_height_m -= innovation_m;
        reset_height(e, height_m);
        e->confirmed = true;
        return HEIGHT_TERRAIN_STEP;
    }
    if (e->rejected_count == REJECTIONS_MAX) {
        reset_to_height(e, height_m);
        return HEIGHT_RESET;
    }
    return HEIGHT_REJECTED;
}

static height_outcome_t check_and_fuse(estimator_t *e, float height_m)
{
    measure_floor(e, height_m);
    e->innovation_m = height_m - e->delayed.height_m;
    watch_bars(e, e->innovation_m);
    e->confirmed = e->unchecked_count == 0U && innovation_accepted(e, e->innovation_m);
    if (e->unchecked_count == 0U && !e->confirmed) {
        return reject(e, height_m, e->innovation_m);
    }
    e->unchecked_count = (uint16_t)(e->unchecked_count - (e->unchecked_count > 0U));
    e->rejected_count = 0U;
    e->fused_count = (uint16_t)(e->fused_count + (e->fused_count < ACCUSED_HEIGHTS));
    if (e->fused_count == ACCUSED_HEIGHTS) {
        e->mean_innovation_m += ACCUSED_SHARE * (e->innovation_m - e->mean_innovation_m);
    }
    correct(e, HEIGHT, e->innovation_m, height_variance_m2(e));
    return HEIGHT_FUSED;
}

/* Height with the tilt at the instant of the rays. The median of five frames is 50 ms old. */
static float height_at_rays_m(const estimator_t *e, const altitude_t *altitude, uint32_t rays_us)
{
    const uint32_t shown_us = rays_us + TILT_AGE_US - (uint32_t)(0.5e6F * FRAME_S);
    float roll_rad = e->latest.roll_rad;
    float pitch_rad = e->latest.pitch_rad;

    for (uint16_t i = e->frame_count; i > 0U && !before(e->frames[i - 1U].time_us, shown_us); --i) {
        roll_rad = e->frames[i - 1U].roll_rad;
        pitch_rad = e->frames[i - 1U].pitch_rad;
    }
    return altitude_at_tilt(altitude, roll_rad, pitch_rad) * 0.001F;
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
        outcome = check_and_fuse(e, height_m);
    } else {
        initialise_at(e, height_m);
    }
    if (at_rest) {
        correct(e, SPEED, -e->delayed.speed_mps, REST_SIGMA_MPS * REST_SIGMA_MPS);
        correct(e, TERRAIN, -e->delayed.terrain_mps, REST_SIGMA_MPS * REST_SIGMA_MPS);
    }
    predict_now(e);
    return outcome;
}

void estimator_drop_accelerations(estimator_t *e)
{
    if (e->felt) {
        change_source(e, false);
    }
}

void estimator_forget_frame(estimator_t *e)
{
    e->latest.up_mps2 = 0.0F;
    e->latest.share = 0.0F;
    e->latest.drift = drift_of(LATE_NOISE_MPS2, 0.0F);
    reset_variance(e, BIAS, e->covariance[BIAS][BIAS]);
    e->unchecked_count = UNCHECKED_AFTER_RESET;
}

bool estimator_accuses(const estimator_t *estimator)
{
    return estimator->accused_frames > 0U;
}

void estimator_amend(estimator_t *e, float height_m, float speed_mps, float bias_mps2)
{
    e->delayed.height_m += height_m - e->now.height_m;
    e->delayed.speed_mps += speed_mps - e->now.speed_mps;
    e->delayed.bias_mps2 = bias_mps2;
    e->delayed.terrain_mps = 0.0F;
    reset_covariance(e);
    bound_states(&e->delayed);
    predict_now(e);
}

void estimator_start(estimator_t *e, float height_m, float speed_mps, float bias_mps2)
{
    const float variance = e->covariance[BIAS][BIAS];

    estimator_amend(e, height_m, speed_mps, bias_mps2);
    reset_variance(e, BIAS, variance);
    e->rejected_count = 0U;
    e->unchecked_count = UNCHECKED_AFTER_RESET;
    e->initialised = true;
}

void estimator_move_bias(estimator_t *e, float by_mps2)
{
    e->delayed.bias_mps2 += by_mps2;
    e->now.bias_mps2 += by_mps2;
}
