/* Height above ground from slant distances and tilt: seed document eq. 29-31, with the side mirrors.
 *
 *   h = (y - d) cos(pitch) cos(roll) - L sin(roll) - s d sin(pitch) - l
 *
 *   h  height of the lowest point of the landing gear
 *   y  slant distance: sensor to mirror to ground
 *   d  sensor to mirror
 *   l  mirror to the lowest point of the landing gear
 *   L  vehicle centre to the point of reflection, along the lateral axis
 *   s  +1: the mirror is fore of the lateral axis, -1: aft of it, 0: on it
 *
 * The equation is of one ray, along the mirror's axis. A group of rays is a fan about it: so is the mean of a
 * group made one ray (mirror_range_t), which is no longer the seed's.
 *
 * Millimetres and radians. roll > 0 raises the mirror's side, pitch > 0 raises the fore side. Pure: no clock,
 * no static state. Context: any task. */
#ifndef CONTROL_ALTITUDE_H
#define CONTROL_ALTITUDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "control/parameters.h"

#define SCANNER_STEP_RAD 0.00613592315F /* 2 pi / 1024 */
#define SCANNER_RIGHT_STEP 384.0F       /* there the scanner looks to the right */

typedef enum {
    MIRROR_FRONT, /* step 384 */
    MIRROR_FORE,  /* step 640, the seed's mirror 2 */
    MIRROR_AFT,   /* step 128, the seed's mirror 1 */
    MIRROR_COUNT
} mirror_t;

/* Place of one mirror on the vehicle, from the parameters. Their defaults are those of the seed's Annex III.
 *
 * The sensor stands upright on the right side of the vehicle. It looks to the right, at the front mirror. Its
 * steps are counted counter-clockwise, seen from above. So larger steps look more to the fore side: step 640
 * sees the fore mirror (the seed's mirror 2), step 128 the aft mirror (mirror 1). Both have the same
 * lateral distance from the vehicle's centre as the sensor: L - DF, by default 115 mm.
 *
 * The formula is the seed's. Exact geometry (a ray model in the tests) has two more factors: cos(pitch) on L
 * sin(roll), and cos(pitch) cos(roll) on l. The error is 1.6 mm at 10 degrees of one angle, 3.6 mm at 10
 * degrees of both. */
typedef struct {
    float distance_mm; /* d */
    float leg_mm;      /* l */
    float arm_mm;      /* L */
    float fore_sign;   /* s */
} mirror_geometry_t;

typedef struct {
    mirror_geometry_t mirror[MIRROR_COUNT];
} altitude_geometry_t;

/* Which rays look at the mirrors of LAYOUT, in the order of their steps: `reach` steps to either side of each
 * middle. Whole steps: a parameter between two is the nearer one. */
typedef struct {
    uint16_t count;
    mirror_t mirror[MIRROR_COUNT];
    uint16_t middle[MIRROR_COUNT];
    float axis[MIRROR_COUNT]; /* step of the ray that meets the mirror square. By default as the drawing has
                               * it, and aside of that as far as the middle was mounted aside */
    uint16_t reach;
} mirror_windows_t;

mirror_windows_t altitude_windows_of(const parameters_t *parameters);

/* Geometry from the parameters. */
altitude_geometry_t altitude_geometry_of(const parameters_t *parameters);
/* Geometry from the default parameters. */
altitude_geometry_t altitude_geometry_default(void);

/* Mean slant of one group of rays, all on the same mirror.
 *
 * A mirror stands at 45 degrees, so a ray that comes at an angle a beside its axis leaves it at a beside it,
 * and is longer than the one along the axis: over level ground by 1 / (cos a - q sin a), where q is the slope
 * of the fan by the tilt. To the second order the mean of a group is longer by 1 + mean(a2) / 2 + q mean(a).
 * The first is taken off its slant; the second moves its spot to the side of larger steps, and so L and s d.
 * Both are 0 for a single ray along the axis. */
typedef struct {
    mirror_t mirror;
    bool valid;
    float slant_mm;
    float spread_mm; /* largest minus smallest good ray */
    uint16_t good_rays;
    int32_t later_us;  /* when these rays were taken, after the instant of the scan; may be below 0 */
    float aside_steps; /* mean of these rays' steps, less that of the mirror's axis */
    float wide_steps2; /* variance of these rays' steps */
} mirror_range_t;

/* How much longer the mean of these rays is than the one along the axis, level: mean of 1 / cos. */
float altitude_fan(const mirror_range_t *range);

typedef struct {
    bool valid; /* false: no group was valid, the other fields are 0 */
    bool
        disagree; /* several mirrors, and more probably than not no two are honest; sense/mirrors.h sets it */
    uint16_t ground;    /* number of the ground below: another one after each scan in which it may have
                         * stepped, 0: not known; sense/sense.h sets it too */
    float height_mm;    /* may be negative by sensor noise on the ground */
    float slant_mm;     /* along the axis, mean over the valid groups */
    float spread_mm;    /* largest over the valid groups */
    uint16_t good_rays; /* sum over the valid groups; 0 where they are not known (a replayed log) */
    float distance_mm;  /* means over the valid groups, for altitude_at_tilt(): d */
    float leg_mm;       /* l */
    float arm_mm;       /* L, of the fan's spot */
    float fore_mm;      /* s d, likewise */
    int32_t later_us;   /* their rays, after the instant of the scan */
} altitude_t;

/* Height measured with one mirror, mm. slant_mm: along its axis, finite. Angles in radians, |angle| < pi/2.
 */
float altitude_under_mirror(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad);

/* Height of the same scan, computed again with another tilt, mm. The result is exactly that of
 * altitude_from_ranges(), because the formula is linear in the values whose means are kept. */
float altitude_at_tilt(const altitude_t *altitude, float roll_rad, float pitch_rad);

/* Writes MIRROR_COUNT altitudes, by mirror_t, each of one mirror alone; not valid where no range is, or fewer
 * than two rays: one ray has no spread. ranges: `count` of them, one for each mirror at most. The pointers
 * are borrowed for the call. Angles in radians, |angle| < pi/2. */
void altitude_of_mirrors(altitude_t *altitudes, const altitude_geometry_t *geometry,
                         const mirror_range_t *ranges, size_t count, float roll_rad, float pitch_rad);

/* Mean of those that are valid and have a weight above 0. weights: one for each, of any sum. */
altitude_t altitude_mean(const altitude_t *altitudes, const float *weights, size_t count);
extern const float altitude_weights_equal[MIRROR_COUNT];

/* Both of them. */
altitude_t altitude_from_ranges(const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                                size_t count, float roll_rad, float pitch_rad);

#endif
