/* Height above the terrain, vertical speed, accelerometer bias and terrain rate: a Kalman filter of four states,
 *
 *   height' = speed - terrain rate,   speed' = upward acceleration - bias,   bias' = 0,   rate' = -rate / 1.0 s,
 *
 * driven by the accelerations of the IMU frames, mixed with what the thrust lets expect, and corrected by heights at the
 * instant of their rays. The filter with its covariance lives at the instant of the latest rays; the frames since then are kept, and the estimate of now is the
 * filter's state carried through them. So a height of 70 ms ago is fused as exactly as one of now.
 *
 * A height further from the expectation than a bound of at most 80 mm is not fused. Two in a row that agree are a step of
 * the terrain; the third in a row, whatever it says, starts the height anew with an open covariance, and the two after
 * it are fused unchecked_count: no state keeps the heights out.
 *
 * Metres, seconds, 32-bit float. Times in microseconds on one wrapping 32-bit clock. Pure; the caller owns the state. */
#ifndef CONTROL_ESTIMATOR_H
#define CONTROL_ESTIMATOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/imu_sample.h"

#define ESTIMATOR_FRAMES 16U
#define ESTIMATOR_STATES 4U
#define ESTIMATOR_FRESH_US UINT32_C(250000)     /* older frames make the estimate useless */

typedef struct {
    float height_m;         /* above the terrain */
    float speed_mps;        /* upwards, against the earth */
    float bias_mps2;        /* of the accelerometer, upwards */
    float terrain_mps;      /* the terrain below rises */
} estimate_t;

/* What the acceleration should be, from the thrust. */
typedef struct {
    bool known;
    float up_mps2;
    float noise_mps2;       /* how wrong that may be, rms, > 0 */
} modelled_motion_t;

typedef struct {
    uint32_t time_us;       /* of the content */
    float up_mps2;          /* without gravity, from the frame before to this one */
    float share;            /* of the accelerometer in it, and so of its bias; the rest is expectation */
    float roll_rad, pitch_rad;
} estimator_frame_t;

typedef enum { HEIGHT_FUSED, HEIGHT_REJECTED, HEIGHT_TERRAIN_STEP, HEIGHT_RESET } height_outcome_t;

typedef struct {
    bool initialised;           /* a frame has come, and a height with it */
    estimate_t delayed;
    float covariance[ESTIMATOR_STATES][ESTIMATOR_STATES];
    uint32_t delayed_us;
    estimate_t now;         /* at now_us, the latest frame's instant */
    uint32_t now_us;
    float up_mps2;          /* measured in the latest frame, gravity removed, bias not */
    estimator_frame_t latest;
    estimator_frame_t frames[ESTIMATOR_FRAMES];     /* since delayed_us, oldest first */
    uint16_t frame_count;
    bool has_frames;            /* a frame has come */
    uint32_t sequence;
    float previous_mps2[2];   /* raw accelerations of the two frames before */
    float noise_mps2;       /* measured rms of the accelerometer's noise */
    float model_noise_mps2;
    float off_model_mps2;   /* felt less what the thrust makes, low-passed */
    float previous_m[2];    /* the two heights before */
    float floor_m;          /* measured rms noise of the heights, rough floor included */
    uint16_t rejected_count;       /* heights in a row */
    uint16_t unchecked_count;        /* heights still to be fused whatever they say */
    bool confirmed;         /* the latest height was as expected, or the second of a step */
    float rejected_innovation_m;        /* innovation of the latest rejected_count height */
    float innovation_m;     /* latest */
    float terrain_height_m; /* above the terrain of the start: sum of its steps and of its rate */
} estimator_t;

void estimator_init(estimator_t *estimator);

/* One frame, in order. A frame that was seen before changes nothing, nor does one without accelerations or before the
 * offset of its angles is known. The noisier the accelerometer is measured to be, the
 * more the expected motion counts. */
void estimator_predict(estimator_t *estimator, const imu_sample_t *frame, modelled_motion_t model);

/* One valid height, its rays taken at rays_us. at_rest: the vehicle is known to stand on the ground, which tells speed
 * and bias. Without a frame before nothing happens (HEIGHT_REJECTED). */
height_outcome_t estimator_fuse_height(estimator_t *estimator, const altitude_t *altitude, uint32_t rays_us,
                                       bool at_rest);

/* What the frame's accelerometer feels upwards, gravity removed. */
float motion_up_mps2(const imu_sample_t *frame);

/* The heights of late were wrong: height, speed and bias are these now. */
void estimator_amend(estimator_t *estimator, float height_m, float speed_mps, float bias_mps2);

#endif
