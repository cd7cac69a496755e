/* The ground under each mirror as a state, for TERRAIN IGNORE: what of a height's change is the vehicle's
 * motion, and what is the ground's.
 *
 *   height_i = altitude - ground_i + own_i
 *
 *   own_i    noise of each mirror, 6 mm rms: rays, and the tilt's error times the mirror's lever
 *   common   noise that a scan's heights share, 4 mm rms: the altitude takes it, as a step of its own
 *
 * From scan to scan the ground under a mirror does one of three things:
 *
 *   it stays   most of the time
 *   it steps   by any amount (Laplace, 150 mm): an edge
 *   it rises   with a ramp, or falls: by the ramp's slope, N(0, 0.7) when it begins, times the way of the
 *              spot. That is flown, or made by a tilt; the tilt also tells how the flown one changes
 *
 * Every combination is a way in which the scan can have come about. Each way goes on from each hypothesis
 * that is kept, and makes a new one, whose probability is that of the mirrors' states times the density of
 * the heights in it. Those that tell the same are merged, and the most probable ones are kept for the next
 * scan (multiple hypothesis tracking; Reid 1979, Blackman 2004). One scan cannot tell "the fore mirror is on
 * a ramp, and the vehicle rises" from "the aft mirror's ground falls"; some scans can.
 *
 * A ramp is a plane, and the spots go over it in a row, or obliquely (terrain_ramp.h).
 *
 * What is assumed: one mirror or two meet a ramp first; that all do in one scan is too rare to be looked at.
 * Ground that rises evenly under all mirrors, slower than the accelerometer can tell (some 0.05 m/s), is
 * taken for a sinking vehicle. One mirror alone shows too little; it is not asked.
 *
 * Metres, seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_TERRAIN_H
#define CONTROL_TERRAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/filter.h"
#include "control/est/terrain_hypothesis.h"

#define TERRAIN_COMMON_M 0.004F /* sim/devices/scene.h: 3 mm of a scan, drawn up to 6 */

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
    float lean;                   /* tangent of the pitch; nose up > 0 */
    float reach_m;                /* that the spots are farther fore by it */
} terrain_heights_t;

/* The lowest above the ground that a law flies by what it thinks of the ground; docs/control.md, Terrain. */
#define TERRAIN_LEAST_M 0.15F

/* What a scan may bring. */
#define TERRAIN_STEP 0.01F /* share of the scans with one, for each mirror; tried 0.003 and 0.03 */

#define TERRAIN_KEPT 6U /* tried 2, 4 and 8 */

typedef struct {
    uint16_t count; /* of the hypotheses that are kept; 0: to be begun */
    terrain_hypothesis_t kept[TERRAIN_KEPT];
    terrain_hypothesis_t next[TERRAIN_KEPT], risen, way; /* of one scan: too large for a stack */
    float best;                                          /* density of the best way so far */
    float lean, reach_m;                                 /* of the scan before */
} terrain_t;

/* What a scan means. */
typedef struct {
    float altitude_m, speed_mps, bias_mps2; /* means */
    float speed_variance, bias_variance;
    float ground_m; /* under the middle mirror: the altitude less this is the height */
} terrain_shown_t;

/* Begins with what a filter knows, where no hypothesis is kept. altitude_m: above the ground of the start.
 * ground_m: under the middle mirror, as the filter thinks. A mirror whose first height differs by more than
 * noise is over another ground. What all heights are off by in common rather corrects the altitude. */
void terrain_begin(terrain_t *terrain, const filter_t *filter, const terrain_heights_t *heights,
                   float altitude_m, float ground_m);

/* Moves those that are kept over dt_s; bias_mps2: drift of the bias, per root second. */
void terrain_predict(terrain_t *terrain, const motion_t *motion, float dt_s, float bias_mps2);

/* One scan with at least one height, gap_s > 0 after the one before. Before: terrain_begin(). Heights that no
 * hypothesis explains, not even by steps, change nothing. */
terrain_shown_t terrain_scan(terrain_t *terrain, const terrain_heights_t *heights, float gap_s);

#endif
