/* Which parameters may change while the vehicle is in the air, and by how much. A burst of lines must not
 * cost a hover more than 0.1 m (tests/integration/test_bursts.c), so the limits are per time and not per
 * line.
 *
 * Pure: time is an argument; the caller owns the state. Context: one Task. */
#ifndef CONTROL_IN_AIR_H
#define CONTROL_IN_AIR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/parameters.h"

typedef enum {
    IN_AIR_FINE,
    IN_AIR_NEVER,        /* on the ground only */
    IN_AIR_TOO_MANY_N,   /* more than 0.2 N within 10 s */
    IN_AIR_OVER_QUARTER, /* a gain: more than a quarter of its value within that time */
    IN_AIR_TOO_OFTEN,    /* LAW: the second change within that time, and not to EST */
    IN_AIR_OFF_HOVER     /* the hover thrust would leave the reach of GRAV, or of GRAV, USAT and DSAT */
} in_air_t;

/* Window of a parameter: begins with a change, ends 10 s later. */
typedef struct {
    bool open;
    float from; /* value at its begin */
    uint32_t since_us;
} in_air_window_t;

typedef struct {
    in_air_window_t window[PARAMETER_COUNT]; /* all zero at first */
} in_air_pace_t;

/* May parameter `id` of the set in force become `to`, a value within its limits? When fine, the caller sets
 * it; a value that does not change is always fine. hover_n: the thrust that carries the vehicle now, as far
 * as known. now_us: wrapping; a window may look open again after 71 minutes.
 *
 * The laws PD and PID add to GRAV at most USAT and take away at most DSAT. They can hold a height only while
 * the hover thrust is between, so a change must leave 0.3 N to either side, or not narrow what is left. With
 * USAT and DSAT both 0 they give GRAV alone, on purpose: then GRAV is only kept within reach of the others.
 */
in_air_t in_air_change(in_air_pace_t *pace, const parameters_t *parameters, parameter_id_t id, float to,
                       float hover_n, uint32_t now_us);

#endif
