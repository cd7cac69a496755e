/* Estimator of height above the terrain, vertical speed, accelerometer bias and terrain rate, by the Kalman
 * filter of filter.h.
 *
 * Prediction uses the accelerations of the IMU frames. They are mixed with the acceleration that the
 * thrust should cause. Heights correct the states at the instant when their rays were taken.
 *
 * A height arrives late. So the filter and its covariance stay at the instant of the latest rays
 * (`delayed_us`). The frames since then are kept. The present estimate (`now`) is the filter's, predicted
 * through these frames. A height that is 70 ms old is therefore fused as exactly as a fresh one.
 *
 * Which heights are used, innovation.h tells. A reset of the filter's height makes its covariance large, and
 * the next two heights are fused without a test.
 *
 * Metres, seconds, 32-bit float; positive is upwards. Times are in microseconds on one wrapping 32-bit
 * clock. Pure; the caller owns the state. */
#ifndef CONTROL_ESTIMATOR_H
#define CONTROL_ESTIMATOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/credit.h"
#include "control/est/filter.h"
#include "control/est/innovation.h"
#include "control/est/roughness.h"
#include "control/est/terrain.h"
#include "control/imu_sample.h"

#define ESTIMATOR_FRAMES 16U /* 0.4 s: a height is fresh for 0.3 s, and its rays are a scan older */
#define ESTIMATOR_FRESH_US UINT32_C(250000) /* the estimate is not used when its frames are older */

typedef struct {
    uint32_t time_us; /* when the frame was measured */
    motion_t motion;  /* since the frame before */
    float roll_rad, pitch_rad;
} estimator_frame_t;

typedef struct {
    bool initialised; /* at least one frame and, after it, one height were received; or estimator_start() */
    filter_t filter;  /* at delayed_us, the instant of the latest rays or later */
    uint32_t delayed_us;
    uint32_t rays_us; /* delayed_us at the latest height */
    estimate_t now;   /* estimate at now_us, the instant of the latest frame */
    uint32_t now_us;
    bool felt;        /* the estimate rests on accelerations; false: on the model and the heights alone */
    uint32_t felt_us; /* when the latest accelerations were measured */
    float up_mps2;    /* measured in the latest frame, gravity removed, bias not removed; 0: not felt */
    estimator_frame_t latest;
    float upright;                              /* cosine of the latest frame's tilt */
    estimator_frame_t frames[ESTIMATOR_FRAMES]; /* since delayed_us, oldest first */
    uint16_t frame_count;
    bool has_frames; /* at least one frame was received */
    uint32_t sequence;
    credit_t credit;          /* of the accelerometer */
    roughness_t roughness;    /* of the heights */
    bool passes_over;         /* estimator_pass_over() */
    terrain_t terrain;        /* meanwhile */
    float ground_mps;         /* meanwhile: how fast the ground has risen, by speed and heights */
    innovation_test_t test;   /* of the heights */
    uint16_t unchecked_count; /* heights yet to be fused without the innovation test */
    bool confirmed;     /* the latest height was used by the test, or was the second one of a terrain step */
    float innovation_m; /* innovation of the latest height */
    float terrain_height_m; /* terrain height above the terrain of the start: its steps plus its integrated
                             * rate */
} estimator_t;

void estimator_init(estimator_t *estimator);

/* Prediction with one frame. Frames come in order of time. Nothing changes when the frame was processed
 * before, or when the offset of its angles is not known. The higher the measured noise of the accelerometer,
 * the more weight `model` gets. When no accelerations have come for ESTIMATOR_FRESH_US, the model alone
 * predicts; a single frame without them changes nothing. */
void estimator_predict(estimator_t *estimator, const imu_sample_t *frame, modelled_motion_t model);

/* Correction with one valid height, whose rays were taken at rays_us. at_rest: the vehicle is known to
 * stand on the ground; then the speed is 0 and the bias can be measured. Returns HEIGHT_REJECTED, and
 * changes nothing, before the first frame. */
height_outcome_t estimator_fuse_height(estimator_t *estimator, const altitude_t *altitude, uint32_t rays_us,
                                       bool at_rest);

/* Whether the ground under each mirror is a state (terrain.h), as TERRAIN IGNORE needs it: then the estimated
 * altitude stays where a ramp begins, and no height is a terrain rate. Starts and ends anew at a change. */
void estimator_pass_over(estimator_t *estimator, bool passes_over);

/* Correction with the heights of the mirrors, where they show the ground (terrain_sees_ground()), while it
 * passes over the terrain and was initialised. */
height_outcome_t estimator_fuse_over(estimator_t *estimator, const terrain_sight_t *sight, uint32_t rays_us);

/* The heights of the mirrors in the latest scan, at its instant; rays_us as it was given with it. */
terrain_heights_t estimator_heights(const estimator_t *estimator, const terrain_sight_t *sight,
                                    uint32_t rays_us);

/* The model alone predicts from now on, until a frame with accelerations comes. */
void estimator_drop_accelerations(estimator_t *estimator);

/* The frames are missing: until the next one comes, the heights alone tell the speed, and nothing the bias.
 * What flies meanwhile accelerates as hard as law EST. */
void estimator_forget_frame(estimator_t *estimator);

/* Overwrites height, speed and bias. For use when the latest heights were wrong. */
void estimator_amend(estimator_t *estimator, float height_m, float speed_mps, float bias_mps2);

/* The same after a gap of the frames. The next heights are fused without the innovation test. */
void estimator_start(estimator_t *estimator, float height_m, float speed_mps, float bias_mps2);

/* Vehicle and ground rise by so much faster than was thought, at the same height. bias_mps2: of the
 * accelerometer. */
void estimator_move_ground(estimator_t *estimator, float by_mps, float bias_mps2);

/* Adds to the bias: the model has taken over a part of it. */
void estimator_move_bias(estimator_t *estimator, float by_mps2);

#endif
