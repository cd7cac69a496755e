/* Medians, against the spikes of the IMU (seed document, 5.2.1.1). The result is always one of the values;
 * of an even count, it is one of the two in the middle. Pure; any context. */
#ifndef CONTROL_MEDIAN_H
#define CONTROL_MEDIAN_H

#include <math.h>
#include <stdint.h>

/* Angle between two directions, 0 .. pi. The angles may be up to one turn beyond +-pi. */
static inline float arc_rad(float from_rad, float to_rad)
{
    const float half_turn_rad = 3.14159265F; /* pi */
    const float apart_rad = fabsf(to_rad - from_rad);
    return (apart_rad > half_turn_rad) ? fabsf(2.0F * half_turn_rad - apart_rad) : apart_rad;
}

/* Median of `count` finite values, count >= 1, in any order. The values are borrowed for the call. */
float median_of(const float *values, uint16_t count);

/* Median of angles: the angle with the smallest sum of arcs to the others. So values on both sides of +-pi
 * count as neighbours. Radians within -pi .. pi, count >= 1. Far from +-pi it equals median_of(). */
float median_of_angles(const float *angles_rad, uint16_t count);

#endif
