/* Reads the pilot's throttle stick from the pulses of his receiver: where it is, and whether to believe it.
 * A short pulse is up, as for the autopilot (thrust.h): 1 ms is full throttle.
 *
 * What breaks: a receiver that repeats its last pulse. Nothing tells that from a hand that rests, so what a
 * stick may order is limited (stick_orders.h). Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_STICK_H
#define CONTROL_STICK_H

#include <stdbool.h>
#include <stdint.h>

#define STICK_PULSES 3U

typedef struct {
    float pulses_us[STICK_PULSES]; /* the latest, in no order */
    uint16_t next;                 /* where the next one goes */
    uint16_t count;                /* how many there are since it was silent, at most STICK_PULSES */
    float silence_s;               /* since the latest that was one */
    float wander_us;               /* mean change from pulse to pulse */
    bool noisy;
} stick_t;

/* One control cycle. came: a pulse was taken, pulse_us. One outside 0.8 .. 2.2 ms, or NaN, is none. step_s:
 * time since the cycle before. */
void stick_step(stick_t *stick, bool came, float pulse_us, float step_s);

/* It is to be believed: pulses come, and they do not jump about. */
bool stick_is_good(const stick_t *stick);

/* The median pulse. Only while it is good. */
float stick_pulse_us(const stick_t *stick);

/* Where it is: 1 is up, 0 the middle, -1 down; limited to these. middle_us: the pulse of the middle. Only
 * while it is good. */
float stick_up(const stick_t *stick, float middle_us);

#endif
