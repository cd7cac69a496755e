/* Which mirrors lie, as probabilities: Bayes over the eight sets of liars, one small filter for each
 * ("world"). In each world two questions are asked of a scan. Do the slants of its liars stay what they were?
 * Do the heights of its honest mirrors move as one?
 *
 *   a liar's slant      constant plus white noise: something in front of the mirror; seldom anything else
 *   an honest height    its level + a motion that all honest mirrors share + white noise;
 *                       seldom a step of the terrain, under this mirror alone
 *
 * The tilt tells them apart: it moves the slant of a true beam as the geometry says, and that of a blocked
 * one not at all. The accelerometer predicts the shared motion. That it lies is a kind of motion: what it
 * tells is held against the thrust, and where they contradict each other, it need not count.
 *
 * Millimetres and seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_BELIEF_H
#define CONTROL_SENSE_BELIEF_H

#include "control/sense/belief_world.h"

#define BELIEF_WORLDS (1U << MIRROR_COUNT)

typedef struct {
    belief_world_t worlds[BELIEF_WORLDS]; /* bit m of the index: mirror m lies */
    belief_mean_t slant[MIRROR_COUNT];    /* what a liar repeats */
    belief_mean_t height[MIRROR_COUNT];   /* what stands still on the ground */
    float missed;                         /* scans: the rate is less sure by so many */
    float loose; /* >= 1: the motions vary more by this factor, because scans were missing */
    belief_motion_t motion[MIRROR_COUNT][BELIEF_MOTIONS]; /* by loose */
    uint16_t known;                                       /* bits: mirrors that have told something before */
    uint16_t told;                                        /* of these: in the latest scan */
} belief_t;

/* One scan. beams: one for each mirror_t. gap_s: since the scan before, > 0. */
void belief_scan(belief_t *belief, const belief_beam_t *beams, float gap_s, belief_felt_t felt);

/* Probability that this mirror lies; 0 before the first scan. */
float belief_of_lie(const belief_t *belief, mirror_t mirror);

/* Probability that at least so many of these mirrors do not lie. mirrors: bits. */
float belief_of_honest(const belief_t *belief, uint16_t mirrors, uint16_t count);

/* Probability that each of these mirrors lies. mirrors: bits, at least one. */
static inline float belief_of_none(const belief_t *belief, uint16_t mirrors)
{
    return 1.0F - belief_of_honest(belief, mirrors, 1U);
}

/* Probabilities of what the latest scan came about by. All of them in one pass over the worlds: a scan asks
 * for each. */
typedef struct {
    float no_step; /* a mirror is honest, and the ground did not step under most of the honest ones: then the
                    * heights show how the vehicle moved. One that stands shows no motion: about 0 */
    float still; /* it has not moved since the scan before: stands or hangs, also if the accelerometer lies */
    float stands, held, felt_lies; /* kinds of motion: BELIEF_STANDS, BELIEF_HELD, BELIEF_FELT_LIES */
} belief_motions_t;

belief_motions_t belief_of_motions(const belief_t *belief);

/* If all mirrors lie that told something in the latest scan. */
typedef struct {
    float rate_mm_s; /* vertical speed at its rays, by accelerometer and thrust */
    float height_mm; /* above the ground then: as the heights were before they lied, and by that speed */
} belief_blind_t;

belief_blind_t belief_blind(const belief_t *belief);

/* State GROUND: where no mirror tells it the height is 0, and the next flight's hover thrust may be another.
 */
void belief_land(belief_t *belief);

#endif
