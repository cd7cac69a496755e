#include "control/est/estimator.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"

#define GRAVITY_MPS2 9.80665F
#define FRAME_AGE_US UINT32_C(23600)
#define TILT_AGE_US UINT32_C(50000)
#define GAP_MAX_US INT32_C(300000)
#define UP_MAX_MPS2 200.0F
#define ANGLE_MAX_RAD 3.2F

#define HEIGHT_NOISE_M 0.0013F
#define HEIGHT_DRIFT_M 0.0047F
#define SPEED_NOISE_SHARE 1.0F
#define SPEED_NOISE_MPS2 0.53F
#define FRAME_S 0.025F
#define BIAS_DRIFT_MPS2 0.095F
#define TERRAIN_DRIFT_MPS 0.053F
#define TERRAIN_TIME_S 1.0F
#define NOISE_START_MPS2 0.4F
#define NOISE_MIN_MPS2 0.05F
#define NOISE_MAX_MPS2 5.0F
#define NOISE_SHARE 0.02F
#define NOISE_CLIP 16.0F

#define NEAR_M 0.053F
#define NEAR_MAX_M 0.080F
#define NEAR_SIGMAS 3.0F
#define AGREE_M 0.050F
#define REFUSALS_MAX 3U
#define UNSEEN_AFTER 2U
#define REST_MPS 0.02F

#define SPEED_MAX_MPS 4.0F
#define BIAS_MAX_MPS2 1.5F
#define TERRAIN_MAX_MPS 0.5F
#define SPEED_ANEW_MPS 1.0F

enum { HEIGHT, SPEED, BIAS, TERRAIN };

static const float variance_max[ESTIMATOR_STATES] = {1.0F, 1.0F, 0.25F, 0.25F};
static const float variance_min[ESTIMATOR_STATES] = {1.0e-7F, 1.0e-7F, 1.0e-7F, 1.0e-7F};
static const float variance_start[ESTIMATOR_STATES] = {1.0e-4F, 0.04F, 0.09F, 0.0025F};

static float seconds(uint32_t from_us, uint32_t to_us)
{
    return (float)(int32_t)(to_us - from_us) * 1.0e-6F;
}

static bool before(uint32_t a_us, uint32_t b_us)
{
    return (int32_t)(a_us - b_us) < 0;
}

/* Forgets what was known of one state and of its ties to the others. */
static void open_state(estimator_t *e, uint16_t state, float variance)
{
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        e->covariance[state][i] = 0.0F;
        e->covariance[i][state] = 0.0F;
    }
    e->covariance[state][state] = variance;
}

static void open_all(estimator_t *e)
{
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        open_state(e, i, variance_start[i]);
    }
}

void estimator_init(estimator_t *estimator)
{
    *estimator = (estimator_t){.noise_mps2 = NOISE_START_MPS2};
    open_all(estimator);
}

static void bound_states(estimate_t *x)
{
    x->speed_mps = between(-SPEED_MAX_MPS, x->speed_mps, SPEED_MAX_MPS);
    x->bias_mps2 = between(-BIAS_MAX_MPS2, x->bias_mps2, BIAS_MAX_MPS2);
    x->terrain_mps = between(-TERRAIN_MAX_MPS, x->terrain_mps, TERRAIN_MAX_MPS);
}

static void carry(estimate_t *x, const estimator_frame_t *frame, float dt_s)
{
    const float acceleration_mps2 = frame->up_mps2 - frame->share * x->bias_mps2;

    x->height_m += (x->speed_mps - x->terrain_mps + 0.5F * acceleration_mps2 * dt_s) * dt_s;
    x->speed_mps += acceleration_mps2 * dt_s;
    x->terrain_mps *= fmaxf(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    bound_states(x);
}

/* Rows and columns are scaled together, so that the matrix stays positive. */
static void bound_covariance(float p[ESTIMATOR_STATES][ESTIMATOR_STATES])
{
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        if (p[i][i] > variance_max[i]) {
            const float scale = sqrtf(variance_max[i] / p[i][i]);
            for (uint16_t j = 0U; j < ESTIMATOR_STATES; ++j) {
                p[i][j] *= scale;
                p[j][i] *= scale;
            }
        }
        p[i][i] = fmaxf(p[i][i], variance_min[i]);
    }
}

static void carry_covariance(estimator_t *e, float share, float dt_s)
{
    float (*const p)[ESTIMATOR_STATES] = e->covariance;
    const float decay = fmaxf(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    const float half = 0.5F * share * dt_s * dt_s;
    const float felt_mps2 = share * e->noise_mps2;
    const float expected_mps2 = (1.0F - share) * e->expected_noise_mps2;
    const float variance = SPEED_NOISE_MPS2 * SPEED_NOISE_MPS2
                         + SPEED_NOISE_SHARE * (felt_mps2 * felt_mps2 + expected_mps2 * expected_mps2);

    for (uint16_t j = 0U; j < ESTIMATOR_STATES; ++j) {
        p[HEIGHT][j] += dt_s * (p[SPEED][j] - p[TERRAIN][j]) - half * p[BIAS][j];
        p[SPEED][j] -= share * dt_s * p[BIAS][j];
        p[TERRAIN][j] *= decay;
    }
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        p[i][HEIGHT] += dt_s * (p[i][SPEED] - p[i][TERRAIN]) - half * p[i][BIAS];
        p[i][SPEED] -= share * dt_s * p[i][BIAS];
        p[i][TERRAIN] *= decay;
    }
    p[HEIGHT][HEIGHT] += HEIGHT_DRIFT_M * HEIGHT_DRIFT_M * dt_s;
    p[SPEED][SPEED] += variance * FRAME_S * dt_s;
    p[BIAS][BIAS] += BIAS_DRIFT_MPS2 * BIAS_DRIFT_MPS2 * dt_s;
    p[TERRAIN][TERRAIN] += TERRAIN_DRIFT_MPS * TERRAIN_DRIFT_MPS * dt_s;
    bound_covariance(p);
}

static void advance(estimator_t *e, uint32_t to_us, const estimator_frame_t *frame)
{
    const float dt_s = seconds(e->past_us, to_us);

    e->stepped_m += e->past.terrain_mps * dt_s;
    carry(&e->past, frame, dt_s);
    carry_covariance(e, frame->share, dt_s);
    e->past_us = to_us;
}

static void drop_oldest(estimator_t *e)
{
    --e->held;
    for (uint16_t i = 0U; i < e->held; ++i) {
        e->frames[i] = e->frames[i + 1U];
    }
}

/* Takes the filter through the frames up to an instant. */
static void advance_until(estimator_t *e, uint32_t to_us)
{
    while (e->held > 0U && !before(to_us, e->frames[0].time_us)) {
        advance(e, e->frames[0].time_us, &e->frames[0]);
        drop_oldest(e);
    }
    if (before(e->past_us, to_us)) {
        advance(e, to_us, (e->held > 0U) ? &e->frames[0] : &e->latest);
    }
}

static void carry_to_now(estimator_t *e)
{
    uint32_t time_us = e->past_us;

    e->now = e->past;
    for (uint16_t i = 0U; i < e->held; ++i) {
        carry(&e->now, &e->frames[i], seconds(time_us, e->frames[i].time_us));
        time_us = e->frames[i].time_us;
    }
    e->now_us = time_us;
}

static float upward_mps2(const motion_frame_t *frame)
{
    const float level = cosf(frame->pitch_rad);
    return frame->down_mps2 * level * cosf(frame->roll_rad) + frame->right_mps2 * level * sinf(frame->roll_rad)
         - frame->forward_mps2 * sinf(frame->pitch_rad) - GRAVITY_MPS2;
}

/* The second difference of white noise has six times its variance; what the vehicle does adds little to it. */
static void measure_noise(estimator_t *e, float up_mps2)
{
    const float difference_mps2 = up_mps2 - 2.0F * e->before_mps2[0] + e->before_mps2[1];
    const float variance = e->noise_mps2 * e->noise_mps2;
    const float seen = fminf(difference_mps2 * difference_mps2 / 6.0F, NOISE_CLIP * variance);

    e->noise_mps2 = between(NOISE_MIN_MPS2, sqrtf(variance + NOISE_SHARE * (seen - variance)), NOISE_MAX_MPS2);
    e->before_mps2[1] = e->before_mps2[0];
    e->before_mps2[0] = up_mps2;
}

static void start_moving(estimator_t *e, uint32_t time_us, float up_mps2)
{
    e->moving = true;
    e->started = false;
    e->held = 0U;
    e->past_us = time_us;
    e->now_us = time_us;
    e->before_mps2[0] = up_mps2;
    e->before_mps2[1] = up_mps2;
}

static float share_of_accelerometer(const estimator_t *e, const expected_motion_t *expected)
{
    const float felt = e->noise_mps2 * e->noise_mps2;
    const float guessed = expected->noise_mps2 * expected->noise_mps2;
    return expected->known ? guessed / (guessed + felt) : 1.0F;
}

static void keep(estimator_t *e, const estimator_frame_t *frame)
{
    if (e->held == ESTIMATOR_FRAMES) {
        advance_until(e, e->frames[0].time_us);
    }
    e->frames[e->held] = *frame;
    ++e->held;
    if (before(e->now_us, frame->time_us)) {
        carry(&e->now, frame, seconds(e->now_us, frame->time_us));
        e->now_us = frame->time_us;
    }
}

static bool plausible(const motion_frame_t *frame, float up_mps2)
{
    return fabsf(up_mps2) < UP_MAX_MPS2 && fabsf(frame->roll_rad) < ANGLE_MAX_RAD
        && fabsf(frame->pitch_rad) < ANGLE_MAX_RAD;
}

void estimator_move(estimator_t *e, const motion_frame_t *frame, expected_motion_t expected)
{
    const uint32_t time_us = frame->arrival_us - FRAME_AGE_US;
    const int32_t gap_us = (int32_t)(time_us - e->now_us);
    const float up_mps2 = upward_mps2(frame);

    if (!frame->usable || (int32_t)(frame->sequence - e->sequence) <= 0 || !plausible(frame, up_mps2)) {
        return;
    }
    const float mean_mps2 = e->moving ? 0.5F * (up_mps2 + e->up_mps2) : up_mps2;
    const float share = share_of_accelerometer(e, &expected);
    e->sequence = frame->sequence;
    e->expected_noise_mps2 = expected.noise_mps2;
    e->up_mps2 = up_mps2;
    e->latest = (estimator_frame_t){
        .time_us = time_us,
        .up_mps2 = share * mean_mps2 + (1.0F - share) * (expected.known ? expected.up_mps2 : 0.0F),
        .share = share,
        .roll_rad = frame->roll_rad,
        .pitch_rad = frame->pitch_rad,
    };
    if (!e->moving || gap_us > GAP_MAX_US || gap_us < -GAP_MAX_US) {
        start_moving(e, time_us, up_mps2);
    } else if (before(e->past_us, time_us)) {
        keep(e, &e->latest);
    }
    measure_noise(e, up_mps2);
}

/* A measurement of one state: Joseph's form, which keeps the covariance symmetric and positive in spite of rounding. */
static void correct(estimator_t *e, uint16_t state, float innovation, float variance)
{
    float (*const p)[ESTIMATOR_STATES] = e->covariance;
    float *const x[ESTIMATOR_STATES] = {&e->past.height_m, &e->past.speed_mps, &e->past.bias_mps2,
                                        &e->past.terrain_mps};
    const float sum = p[state][state] + variance;
    float row[ESTIMATOR_STATES];
    float gain[ESTIMATOR_STATES];

    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        row[i] = p[state][i];
        gain[i] = p[i][state] / sum;
        *x[i] += gain[i] * innovation;
    }
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        for (uint16_t j = 0U; j < ESTIMATOR_STATES; ++j) {
            p[i][j] -= gain[i] * row[j];
        }
    }
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        row[i] = p[i][state];
    }
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        for (uint16_t j = 0U; j < ESTIMATOR_STATES; ++j) {
            p[i][j] += gain[j] * (variance * gain[i] - row[i]);
        }
    }
    for (uint16_t i = 0U; i < ESTIMATOR_STATES; ++i) {
        for (uint16_t j = 0U; j < i; ++j) {
            p[i][j] = p[j][i] = 0.5F * (p[i][j] + p[j][i]);
        }
    }
    bound_states(&e->past);
    bound_covariance(p);
}

static void height_is(estimator_t *e, float height_m)
{
    e->past.height_m = height_m;
    e->past.terrain_mps = 0.0F;
    open_state(e, HEIGHT, HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    open_state(e, TERRAIN, variance_start[TERRAIN]);
    e->refused = 0U;
}

static void start_at(estimator_t *e, float height_m)
{
    open_all(e);
    e->past.speed_mps = 0.0F;
    height_is(e, height_m);
    e->unseen = UNSEEN_AFTER;
    e->started = true;
}

static void start_anew(estimator_t *e, float height_m)
{
    open_state(e, SPEED, variance_max[SPEED]);
    open_state(e, BIAS, variance_start[BIAS]);
    e->past.speed_mps = between(-SPEED_ANEW_MPS, e->past.speed_mps, SPEED_ANEW_MPS);
    height_is(e, height_m);
    e->unseen = UNSEEN_AFTER;
}

static bool expected(const estimator_t *e, float innovation_m)
{
    const float sigma_m = sqrtf(e->covariance[HEIGHT][HEIGHT] + HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    return fabsf(innovation_m) <= between(NEAR_M, NEAR_SIGMAS * sigma_m, NEAR_MAX_M);
}

static height_outcome_t refuse(estimator_t *e, float height_m, float innovation_m)
{
    const bool agrees = e->refused > 0U && fabsf(innovation_m - e->refused_m) <= AGREE_M;

    ++e->refused;
    e->refused_m = innovation_m;
    if (agrees) {
        e->stepped_m -= innovation_m;
        height_is(e, height_m);
        e->confirmed = true;
        return HEIGHT_STEP;
    }
    if (e->refused == REFUSALS_MAX) {
        start_anew(e, height_m);
        return HEIGHT_ANEW;
    }
    return HEIGHT_REFUSED;
}

static height_outcome_t judge(estimator_t *e, float height_m)
{
    e->innovation_m = height_m - e->past.height_m;
    e->confirmed = e->unseen == 0U && expected(e, e->innovation_m);
    if (e->unseen == 0U && !e->confirmed) {
        return refuse(e, height_m, e->innovation_m);
    }
    e->unseen = (uint16_t)(e->unseen - (e->unseen > 0U));
    e->refused = 0U;
    correct(e, HEIGHT, e->innovation_m, HEIGHT_NOISE_M * HEIGHT_NOISE_M);
    return HEIGHT_FUSED;
}

/* The median of five frames shows the angles of 50 ms before. */
static float height_at_rays_m(const estimator_t *e, const altitude_t *altitude, uint32_t rays_us)
{
    const uint32_t shown_us = rays_us + TILT_AGE_US - (uint32_t)(0.5e6F * FRAME_S);
    float roll_rad = e->latest.roll_rad;
    float pitch_rad = e->latest.pitch_rad;

    for (uint16_t i = e->held; i > 0U && !before(e->frames[i - 1U].time_us, shown_us); --i) {
        roll_rad = e->frames[i - 1U].roll_rad;
        pitch_rad = e->frames[i - 1U].pitch_rad;
    }
    return altitude_at_tilt(altitude, roll_rad, pitch_rad) * 0.001F;
}

height_outcome_t estimator_see(estimator_t *e, const altitude_t *altitude, uint32_t rays_us, bool at_rest)
{
    height_outcome_t outcome = HEIGHT_ANEW;

    if (!e->moving) {
        return HEIGHT_REFUSED;
    }
    const float height_m = height_at_rays_m(e, altitude, rays_us);
    advance_until(e, rays_us);
    if (e->started) {
        outcome = judge(e, height_m);
    } else {
        start_at(e, height_m);
    }
    if (at_rest) {
        correct(e, SPEED, -e->past.speed_mps, REST_MPS * REST_MPS);
        correct(e, TERRAIN, -e->past.terrain_mps, REST_MPS * REST_MPS);
    }
    carry_to_now(e);
    return outcome;
}
