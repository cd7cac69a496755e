/* Estimator of height above the terrain, vertical speed, accelerometer bias and terrain rate. It is a
 * Kalman filter with four states:
 *
 *   height' = speed - terrain rate,   speed' = upward acceleration - bias,
 *   bias' = 0,   rate' = -rate / 1 s.
 *
 * Prediction uses the accelerations of the IMU frames. They are mixed with the acceleration that the
 * thrust should cause. Heights correct the states at the instant when their rays were taken.
 *
 * A height arrives late. So the filter and its covariance stay at the instant of the latest rays
 * (`delayed`). The frames since then are kept. The present estimate (`now`) is `delayed`, predicted
 * through these frames. A height that is 70 ms old is therefore fused as exactly as a fresh one.
 *
 * Innovation test: a height whose innovation exceeds a bound of at most 80 mm is rejected. Two rejected
 * heights in a row that agree are a step of the terrain. The third rejected height in a row always resets
 * the filter's height, with a large covariance. The next two heights are then fused without the test. So
 * no state of the filter can reject heights for ever.
 *
 * Metres, seconds, 32-bit float; positive is upwards. Times are in microseconds on one wrapping 32-bit
 * clock. Pure; the caller owns the state. */
#ifndef CONTROL_ESTIMATOR_H
#define CONTROL_ESTIMATOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/imu_sample.h"

#define ESTIMATOR_FRAMES 16U /* chosen: 0.4 s of frames; a height is 0.07 s old */
#define ESTIMATOR_STATES 4U
#define ESTIMATOR_FRESH_US UINT32_C(250000) /* the estimate is not used when its frames are older */

typedef struct {
    float height_m;    /* above the terrain */
    float speed_mps;   /* upwards, relative to the earth */
    float bias_mps2;   /* bias of the accelerometer; > 0: it reads too much upwards */
    float terrain_mps; /* rate of the terrain below; > 0: it rises */
} estimate_t;

/* Acceleration that the thrust should cause. */
typedef struct {
    bool known;
    float up_mps2;
    float noise_mps2; /* rms error of up_mps2, > 0 */
} modelled_motion_t;

typedef struct {
    uint32_t time_us; /* when the frame was measured */
    float up_mps2;    /* mean since the frame before, gravity removed */
    float share;      /* share of the accelerometer in up_mps2, 0 .. 1 (its bias has the same share);
                       * the rest is the model */
    float drift;      /* what its noise adds to the variance of the speed in a second */
    float roll_rad, pitch_rad;
} estimator_frame_t;

typedef enum { HEIGHT_FUSED, HEIGHT_REJECTED, HEIGHT_TERRAIN_STEP, HEIGHT_RESET } height_outcome_t;

typedef struct {
    bool initialised; /* at least one frame and, after it, one height were received; or estimator_start() */
    estimate_t delayed;
    float covariance[ESTIMATOR_STATES][ESTIMATOR_STATES]; /* symmetric: [i][j] is kept for i <= j */
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
    float previous_mps2[2];   /* raw accelerations of the two frames before */
    float noise_mps2;         /* measured rms of the accelerometer's noise */
    float off_model_mps2;     /* measured less modelled acceleration, low-passed */
    float mean_innovation_m;  /* low-passed */
    uint16_t fused_count;     /* heights in a row that were fused, at most ACCUSED_HEIGHTS */
    uint16_t accused_frames;  /* > 0: heights and model agree that the accelerometer is wrong */
    float previous_m[2];      /* the two previous heights */
    float floor_m;            /* measured rms noise of the heights; includes the roughness of the floor */
    uint16_t rejected_count;  /* rejected heights in a row */
    uint16_t unchecked_count; /* heights still to be fused without the innovation test */
    bool confirmed;           /* the latest height passed the test, or was the second one of a terrain step */
    float edge_m;             /* latest innovation as high as a bar, see estimator.c */
    uint32_t edge_us;         /* instant of its rays */
    float rejected_innovation_m; /* innovation of the latest rejected height */
    float innovation_m;          /* innovation of the latest height */
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

/* The model alone predicts from now on, until a frame with accelerations comes. */
void estimator_drop_accelerations(estimator_t *estimator);

/* The frames are late: until the next one comes, the heights alone tell the speed, and nothing the bias. */
void estimator_forget_frame(estimator_t *estimator);

/* Heights and the modelled acceleration agree, or did within 0.8 s, that the accelerometer is wrong. It
 * has next to no weight then. */
bool estimator_accuses(const estimator_t *estimator);

/* Overwrites height, speed and bias. For use when the latest heights were wrong. */
void estimator_amend(estimator_t *estimator, float height_m, float speed_mps, float bias_mps2);

/* The same after a gap of the frames. The next heights are fused without the innovation test. */
void estimator_start(estimator_t *estimator, float height_m, float speed_mps, float bias_mps2);

/* Adds to the bias: the model has taken over a part of it. */
void estimator_move_bias(estimator_t *estimator, float by_mps2);

#endif
