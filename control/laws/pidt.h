/* PID law in SI units, with real time steps. The derivative is that of the measured height, behind a low
 * pass of 8 Hz. The proportional part counts an error of at most 0.4 m, so that a climb from far can be
 * braked. Anti-windup: the integral stops while it would move the thrust further out of its window, and
 * beyond 0.4 m while the vehicle approaches. Newtons per motor. Pure; the caller owns the state. */
#ifndef CONTROL_PIDT_H
#define CONTROL_PIDT_H

#include <stdbool.h>

typedef struct {
    float kp_n_per_m;
    float ki_n_per_m_s;
    float kd_n_s_per_m;
    float gravity_n;
    float most_n, least_n; /* limits of the thrust */
} pidt_gains_t;

typedef struct {
    float integral_n;
    float height_m; /* previous height */
    float rate_mps; /* vertical speed, low-passed, > 0 is up */
    float peak_n;   /* largest action since it changed its sign */
    float swings;   /* leaky count of the large ones */
    bool primed;    /* height_m has a value */
} pidt_state_t;

void pidt_reset(pidt_state_t *state);

/* Clears the previous height only; the integral stays. */
void pidt_resume(pidt_state_t *state);

/* One sample with a new height, dt_s after the previous one. When dt_s is outside 0.02 .. 0.3 s, or not
 * primed, this sample has no derivative and is not integrated. Returns newtons per motor, within least_n
 * .. most_n. */
float pidt_step(pidt_state_t *state, const pidt_gains_t *gains, float reference_m, float height_m,
                float dt_s);

#endif
