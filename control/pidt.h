/* The PID law in SI units: real time steps, derivative of the measured height behind a low pass of 8 Hz, and an integral
 * that stands still while it would push the thrust further out of its window. Newtons per motor. Pure; the caller owns
 * the state. */
#ifndef CONTROL_PIDT_H
#define CONTROL_PIDT_H

#include <stdbool.h>

typedef struct {
    float kp_n_per_m;
    float ki_n_per_m_s;
    float kd_n_s_per_m;
    float gravity_n;
    float most_n, least_n;  /* window of the thrust */
} pidt_gains_t;

typedef struct {
    float integral_n;
    float height_m;         /* previous */
    float rate_mps;         /* low-passed */
    bool primed;            /* height_m is known */
} pidt_state_t;

void pidt_reset(pidt_state_t *state);

/* Forgets the previous height alone. */
void pidt_resume(pidt_state_t *state);

/* One height, dt_s after the one before; outside 0.02 .. 0.5 s, or not primed, it has neither derivative nor integral. */
float pidt_step(pidt_state_t *state, const pidt_gains_t *gains, float reference_m, float height_m, float dt_s);

#endif
