/* One hypothesis of terrain.h: a Kalman filter over the vehicle, the ramp and the ground under each mirror.
 *
 *   altitude  above the ground of the start; speed upwards; bias of the accelerometer: as in filter.h
 *   rate      at which the ground rises under the mirrors that are on the ramp
 *   ground    under each mirror, above the ground of the start
 *
 * Each has its covariance with the others. So while the aft mirror still shows level ground, the altitude and
 * the ramp's rate are both known; while all are on the ramp, speed less rate is known.
 *
 * Metres, seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_EST_TERRAIN_HYPOTHESIS_H
#define CONTROL_EST_TERRAIN_HYPOTHESIS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/filter.h"

#define TERRAIN_OWN_M 0.006F /* noise of each mirror: BELIEF_NOISE_MM of sense/belief_density.h, fitted */

typedef enum {
    TERRAIN_ALTITUDE,
    TERRAIN_SPEED,
    TERRAIN_BIAS,
    TERRAIN_RATE,
    TERRAIN_GROUND, /* of the first mirror_t; the others follow */
    TERRAIN_STATES = TERRAIN_GROUND + (int)MIRROR_COUNT
} terrain_state_t;

typedef struct {
    float share;    /* its probability, or before that its density */
    uint16_t ramps; /* bits: mirrors that were on a ramp in the latest scan */
    float x[TERRAIN_STATES];
    float p[TERRAIN_STATES][TERRAIN_STATES];
} terrain_hypothesis_t;

static inline uint16_t terrain_ground_of(uint16_t mirror)
{
    return (uint16_t)((uint16_t)TERRAIN_GROUND + mirror);
}

/* Gives one state a variance, and no covariance. */
void terrain_hypothesis_reset_variance(terrain_hypothesis_t *hypothesis, uint16_t state, float variance);

/* Moves it over dt_s; bias_mps2: drift of the bias, per root second. */
void terrain_hypothesis_predict(terrain_hypothesis_t *hypothesis, const motion_t *motion, float dt_s,
                                float bias_mps2);

/* The ground under these mirrors has risen with the ramp for gap_s. */
void terrain_hypothesis_rise(terrain_hypothesis_t *hypothesis, uint16_t ramps, float gap_s);

/* How far each height is off what is predicted, and the covariances of that. */
typedef struct {
    float off_m[MIRROR_COUNT];
    float covariance_m2[MIRROR_COUNT][MIRROR_COUNT];
} terrain_innovation_t;

terrain_innovation_t terrain_hypothesis_innovation(const terrain_hypothesis_t *hypothesis,
                                                   const float height_m[MIRROR_COUNT]);

/* Density of the heights of these mirrors, together: of the densest that TERRAIN_OWN_M allows, 0 .. 1. */
float terrain_innovation_density(terrain_innovation_t innovation, uint16_t set);

/* Corrects it with a mirror's height. */
void terrain_hypothesis_correct(terrain_hypothesis_t *hypothesis, uint16_t mirror, float height_m);

/* The ground under this mirror is what its height tells: it has stepped. */
void terrain_hypothesis_meet(terrain_hypothesis_t *hypothesis, uint16_t mirror, float height_m);

/* They are so near to each other that one Gaussian tells both. */
bool terrain_hypothesis_alike(const terrain_hypothesis_t *a, const terrain_hypothesis_t *b);

/* Makes one of two: mean and covariance of both, by their shares. */
void terrain_hypothesis_merge(terrain_hypothesis_t *into, const terrain_hypothesis_t *other);

#endif
