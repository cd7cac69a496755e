/* The last word on the thrust. It relies on nothing but the cycle's time, its own last outputs, and what any
 * vehicle can need at most: no estimate, no height, no law. tests/prove/guard.c proves its promises for any
 * input, numbers that are none included.
 *
 *   - the thrust is within idle and full thrust
 *   - no thrust above the idle without an order: the state is GROUND or CUT
 *   - while no height has confirmed a climb, all that is commanded above the hover thrust of the heaviest
 *     vehicle adds up to GUARD_UNSEEN_NS newton seconds at most
 *   - a thrust that was given up to the hover thrust of the lightest vehicle is needed, as far as is known
 *     here: it fades by GUARD_FADE_N_PER_S at most. What is commanded below it adds up to GUARD_FALL_NS, and
 *     only more thrust pays that back. So a law that commands nothing lets the vehicle sink, and not fall
 *
 * Newtons per motor, seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_GUARD_H
#define CONTROL_GUARD_H

#include <stdbool.h>

/* It lifts the heaviest vehicle, 8.4 N, by 3 m, the highest reference: 3 m * 2.4 1/s * 8.4 N / 9.81 m/s2,
 * rounded down. An impulse makes a speed, and the damping, 2.4 1/s, ends it. */
#define GUARD_UNSEEN_NS 6.0F
/* Tried: of 51 flights of the scenarios none makes more than 0.6, of 300 under lies none more than 2.4. */
#define GUARD_FALL_NS 3.0F
#define GUARD_FADE_N_PER_S 2.0F /* as LANDED_FADE_N_PER_S in touchdown.h: the quickest end of a landing */

typedef struct {
    float unseen_ns; /* impulse above the heaviest hover thrust since a climb was confirmed */
    float sure_n;    /* thrust that is needed, as far as is known here */
    float fallen_ns; /* impulse below it, less what was above it since */
} guard_t;

typedef struct {
    float wanted_n;   /* thrust as bounded until here */
    float idle_n;     /* least thrust while there is an order, and all there is without one */
    float heaviest_n; /* hover thrust of the heaviest vehicle */
    float lightest_n; /* and of the lightest one */
    float step_s;     /* time since the cycle before */
    bool ordered;     /* false: on the ground, or cut */
    bool confirmed;   /* a height has confirmed the latest climb */
} guard_case_t;

/* One cycle. Returns the thrust to command. */
float guard_step(guard_t *guard, const guard_case_t *now);

#endif
