/* Height above ground from slant distances and tilt: seed document eq. 29-31, with the side mirrors.
 *
 *   h = (y - d) cos(pitch) cos(roll) - L sin(roll) - s d sin(pitch) - l
 *
 * y slant distance sensor - mirror - ground, d sensor to mirror, l mirror to the lowest point of the landing
 * gear, L vehicle centre to the point of reflection along the lateral axis, s = +1 fore, -1 aft of that axis,
 * 0 on it. roll > 0 raises the mirror's side, pitch > 0 raises the fore side. Pure: no clock, no static
 * state; any task. */
#ifndef CONTROL_ALTITUDE_H
#define CONTROL_ALTITUDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "control/parameters.h"

typedef enum {
    MIRROR_FRONT, /* step 384 */
    MIRROR_FORE,  /* step 640, the seed's mirror 2 */
    MIRROR_AFT,   /* step 128, the seed's mirror 1 */
    MIRROR_COUNT
} mirror_t;

/* One mirror's place on the vehicle, from the parameters, whose defaults are the seed's Annex III.
 *
 * The sensor sits upright on the vehicle's right side and looks to the right, outwards, at the front mirror.
 * Its steps grow counter-clockwise seen from above, so a larger step lies to its left, and the left of one
 * who looks to the vehicle's right is fore: step 640 is the seed's mirror 2 and fore, step 128 its mirror 1
 * and aft. Both stand abeam of the sensor's axis, which is L - DF, as delivered 115 mm, from the vehicle's
 * centre.
 *
 * The formula is the seed's. Against exact geometry (the tests hold a ray model) it lacks cos(pitch) on L
 * sin(roll) and cos(pitch) cos(roll) on l: at 10 degrees of one angle 1.6 mm, of both 3.6 mm. */
typedef struct {
    float distance_mm; /* d */
    float leg_mm;      /* l */
    float arm_mm;      /* L */
    float fore_sign;   /* s */
} mirror_geometry_t;

typedef struct {
    mirror_geometry_t mirror[MIRROR_COUNT];
} altitude_geometry_t;

altitude_geometry_t altitude_geometry_of(const parameters_t *parameters);
/* Of the parameters as delivered. */
altitude_geometry_t altitude_geometry_default(void);

#define ALTITUDE_DISAGREE_MM 50.0F /* chosen: ten times the noise of a group */

/* Mean slant of one group of rays, all on the same mirror. */
typedef struct {
    mirror_t mirror;
    bool valid;
    float slant_mm;
    float spread_mm; /* largest minus smallest good ray */
    uint16_t good_rays;
} mirror_range_t;

typedef struct {
    bool valid;         /* false: no group was valid, the other fields are 0 */
    bool disagree;      /* two groups differ by more than ALTITUDE_DISAGREE_MM in height */
    float height_mm;    /* may be negative by sensor noise on the ground */
    float slant_mm;     /* mean over the valid groups */
    float spread_mm;    /* largest over the valid groups */
    uint16_t good_rays; /* sum over the valid groups */
    float distance_mm;  /* means over the valid groups, for altitude_at_tilt(): d */
    float leg_mm;       /* l */
    float arm_mm;       /* L */
    float fore_mm;      /* s d */
} altitude_t;

/* Height under one mirror. slant_mm finite, angles in radians, |angle| < pi/2. */
float altitude_under_mirror(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad);

/* The height that altitude_from_ranges() would have found in the same ranges under another tilt: exact, the
 * formula is linear in what it takes the mean of. */
float altitude_at_tilt(const altitude_t *altitude, float roll_rad, float pitch_rad);

/* Mean height of the valid groups among `count` ranges (both borrowed for the call). */
altitude_t altitude_from_ranges(const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                                size_t count, float roll_rad, float pitch_rad);

#endif
