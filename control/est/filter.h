/* Kalman filter with four states: height above the terrain, vertical speed, bias of the accelerometer,
 * terrain rate.
 *
 *   height' = speed - terrain rate,   speed' = upward acceleration - bias,
 *   bias' = 0,   rate' = -rate / 1 s.
 *
 * It knows neither time nor sensors: estimator.h says when what is predicted and corrected.
 *
 * Metres, seconds, 32-bit float; positive is upwards. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_FILTER_H
#define CONTROL_FILTER_H

#include <stdint.h>

typedef struct {
    float height_m;    /* above the terrain */
    float speed_mps;   /* upwards, relative to the earth */
    float bias_mps2;   /* bias of the accelerometer; > 0: it reads too much upwards */
    float terrain_mps; /* rate of the terrain below; > 0: it rises */
} estimate_t;

/* What moves the state over one interval. */
typedef struct {
    float up_mps2; /* mean acceleration, gravity removed */
    float share;   /* share of the accelerometer in up_mps2, 0 .. 1 (its bias has the same share); the rest is
                    * the model */
    float drift;   /* what its noise adds to the variance of the speed in a second */
} motion_t;

typedef enum { FILTER_HEIGHT, FILTER_SPEED, FILTER_BIAS, FILTER_TERRAIN, FILTER_STATES } filter_state_t;

typedef struct {
    estimate_t estimate;
    float covariance[FILTER_STATES][FILTER_STATES]; /* symmetric: [i][j] is kept for i <= j */
} filter_t;

/* Where an estimate is after dt_s >= 0. */
estimate_t filter_moved(const estimate_t *estimate, const motion_t *motion, float dt_s);

/* By how much these wander in a root second. */
typedef struct {
    float bias_mps2, terrain_mps;
} filter_drift_t;

/* Moves the filter so, with the covariance. */
void filter_predict(filter_t *filter, const motion_t *motion, float dt_s, const filter_drift_t *drift);

/* A measurement of one state. innovation: measured minus estimated. variance: of the measurement, > 0. */
void filter_correct(filter_t *filter, filter_state_t state, float innovation, float variance);

/* The vehicle stands: neither it nor the ground moves. */
void filter_stand(filter_t *filter);

/* Overwrites the estimate where the caller knows better; within its bounds. */
void filter_bound(filter_t *filter);

/* Gives one state a new variance and removes its covariances with the other states. */
void filter_reset_variance(filter_t *filter, filter_state_t state, float variance);

/* Variance of a state of which little is known: at the start, and the most that it can become. */
float filter_variance_start(filter_state_t state);
float filter_variance_most(filter_state_t state);

/* Gives every state the variance of the start. */
void filter_reset_covariance(filter_t *filter);

#endif
