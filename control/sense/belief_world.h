/* One scan in one world of belief.h: how likely it is there, and the filter of that world. In a world one set
 * of mirrors lies.
 *
 * Millimetres and seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_SENSE_BELIEF_WORLD_H
#define CONTROL_SENSE_BELIEF_WORLD_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/sense/belief_density.h"

/* Of the filters: beta of Kalata 1984 for 0.5 m/s2; alpha is in belief_world.c. */
#define BELIEF_RATE_GAIN 0.42F

/* belief_world.c: it stands, flies in calm air, something pushes it, it flies, somebody else flies or holds
 * it, the accelerometer lies */
#define BELIEF_MOTIONS 6U
#define BELIEF_STANDS 0U
#define BELIEF_PUSHED 2U
#define BELIEF_HELD 4U
#define BELIEF_FELT_LIES 5U

/* One mirror in one scan. */
typedef struct {
    bool valid; /* false: it tells nothing in this scan, and what is believed of it stays */
    float slant_mm, height_mm;
} belief_beam_t;

/* What else is known of a scan's motion. */
typedef struct {
    bool untold;           /* the accelerometer tells nothing, or is not believed: gained_mps is not read */
    float gained_mps;      /* change of the vertical speed since the scan before, by the accelerometer */
    float pushed_mps;      /* by the thrust, without the air's drag; 0 where it does not carry the vehicle */
    float undelivered_mps; /* >= 0, by the thrust that is commanded and not delivered yet: so unsure is
                              pushed_mps */
    float dragged;         /* share of the vertical speed that the drag has taken meanwhile; 0 as above */
} belief_felt_t;

/* The filter of the world in which one set of mirrors lies. */
typedef struct {
    float probability;            /* of all worlds together: 1 */
    float rate_mm_s;              /* of the heights of the honest mirrors; where none tells it, if it moves */
    float level_mm[MIRROR_COUNT]; /* of the height of each mirror */
    float motions[BELIEF_MOTIONS]; /* probability of each kind of motion; together 1 */
    float begun[MIRROR_COUNT];     /* that a mirror which lies here has begun to since the scan before */
    float no_step; /* that no ground has stepped since the scan before, under most of the honest mirrors; 0:
                      none told anything */
    float still;   /* that it does not move, also if the accelerometer lies */
    float push_off_mps2; /* what the model of the thrust is off by */
    float push_known;    /* 0 to 1: share of that which has been learned */
    float height_mm;     /* mean of the honest mirrors' levels; where none tells it, by the rate */
} belief_world_t;

/* A running mean of the latest scans. */
typedef struct {
    float mm;
    float count; /* of so many, up to a most */
} belief_mean_t;

/* One scan, and what of it is alike in all worlds. */
typedef struct {
    const belief_beam_t *beams; /* one for each mirror_t */
    uint16_t told;              /* bits: mirrors that tell something now, and did before */
    float gap_s;                /* since the scan before, > 0 */
    belief_felt_t felt;
    float slant_off_mm[MIRROR_COUNT], height_off_mm[MIRROR_COUNT]; /* from what each repeats */
    float slant[MIRROR_COUNT], height[MIRROR_COUNT];               /* densities, if nothing moves */
    belief_motion_t (*motion)[BELIEF_MOTIONS]; /* since the scan before, of 1, 2 and 3 mirrors */
    float strange_mps2;                        /* scale of what the accelerometer tells beyond the thrust */
} belief_scan_t;

/* Before the first scan. */
void belief_world_start(belief_world_t *world);

/* Fills what 1, 2 and 3 mirrors share. loose: >= 1, the motions vary more by this factor. */
void belief_world_loosen(belief_motion_t motion[MIRROR_COUNT][BELIEF_MOTIONS], float loose);

/* Fills the densities of a scan whose other members are set. slant, height: means of the scans before, one
 * for each mirror_t. */
void belief_world_look(belief_scan_t *scan, const belief_mean_t *slant, const belief_mean_t *height);

/* Moves the filter by one scan. liars: bits, the mirrors that lie in this world. Returns the density of the
 * scan there. */
float belief_world_scan(belief_world_t *world, const belief_scan_t *scan, uint16_t liars);

static inline bool belief_has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

/* The set has two mirrors or more. */
static inline bool belief_has_several(uint16_t set)
{
    return (set & (set - 1U)) != 0U;
}

#endif
