/* The seed's control law, per-sample semantics (seed document 4.2):
 *
 *   T = kp e + kd (e[k] - e[k-1]) + ki sum(e) + gravity
 *
 * clipped to [gravity - descension, gravity + ascension] and that window to the actuator's 0 .. 11.76 N. A sample that
 * would leave the window is not integrated: its action is made with the last integral action before it, then clipped.
 * Gains in N/mm per sample: no time enters.
 * The state holds the integral action, ki sum(e), and not the sum: a gain changed in flight changes how fast it moves,
 * not what it is. With ki = 0 it is 0. Pure; the caller owns the state. */
#ifndef CONTROL_PID_H
#define CONTROL_PID_H

#include <stdbool.h>

typedef struct {
    float kp_n_per_mm;
    float kd_n_per_mm;
    float ki_n_per_mm;      /* 0 makes it the PD law */
    float gravity_n;
    float ascension_n;      /* >= 0 */
    float descension_n;     /* >= 0 */
} pid_gains_t;

typedef struct {
    float integral_n;
    float last_error_mm;
    bool primed;            /* last_error_mm is from the previous sample; else the derivative of this one is 0 */
    bool saturated;         /* the latest sample was not integrated */
} pid_state_t;

/* No integral action, no previous error. */
void pid_reset(pid_state_t *state);

/* Forgets the previous error alone: the next sample has no derivative, after a pause in the samples. */
void pid_resume(pid_state_t *state);

/* One sample. error_mm = reference - height, finite. Returns newtons per motor. */
float pid_step(pid_state_t *state, const pid_gains_t *gains, float error_mm);

#endif
