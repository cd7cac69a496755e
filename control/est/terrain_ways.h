/* The ways in which one scan of terrain.h can have come about: under each mirror the ground stays, steps, or
 * rises with the ramp. Sums over all of them, each times its density.
 *
 * Metres and seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_EST_TERRAIN_WAYS_H
#define CONTROL_EST_TERRAIN_WAYS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

#define TERRAIN_OWN_M 0.006F    /* BELIEF_NOISE_MM of sense/belief_world.h, fitted */
#define TERRAIN_STEP_M 0.15F    /* mean size of a step (Laplace), as belief_world.c */
#define TERRAIN_COMMON_M 0.004F /* sim/devices/scene.h: 3 mm of a scan, drawn up to 6 */

typedef struct {
    /* filled by the caller */
    uint16_t told;                                  /* bits: mirrors with a height whose ground is known */
    float off_m[MIRROR_COUNT];                      /* height less its prediction */
    float steps[MIRROR_COUNT], rises[MIRROR_COUNT]; /* probabilities before the scan */
    float variance_m2, common_m2;                   /* of the prediction; and the common noise */
    float rise_m, rise_m2;                          /* of the ramp since the scan before: mean, variance */
    /* sums, times the density of each way */
    float density, off, pull, pull_2, gain, kept, after_m2;
    float ramp, risen, risen_2;
    float on_ramp[MIRROR_COUNT], ground_m[MIRROR_COUNT];
} terrain_ways_t;

/* Adds all ways to the sums, which are zero before. */
void terrain_ways_add(terrain_ways_t *ways);

#endif
