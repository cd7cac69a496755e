/* The last word on the thrust. It relies on nothing but the cycle's time, its own last outputs, and what any
 * vehicle can need at most: no estimate, no height, no law. tests/prove/guard.c proves its promises for any
 * input, numbers that are none included.
 *
 *   - the thrust is within idle and full thrust
 *   - no thrust above the idle without an order: the state is GROUND or CUT
 *   - while no height has confirmed a climb, all that is commanded above the hover thrust of the heaviest
 *     vehicle adds up to GUARD_UNSEEN_NS newton seconds at most
 *
 * Newtons per motor, seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_GUARD_H
#define CONTROL_GUARD_H

#include <stdbool.h>

#define GUARD_UNSEEN_NS \
    6.0F /* chosen: twice what a take-off's ramp and a full climb make, 3 N for a second */
#define GUARD_STEP_MAX_S 0.5F /* chosen: longer pauses count as this long */

typedef struct {
    float unseen_ns; /* impulse above the heaviest hover thrust since a climb was confirmed */
} guard_t;

typedef struct {
    float wanted_n;   /* thrust as bounded until here */
    float idle_n;     /* least thrust while there is an order, and all there is without one */
    float heaviest_n; /* hover thrust of the heaviest vehicle */
    float step_s;     /* time since the cycle before */
    bool ordered;     /* false: on the ground, or cut */
    bool confirmed;   /* a height has confirmed the latest climb */
} guard_case_t;

/* One cycle. Returns the thrust to command. */
float guard_step(guard_t *guard, const guard_case_t *now);

#endif
