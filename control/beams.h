/* Which mirrors are believed in one scan. Two that agree outvote one that does not; so one beam that is
 * blocked, frozen or lost tells nothing, and an edge of the terrain counts when the second beam has passed
 * it.
 *
 *   three heights   all, when they lie together; else the two that do; else the middle one
 *   two heights     both, when they lie together; else the one nearer to the height before
 *   one height      that one
 *
 * What breaks: two beams that are blocked at one length outvote the third.
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_BEAMS_H
#define CONTROL_BEAMS_H

#include <stdbool.h>

#include "control/altitude.h"

typedef struct {
    bool known; /* there was a height before */
    float height_mm;
} beams_t;

/* One scan: the height of the mirrors that are believed. Arguments as altitude_from_ranges(), which is asked
 * with these mirrors alone; `disagree` is about all. count: up to MIRROR_COUNT. */
altitude_t beams_scan(beams_t *beams, const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                      uint16_t count, float roll_rad, float pitch_rad);

#endif
