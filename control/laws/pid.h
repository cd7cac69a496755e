/* The seed's control law, per sample (seed document 4.2):
 *
 *   T = kp e + kd (e[k] - e[k-1]) + ki sum(e) + gravity
 *
 * T is clipped to [gravity - descension, gravity + ascension], and this window to the actuator's 0 ..
 * 11.76 N. Anti-windup: a sample that would leave the window is not integrated. Its thrust uses the
 * integral action of the sample before, and is then clipped. Gains are in N/mm per sample; time is not
 * used.
 *
 * The state holds the integral action ki sum(e), not the sum. So a gain that changes in flight changes how
 * fast the action moves, and not the action itself. With ki = 0 the action is 0. Pure; the caller owns the
 * state. */
#ifndef CONTROL_PID_H
#define CONTROL_PID_H

#include <stdbool.h>

typedef struct {
    float kp_n_per_mm;
    float kd_n_per_mm;
    float ki_n_per_mm; /* 0 makes it the PD law */
    float gravity_n;
    float ascension_n;  /* >= 0 */
    float descension_n; /* >= 0 */
} pid_gains_t;

typedef struct {
    float integral_n;
    float last_error_mm;
    bool primed;    /* last_error_mm is from the previous sample; false: the next sample has no
                     * derivative */
    bool saturated; /* the latest sample was not integrated */
} pid_state_t;

/* Clears the integral action and the previous error. */
void pid_reset(pid_state_t *state);

/* Clears the previous error only. Use it after a pause in the samples: the next one has no derivative. */
void pid_resume(pid_state_t *state);

/* One sample. error_mm = reference - height, finite. Returns newtons per motor, clipped. */
float pid_step(pid_state_t *state, const pid_gains_t *gains, float error_mm);

#endif
