/* Differences of directions, across +-pi. Pure; any context. */
#ifndef CONTROL_ANGLE_H
#define CONTROL_ANGLE_H

#include <math.h>

/* Shortest turn from one direction to another, -pi .. pi, for angles within -pi .. pi. For angles up to one
 * turn beyond, within -2 pi .. 2 pi. */
static inline float turn_rad(float from_rad, float to_rad)
{
    const float half_turn_rad = 3.14159265F; /* pi */
    const float turned_rad = to_rad - from_rad;
    return (turned_rad > half_turn_rad)    ? turned_rad - 2.0F * half_turn_rad
           : (turned_rad < -half_turn_rad) ? turned_rad + 2.0F * half_turn_rad
                                           : turned_rad;
}

/* Its size, for a median over many angles: one comparison less than fabsf(turn_rad()). */
static inline float arc_rad(float from_rad, float to_rad)
{
    const float half_turn_rad = 3.14159265F; /* pi */
    const float apart_rad = fabsf(to_rad - from_rad);
    return (apart_rad > half_turn_rad) ? fabsf(2.0F * half_turn_rad - apart_rad) : apart_rad;
}

#endif
