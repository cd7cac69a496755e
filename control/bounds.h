/* Bounds on the thrust, as intervals that apply in order. The last one that changes the thrust holds; it is
 * published as `limit`, so that a log says why the thrust was that. Nothing acts behind them but the output
 * against a wrong pin (laws/stuck_pin.h) and the guard (guard.h).
 *
 * Newtons per motor, seconds. Pure; the caller owns the state. */
#ifndef CONTROL_BOUNDS_H
#define CONTROL_BOUNDS_H

#include <stdint.h>

#include "control/situation.h"

typedef enum {
    BOUND_NONE,
    BOUND_CLIMB,    /* a climb that no height has confirmed */
    BOUND_DESCENT,  /* a descent after a far step of the terrain that no height has confirmed, or while all
                       mirrors may lie */
    BOUND_COASTING, /* the IMU was silent, and no heights have checked the speed since */
    BOUND_POWER,    /* commands have no effect, or a pilot may fly */
    BOUND_LANDING,  /* near the ground */
    BOUND_STANDING, /* the vehicle may stand: the thrust is lowered to find out */
    BOUND_ACTUATOR, /* idle and full thrust */
    BOUND_COUNT
} bound_t;

typedef struct {
    float sunk_n;     /* how far the window of the held thrust has sunk in the present descent */
    float felt_n;     /* how far felt climbs have lowered the thrust of a descent out of a pilot's hands */
    float blindly_s;  /* of the latest time in which it sank while all mirrors may lie; 1 s at most */
    float standing_n; /* upper limit while a descent tests whether the vehicle stands */
    float trim_n;     /* added while the throttle is unknown, see bounds_apply() */
    bound_t holds;    /* BOUND_NONE: the law's thrust is unchanged */
} bounds_t;

/* The bounded thrust. Once in each cycle. law_n: as the law wants it.
 *
 * FLOATING in a pilot's hands, or given back by him: nothing tells. GRAV is too low rather than too high, so
 * the vehicle sinks when it is given back, until its effect shows and its hover thrust is learned. Until then
 * more thrust is added while it is too low; never less, and nothing is learned from it. */
float bounds_apply(bounds_t *bounds, const situation_t *now, float law_n);

/* What the latest cycle has added so, >= 0. */
static inline float bounds_added_n(const bounds_t *bounds)
{
    return bounds->trim_n;
}

/* "CLIMB" and so on; BOUND_NONE: "-". */
const char *bound_name(uint16_t limit);

#endif
