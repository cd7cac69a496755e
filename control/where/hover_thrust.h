/* The sure hover thrust: what is known of it from flight, slowly, and only while nothing is doubted. Every
 * bound of the thrust is counted from it. This file alone writes it.
 *
 * Newtons per motor, seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_WHERE_HOVER_THRUST_H
#define CONTROL_WHERE_HOVER_THRUST_H

#include <stdbool.h>

/* mass 20 % off; below the 2 N of law EST, because no law corrects it here */
#define HOVER_THRUST_MARGIN_N 1.5F

/* So far below it GRAV is trimmed: with GRAV at the hover thrust itself the seed's laws cannot come down, and
 * with this they fly best on the model (docs/operator.md). */
#define HOVER_THRUST_TRIM_N 0.4F
#define HOVER_TIME_S 2.5F /* chosen: a mean over the swings of the seed's law */

typedef struct {
    float thrust_n;  /* within 1.5 N of GRAV, and up to worn_n above that */
    float worn_n;    /* >= 0: what an emptying battery has moved that limit since the lift-off */
    bool learned;    /* learned in this flight; it stays valid while the pilot has the throttle */
    float learned_s; /* how long it has been learned, at most 2.5 s */
} hover_thrust_t;

/* What one cycle shows of it. */
typedef struct {
    float gravity_n; /* parameter GRAV */
    float step_s;    /* time since the cycle before */
    bool grounded;   /* on the ground, or the take-off has not left it: GRAV is all that is known */
    bool flies;      /* a command carries the vehicle */
    bool sees;       /* fresh heights, and neither they nor the thrust are doubted */
    bool teaches;    /* the heights have confirmed what the sensors show */
    bool estimated;  /* law EST has found estimated_n */
    float estimated_n;
    bool holds;     /* the thrust holds a height, so its mean is the hover thrust */
    float thrust_n; /* previous command */
} hover_lesson_t;

/* One cycle. The mean of law EST's estimate, or else of the thrust, with a time constant of 2.5 s at most; in
 * flight and while nothing is doubted. */
void hover_thrust_step(hover_thrust_t *hover, const hover_lesson_t *lesson);

/* A descent by heights has found that more_n more is needed. */
void hover_thrust_correct(hover_thrust_t *hover, float more_n);

/* The accelerometer is wrong: what was learned for a short time only may have been learned from it. */
void hover_thrust_distrust(hover_thrust_t *hover, float gravity_n);

/* The vehicle has left the ground with this hover thrust. */
void hover_thrust_lift_off(hover_thrust_t *hover, float thrust_n);

/* thrust_n as far as a hover thrust can be from GRAV: 1.5 N. */
float hover_thrust_near(float gravity_n, float thrust_n);

#endif
