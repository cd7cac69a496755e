/* The ground under each mirror as a state, for TERRAIN IGNORE: what of a height's change is the vehicle's
 * motion, and what is the ground's.
 *
 *   height_i = altitude - ground_i + common + own_i
 *
 *   altitude   above the ground of the start: of the Kalman filter (filter.h), whose variance is given here
 *   common     noise that a scan's heights share, 4 mm rms
 *   own_i      noise of each, 6 mm rms: rays, and the tilt's error times the mirror's lever
 *
 * From scan to scan the ground under a mirror does one of three things:
 *
 *   it stays   most of the time
 *   it steps   by any amount (Laplace, 150 mm): an edge
 *   it rises   at the rate of a ramp, or falls. One rate counts for all mirrors: N(0, 0.4 m/s) when a ramp
 *              begins, then what the mirrors on it have shown, with a drift of 0.3 m/s per root second
 *
 * Every combination is a way in which the scan can have come about. Its probability is that of the mirrors'
 * states times the density of the heights in it, where altitude and rate are Gaussian. The ways are merged
 * into one estimate after each scan (first-order generalised pseudo-Bayes; Blom and Bar-Shalom 1988). So
 * while one mirror still shows the ground of before, the altitude is known; the two others learn the ramp
 * meanwhile; and while all are on it, the ramp's rate tells, with accelerometer and thrust.
 *
 * What is assumed: the fore mirror or another one meets a ramp first, and the speed over it lasts. A ramp
 * goes on only while the grounds under the mirrors differ: level ground that sinks under all mirrors alike is
 * a climb. Ground that rises evenly under all of them, slower than the accelerometer can tell (some
 * 0.05 m/s), is taken for a sinking vehicle. One mirror alone shows too little; it is not asked.
 *
 * Metres, seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_TERRAIN_H
#define CONTROL_TERRAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/filter.h"

/* What the mirrors show in one scan. */
typedef struct {
    const altitude_t *altitude; /* of all together */
    const altitude_t *mirrors;  /* each mirror's own, by mirror_t; NULL: there is one alone */
    uint16_t doubted, liars;    /* bits of those that are disbelieved; and for which that lasts */
} terrain_sight_t;

/* This mirror shows a height and does not lie. sight->mirrors: not NULL. */
bool terrain_is_shown(const terrain_sight_t *sight, mirror_t mirror);

/* Two mirrors or more do: one alone tells too little of the ground. begun: this was so in the scan before. To
 * begin, none of them may be doubted; on a ramp one is for a moment. */
bool terrain_sees_ground(const terrain_sight_t *sight, bool begun);

/* The heights of one scan, at one instant. */
typedef struct {
    uint16_t valid;               /* bits: mirrors that show one */
    float height_m[MIRROR_COUNT]; /* by mirror_t */
    float fore_m[MIRROR_COUNT];   /* of each spot, from the lateral axis */
} terrain_heights_t;

/* The lowest above the ground that a law flies by what it thinks of the ground: the height of OFF_GROUND_MM
 * in supervisor.c. */
#define TERRAIN_LEAST_M 0.15F

/* What a scan may bring where the ground is level. */
#define TERRAIN_STEP_LEVEL 0.01F /* share of the scans with one, for each mirror; tried 0.005 to 0.015 */

typedef struct {
    uint16_t known; /* bits: mirrors whose ground is known */
    float ground_m[MIRROR_COUNT];
    float even_m[MIRROR_COUNT];    /* ground_m of level ground: the mirrors' own errors */
    float ramp[MIRROR_COUNT];      /* probability that it was on a ramp in the latest scan */
    float rise_mps, rise_variance; /* of the ramp; variance in m2/s2 */
} terrain_t;

/* What a scan means for the filter of the altitude; see filter_merge(). */
typedef struct {
    filter_merge_t merge;
    float innovation_m; /* what of the heights' change is the vehicle's, against the prediction */
    float ground_m;     /* under the middle mirror: the altitude less this is the height */
} terrain_shown_t;

/* One scan with at least one height. altitude_m: predicted, above the ground of the start. variance_m2: of
 * that prediction, against the ground of the scan before. gap_s > 0: since then. */
terrain_shown_t terrain_scan(terrain_t *terrain, const terrain_heights_t *heights, float altitude_m,
                             float variance_m2, float gap_s);

#endif
