/* Which mirrors lie, as probabilities: Bayes over the eight sets of liars, one small filter for each
 * ("world"). In each world two questions are asked of a scan. Do the slants of its liars stay what they were?
 * Do the heights of its honest mirrors move as one?
 *
 *   a liar's slant      constant plus white noise: something in front of the mirror; seldom anything else
 *   an honest height    its level + a motion that all honest mirrors share + white noise;
 *                       seldom a step of the terrain, under this mirror alone
 *
 * The tilt tells them apart: it moves the slant of a true beam as the geometry says, and that of a blocked
 * one not at all. The thrust is not asked. The accelerometer only helps to predict the shared motion.
 *
 * Millimetres and seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_BELIEF_H
#define CONTROL_SENSE_BELIEF_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

#define BELIEF_WORLDS (1U << MIRROR_COUNT)
/* Standard deviation of one mirror's height about that of the others, and of a blocked beam's slant. Fitted
 * on healthy flights, see belief.c; recorded: 1 mm at most. */
#define BELIEF_NOISE_MM 6.0F
#define BELIEF_MOTIONS 3U /* belief.c: it stands, it flies, or something pushes it */

/* One mirror in one scan. */
typedef struct {
    bool valid; /* false: it tells nothing in this scan, and what is believed of it stays */
    float slant_mm, height_mm;
} belief_beam_t;

/* The world in which one set of mirrors lies. */
typedef struct {
    float probability;             /* of all worlds together: 1 */
    float rate_mm_s;               /* of the heights of the honest mirrors */
    float level_mm[MIRROR_COUNT];  /* of the height of each mirror */
    float motions[BELIEF_MOTIONS]; /* probability of each kind of motion; together 1 */
} belief_world_t;

/* A running mean of the latest scans. */
typedef struct {
    float mm;
    float count; /* of so many, up to a most */
} belief_mean_t;

typedef struct {
    belief_world_t worlds[BELIEF_WORLDS]; /* bit m of the index: mirror m lies */
    belief_mean_t slant[MIRROR_COUNT];    /* what a liar repeats */
    belief_mean_t height[MIRROR_COUNT];   /* what stands still on the ground */
    uint16_t known;                       /* bits: mirrors that have told something before */
} belief_t;

/* One scan. beams: one for each mirror_t. gap_s: since the scan before, > 0. gained_mps: change of the
 * vertical speed in that time, by the accelerometer; 0 where it is not believed. */
void belief_scan(belief_t *belief, const belief_beam_t *beams, float gap_s, float gained_mps);

/* Probability that this mirror lies; 0 before the first scan. */
float belief_of_lie(const belief_t *belief, mirror_t mirror);

/* Probability that at least two of these mirrors do not lie. mirrors: bits. */
float belief_of_two(const belief_t *belief, uint16_t mirrors);

/* Probability that each of these mirrors lies. mirrors: bits, at least one. */
float belief_of_none(const belief_t *belief, uint16_t mirrors);

#endif
