/* TERRAIN IGNORE: the height above the terrain of the start is held, so steps of the terrain move the
 * setpoint.
 *
 * Metres above the present terrain. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_TERRAIN_KEEP_H
#define CONTROL_TERRAIN_KEEP_H

#include <stdbool.h>

#include "control/est/cascade.h"

typedef struct {
    float reference_m; /* of the previous cycle */
    float terrain_m;   /* height of the terrain for which it was set */
    float ignored_m;   /* of the reference over the present terrain; 0: it is followed */
    float arrived_m;   /* reference that was reached in this flight; 0: none yet */
    bool ignores;      /* the terrain, as ordered and once the reference was reached */
} terrain_keep_t;

/* The law starts: what the terrain has done before does not count. terrain_m: its summed height now. */
void terrain_keep_start(terrain_keep_t *keep, float terrain_m);

typedef enum {
    TERRAIN_KEEP_NOT,   /* the height above the present terrain counts, as with a new reference */
    TERRAIN_KEEP_STEPS, /* height_m is a sum of steps and rates: it drifts */
    TERRAIN_KEEP_GROUND /* height_m is a state (terrain.h): it drifts on ramps only */
} terrain_keep_how_t;

/* The terrain now. */
typedef struct {
    float height_m; /* summed since the start */
    float rate_mps; /* part of that which grows with time; until the reference is reached it does not count */
    terrain_keep_how_t how;
} terrain_keep_ground_t;

/* Height to hold above the present terrain. */
float terrain_keep_setpoint_m(terrain_keep_t *keep, float reference_m, const terrain_keep_ground_t *ground,
                              float step_s);

/* The vertical speed wanted_mps, or what is needed above the ground. Ground that is thought to rise may be a
 * vehicle that sinks: either way the height shrinks by that. So it shrinks no faster than a brake of
 * EST_FALL_MPS2 can stop above TERRAIN_LEAST_M. ground_mps: how fast the ground rises, by heights and
 * estimated speed; of a fresh height. acts_s: from its rays until the command acts. */
float terrain_keep_above_mps(float height_m, float ground_mps, float acts_s, const cascade_gains_t *gains,
                             float wanted_mps);

#endif
