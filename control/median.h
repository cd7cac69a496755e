/* Moving medians: the cure for the IMU's spikes (seed document, 5.2.1.1). The result is always one of the values;
 * of an even count, one of the two middle ones. Pure; any context. */
#ifndef CONTROL_MEDIAN_H
#define CONTROL_MEDIAN_H

#include <stdint.h>

/* Median of 1 or more finite values, in no order, borrowed for the call. */
float median_of(const float *values, uint16_t count);

/* The same on the circle: the angle with the least sum of arcs to the others, so that values on both sides of +-pi
 * are neighbours. Radians within -pi .. pi. Away from the seam it is median_of. */
float median_of_angles(const float *angles_rad, uint16_t count);

#endif
