/* Medians, against the spikes of the IMU (seed document, 5.2.1.1). The result is always one of the values;
 * of an even count, it is one of the two in the middle. Pure; any context. */
#ifndef CONTROL_MEDIAN_H
#define CONTROL_MEDIAN_H

#include <stdint.h>

/* Median of `count` finite values, count >= 1, in any order. The values are borrowed for the call. */
float median_of(const float *values, uint16_t count);

/* Median of angles: the angle with the smallest sum of arcs to the others. So values on both sides of +-pi
 * count as neighbours. Radians within -pi .. pi, count >= 1. Far from +-pi it equals median_of(). */
float median_of_angles(const float *angles_rad, uint16_t count);

#endif
