/* How law EST comes down: its speed, and the limits of its thrust.
 *
 * Metres, seconds, newtons per motor; speeds are positive upwards. Pure; the caller owns the state. Context:
 * one Task. */
#ifndef CONTROL_LET_DOWN_H
#define CONTROL_LET_DOWN_H

#include <stdbool.h>

#include "control/laws/descent.h"

typedef enum {
    EST_MODE_HOLD, /* hold reference_m */
    EST_MODE_LAND, /* descend; slow down near the ground, and fade the thrust out there */
    EST_MODE_SINK  /* descend without a height */
} est_mode_t;

typedef struct {
    float entry_hover_n; /* sure hover thrust at the start of the present descent */
    float ceiling_n;     /* upper limit of the thrust in a descent */
    float near_ground_s; /* time near the ground while landing, see touchdown.h */
    float entry_m;       /* height where the ceiling began */
    bool held;           /* the thrust had no effect in the cycle before */
    bool seen;           /* two mirrors agree on the heights: a landing has no ceiling */
} let_down_t;

/* What a cycle shows. */
typedef struct {
    float height_m;
    bool rocks;  /* the tilt moves as in flight */
    bool seen;   /* two mirrors agree on the heights */
    bool pushes; /* the thrust has an effect: no pilot holds it up, as far as known */
    float step_s;
} let_down_signs_t;

/* No descent: it stands on the ground. */
void let_down_reset(let_down_t *down);

/* No descent: it flies. hover_n: the sure hover thrust. */
void let_down_arm(let_down_t *down, float hover_n);

/* Vertical speed of a landing or of a descent without heights. */
float let_down_mps(est_mode_t mode, float height_m);

/* One cycle. */
void let_down_step(let_down_t *down, est_mode_t mode, const let_down_signs_t *signs);

/* The thrust within the limits of the mode. hover_n: the hover thrust of now. */
float let_down_limit_n(const let_down_t *down, est_mode_t mode, float thrust_n, float hover_n);

#endif
