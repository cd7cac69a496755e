/* Walls in a look round: straight rows of what the rays met, with their distance from the vehicle's centre.
 *
 * A row is six neighbouring rays or more, so a thing is one from a width of an eighth of its distance on: a
 * wall, a box, a person, and no chair's leg. The vehicle may turn about its centre: that changes a wall's
 * bearing, not its distance. Millimetres and radians. Pure; any context. */
#ifndef CONTROL_WALLS_H
#define CONTROL_WALLS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/around.h"

#define WALLS_MAX 6U /* more rows than that are left out */

typedef struct {
    float bearing_rad; /* of its perpendicular, -pi .. pi */
    float mm;          /* along that, from the vehicle's centre to the wall or its continuation */
    float sigma_mm;    /* mean error of that */
    bool faces; /* who flies along the perpendicular meets it, as far as it is seen to go on, or may go on
                 * where nobody looks */
} wall_t;

/* Returns how many were found. look: confirmed. abeam_mm: the scanner stands so far to the right of the
 * centre. */
uint16_t walls_find(wall_t walls[WALLS_MAX], const around_look_t *look, float abeam_mm);

#endif
