/* Looking ahead, for TERRAIN FOLLOW: which ground the vehicle's middle will be over when a command acts that
 * is given now.
 *
 * Three spots on the ground lie one behind the other: under the fore mirror, the middle, the aft one. The
 * vehicle flies nose first, tail first, or neither: it hovers, or flies sideways. Nobody tells which. The
 * grounds do, from scan to scan:
 *
 *   nose first   the ground under the fore mirror is new. That of the middle becomes what was under the fore
 *                mirror, or a part of it, and that of the aft mirror what was under the middle
 *   tail first   the other way round
 *   neither      a ground steps seldom, and follows no other
 *
 * Each has a likelihood, and what is probable was so in the scan before or begins now: a hidden Markov model
 * (Rabiner 1989). Over level ground nothing tells the direction, and what was known of it is forgotten.
 *
 * The mirror that leads shows the ground to come. The middle will be over it with the probability of that
 * direction, times that of getting there in time.
 *
 * Metres, seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_AHEAD_H
#define CONTROL_AHEAD_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/cascade.h"
#include "control/est/estimator.h"
#include "control/est/terrain.h"

typedef struct {
    bool known;                  /* the grounds are, since the scan before */
    float nose, tail;            /* probabilities of flying nose or tail first */
    float under_m[MIRROR_COUNT]; /* ground under the mirror, above that of the start */
    float way_m[MIRROR_COUNT];   /* from the middle to that spot */
    float ground_m;              /* that the height counts from */
    uint32_t rays_us;            /* of the latest scan */
} ahead_t;

/* One scan. altitude_m: of the vehicle at its instant, above the ground of the start. ground_m: which of it
 * is the ground that the height counts from. Without three heights nothing is known. */
void ahead_scan(ahead_t *ahead, const terrain_heights_t *heights, float altitude_m, float ground_m,
                uint32_t rays_us);

/* The same, after estimator_fuse_*() of that scan; without each mirror's own height nothing changes. A mirror
 * that is disbelieved shows no ground: nothing is known then. */
void ahead_look(ahead_t *ahead, const estimator_t *estimator, const terrain_sight_t *sight, uint32_t rays_us);

/* The height to hold above the ground that the height counts from, so that it is setpoint_m above the ground
 * to come, on average. then_us: when the command acts. Ground that is farther away than up_mps or down_mps
 * over height_per_s asks for no more speed, so it counts as at that distance. A descent that begins early
 * leaves TERRAIN_LEAST_M above the highest ground that a mirror shows: the tail may not be clear yet. */
float ahead_setpoint_m(const ahead_t *ahead, const cascade_gains_t *gains, float setpoint_m,
                       uint32_t then_us);

#endif
