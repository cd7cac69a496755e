/* One hypothesis of terrain.h: a Kalman filter over the vehicle, the ramp and the ground under each mirror.
 *
 *   altitude  above the ground of the start; speed upwards; bias of the accelerometer: as in filter.h
 *   slope     of the ramp: rise per metre, uphill fore > 0
 *   ground speed   of the vehicle, horizontal, fore > 0
 *   ground    under each mirror, above the ground of the start
 *
 * The ground under a mirror on the ramp rises by the slope times what its spot has passed: the ground speed,
 * times the time, and what a tilt has moved the spot by. Each has its covariance with the others (an extended
 * Kalman filter: that product is the only one). So while the aft mirror still shows level ground, all of them
 * are known; while all are on the ramp, two of them tell its slope, and the tilt, which accelerates the
 * vehicle, how its ground speed changes.
 *
 * Metres, seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_EST_TERRAIN_HYPOTHESIS_H
#define CONTROL_EST_TERRAIN_HYPOTHESIS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/filter.h"

/* Rms of the ground speed, as far as the tilt does not tell it: the seed's course is flown at that. */
#define TERRAIN_SPEED_UNTOLD_MPS 0.4F
#define TERRAIN_STEP_M 0.15F /* mean size of a step (Laplace), as belief_world.c */
#define TERRAIN_OWN_M 0.006F /* noise of each mirror: BELIEF_NOISE_MM of sense/belief_density.h, fitted */

typedef enum {
    TERRAIN_ALTITUDE,
    TERRAIN_SPEED,
    TERRAIN_BIAS,
    TERRAIN_SLOPE,
    TERRAIN_GROUND_SPEED,
    TERRAIN_GROUND, /* of the first mirror_t; the others follow */
    TERRAIN_STATES = TERRAIN_GROUND + (int)MIRROR_COUNT
} terrain_state_t;

typedef struct {
    float share;    /* its probability, or before that its density */
    uint16_t ramps; /* bits: mirrors that were on a ramp in the latest scan */
    bool oblique;   /* over that ramp the spots go in no row: it is met obliquely, or sideways */
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

/* Slope and ground speed gap_s later. gained_mps: what the tilt has added to the speed. It is forgotten, and
 * the slope may have bent. */
void terrain_hypothesis_travel(terrain_hypothesis_t *hypothesis, float gained_mps, float gap_s);

/* What the spots pass in gap_s, fore > 0, if the tilt moves them by moved_m. */
static inline float terrain_hypothesis_passed_m(const terrain_hypothesis_t *hypothesis, float moved_m,
                                                float gap_s)
{
    return hypothesis->x[TERRAIN_GROUND_SPEED] * gap_s + moved_m;
}

/* The ground under these mirrors has risen with the ramp, for gap_s. One that was not on it before is for a
 * part of that. */
void terrain_hypothesis_rise(terrain_hypothesis_t *hypothesis, uint16_t ramps, float moved_m, float gap_s);

/* How far the ground under a mirror is off another ground. */
typedef struct {
    float off_m, variance_m2;
    float row[TERRAIN_STATES]; /* covariances of -off_m with each state */
} terrain_tie_t;

/* The other: that under another mirror, plus the slope times apart_m; MIRROR_COUNT: that of the start. */
terrain_tie_t terrain_hypothesis_tie(const terrain_hypothesis_t *hypothesis, uint16_t mirror, uint16_t other,
                                     float apart_m);

/* They are the same. tie: of this hypothesis, unchanged since. */
void terrain_hypothesis_bind(terrain_hypothesis_t *hypothesis, const terrain_tie_t *tie);

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
