/* How fast the vehicle comes nearer to the walls around, and whether that is too fast to stop.
 *
 * Each wall is followed from look to look by a Kalman filter of its distance and of the speed of that. Along
 * a wall nothing tells a speed. Millimetres, seconds, radians. Pure; the caller owns the state. Context: one
 * at a time. */
#ifndef CONTROL_APPROACH_H
#define CONTROL_APPROACH_H

#include <stdbool.h>
#include <stdint.h>

#include "control/walls.h"

typedef struct {
    float bearing_rad; /* of the wall's perpendicular, -pi .. pi */
    float mm;          /* from the vehicle's centre */
    float mmps;        /* towards the wall; below 0: away from it */
    float sigma_mmps;  /* mean error of that */
    bool faces;        /* wall_t */
    /* private */
    uint16_t looks;  /* that have shown it; limited */
    uint16_t missed; /* in a row that have not */
    uint16_t coming; /* in a row that have shown it come too fast; limited */
    float var_mm2, cov, var_mmps2;
} approach_wall_t;

typedef struct {
    approach_wall_t walls[WALLS_MAX]; /* looks == 0: a free place */
} approach_t;

/* No wall is known. */
void approach_reset(approach_t *approach);

/* Another look's walls, dt_s after the look before. */
void approach_step(approach_t *approach, const wall_t walls[], uint16_t count, float dt_s);

/* The wall that the vehicle would reach first of those that it can no longer stop before, by a pilot who is
 * told now; NULL: there is none. Borrowed until the next step. */
const approach_wall_t *approach_warning(const approach_t *approach);

/* The wall whose speed is known best and, where there is one, the best of those in another direction, by 15
 * degrees at least. Returns their number. Borrowed likewise. */
#define APPROACH_KNOWN_MAX 2U
uint16_t approach_known(const approach_t *approach, const approach_wall_t *known[APPROACH_KNOWN_MAX]);

#endif
