/* A height sensor of one ray: its readings become groups, as a scan's rays are one.
 *
 * control/ takes the height of a group: its mean slant distance, its spread, and the instant to which the
 * mean belongs. A scanner has a group in each scan. A sensor of one ray at 100 Hz has one in each tenth of a
 * second. Without a group nobody can tell a still beam from a quiet one: so
 * altitude_from_ranges() refuses a group of one ray.
 *
 * Its digits must be finer than its noise (a TFmini: set it to millimetres). A group that repeats the one
 * before in every digit is a copy, and is rejected.
 *
 * Millimetres; times named _us are on one wrapping 32-bit clock. Pure; the caller owns the state, all zero at
 * first. Context: one Task. */
#ifndef ONE_RAY_READINGS_H
#define ONE_RAY_READINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

#define READINGS_SPAN_US UINT32_C(100000) /* as a URG-04LX's scan: what counts scans counts the same time */

typedef struct {
    float first_mm; /* sums are of differences from it: they stay small */
    float sum_mm;
    float least_mm, most_mm;
    uint32_t began_us; /* first reading of the group, good or not */
    uint32_t sum_us;   /* of the good readings' times after it */
    uint16_t good_rays;
    bool open; /* the group has a reading */
} readings_t;

/* One reading. slant_mm: as of one ray, NAN where the sensor has none. taken_us: when it was taken; readings
 * come in the order of time. Returns true when this reading begins the next group: then *group is its mean
 * over the good readings (valid: two or more), and *rays_us the mean instant of these. mirror: which one it
 * looks at. */
bool readings_take(readings_t *readings, float slant_mm, uint32_t taken_us, mirror_t mirror,
                   mirror_range_t *group, uint32_t *rays_us);

#endif
