/* TERRAIN IGNORE: the height above the terrain of the start is held, so steps of the terrain move the
 * setpoint.
 *
 * Metres above the present terrain. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_TERRAIN_KEEP_H
#define CONTROL_TERRAIN_KEEP_H

#include <stdbool.h>

typedef struct {
    float reference_m; /* of the previous cycle */
    float terrain_m;   /* height of the terrain for which it was set */
} terrain_keep_t;

/* The law starts: what the terrain has done before does not count. terrain_m: its summed height now. */
void terrain_keep_start(terrain_keep_t *keep, float terrain_m);

/* Height to hold. follows: the height above the present terrain counts, as with a new reference. */
float terrain_keep_setpoint_m(terrain_keep_t *keep, float reference_m, float terrain_m, bool follows,
                              float step_s);

#endif
