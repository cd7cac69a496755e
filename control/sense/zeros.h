/* Does each mirror show the ground while the vehicle stands on it? A mirror that is missing looks at the
 * room, one whose steps are wrong looks beside the mirror, wrong lengths show another height than 0, and one
 * that stands beyond an edge sees the floor below.
 *
 * The tilt is not asked: a vehicle that stands on a slope stands as the slope does. Whether it stands, the
 * mirrors say themselves: while at least one of them shows the ground for a second, the others must do so.
 *
 * Millimetres. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_ZEROS_H
#define CONTROL_SENSE_ZEROS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

#define ZEROS_SCANS 10U /* REST_HELD_S: a hand does not hold one mirror at the ground and another off it */
#define ZEROS_MEAN 50U  /* chosen: 5 s; the means have a seventh of the noise of a scan */

/* One mirror since the vehicle stands. */
typedef struct {
    float mm;        /* mean height of the latest scans; of none: undefined */
    uint16_t counts; /* scans in it, ZEROS_MEAN at most */
    uint16_t within; /* scans in a row in which it showed the ground, ZEROS_SCANS at most */
    uint16_t off;    /* in which it did not, or nothing */
} zero_t;

typedef struct {
    bool rested;    /* in the scan before */
    bool stands;    /* all mirrors showed the ground; kept in the air, as all that follows */
    uint16_t wrong; /* bits: mirrors that did not show the ground it stood on */
    zero_t zeros[MIRROR_COUNT];
} zeros_t;

/* Height of the gear by one mirror of a vehicle that stands as the ground does. */
static inline float zeros_height_mm(const altitude_t *shown)
{
    return shown->slant_mm - shown->distance_mm - shown->leg_mm;
}

/* Where the vehicle is, as far as the state says. */
typedef enum {
    ZEROS_AWAY,   /* in the air, or somebody tilts it: the next rest is a new one */
    ZEROS_LIFTED, /* with thrust, on the ground yet or just above it: no scan for the means */
    ZEROS_REST    /* on the ground without thrust */
} zeros_place_t;

/* One scan. shown: one for each mirror_t, borrowed for the call. */
void zeros_scan(zeros_t *zeros, const altitude_t *shown, zeros_place_t place);

/* Scans in the mean of each mirror; 0: not all of them have shown the ground. */
uint16_t zeros_scans(const zeros_t *zeros);

#endif
