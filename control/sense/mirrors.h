/* Which mirrors are believed in one scan, and the height that they show. A mirror that more probably lies
 * than not (belief.h), or repeats its scan, is left out. Of the others:
 *
 *   three heights   all, when they lie together; else the two that do; else the middle one
 *   two heights     both, when they lie together; else the one nearer to the height before
 *   one height      that one
 *
 * So an edge of the terrain counts when the second beam has passed it. When all are left out, all count.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_MIRRORS_H
#define CONTROL_SENSE_MIRRORS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/sense/belief.h"

/* What a copy repeats. */
typedef struct {
    float slant_mm, spread_mm;
} mirror_digits_t;

typedef struct {
    belief_t belief;
    altitude_t altitude;                  /* of the latest scan; not valid before the first */
    bool agree;                           /* its height is that of two honest mirrors, with 99 % */
    mirror_digits_t latest[MIRROR_COUNT]; /* of each mirror, to find copies */
    float gained_mps, gained_before_mps; /* change of the vertical speed since the scan, and in that before */
} mirrors_t;

/* One IMU frame: the vertical speed has changed by so much. */
void mirrors_frame(mirrors_t *mirrors, float gained_mps);

/* One scan: writes altitude and agree. shown: one altitude for each mirror_t, not valid where it shows none.
 * gap_s: since the scan before, > 0. age_s: of its rays. felt: the accelerometer is believed. */
void mirrors_scan(mirrors_t *mirrors, const altitude_t *shown, float gap_s, float age_s, bool felt);

#endif
