/* What it means for a ramp that the spots of the mirrors are in a row, and go one after the other over the
 * same ground: nose first or tail first. Of a ramp that is met obliquely or sideways nothing of this is
 * known; the scans decide between the two.
 *
 *   which first   the leading mirror meets a ramp by itself. The next one joins it when the one before it is
 *                 on it, and leaves it when that one has left it. Tail first the aft one leads
 *   the plane     mirrors on the ramp stand as high above each other as its slope says. One joins it where
 *                 its own ground and that plane meet
 *   the level     one that leaves it stands on the ground on which those stand that left it before
 *   the start     the ground that the leading mirror comes down to is that of the start, in half of the cases
 *
 * Pure. Context: one Task. */
#ifndef CONTROL_EST_TERRAIN_RAMP_H
#define CONTROL_EST_TERRAIN_RAMP_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/terrain_hypothesis.h"

/* What one hypothesis was before a scan, and what the scan tells. Sets of mirrors are bits. */
typedef struct {
    uint16_t ramps; /* on the ramp before the scan */
    uint16_t told;  /* show a height */
    float fore;     /* probability that the spots go fore */
} terrain_passage_t;

/* moved_m: what a tilt has moved the spots by in gap_s, fore > 0. */
terrain_passage_t terrain_ramp_passage(const terrain_hypothesis_t *hypothesis, uint16_t told, float moved_m,
                                       float gap_s);

/* Probability, before the scan, that these mirrors of those that are told are on the ramp after it; and,
 * where it begins, that it is met in a row, or obliquely. */
float terrain_ramp_prior(const terrain_passage_t *passage, uint16_t rising, bool oblique);

/* One way in which the scan came about: the grounds in it. steps: mirrors whose ground has stepped, by off_m
 * as a height tells it. fore_m: of each spot, from the lateral axis. Binds the hypothesis to plane, level and
 * start, and multiplies its share by their densities; an oblique one by the density of any ground. */
void terrain_ramp_settle(terrain_hypothesis_t *hypothesis, const terrain_passage_t *passage, uint16_t steps,
                         const float off_m[MIRROR_COUNT], const float fore_m[MIRROR_COUNT]);

#endif
