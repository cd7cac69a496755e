/* Arming, idle thrust, and the order that a hand-over needs. The autopilot's motors are started by its own
 * stick command. They may stop when the throttle is below 10 %. So the firmware gives IDLE percent instead of
 * no thrust between the pilot's hand-over and the take-off, and between two flights.
 *
 * Only the operator arms. Without a reference, heights and tilt together show that a pilot flies. The tilt
 * alone shows it only after an #ARM, given since power-on and since the latest landing. Pure; the caller owns
 * the state, all zero at first. */
#ifndef CONTROL_ARMING_H
#define CONTROL_ARMING_H

#include <stdbool.h>
#include <stdint.h>

#include "control/where/supervisor.h"

typedef struct {
    bool armed;
    bool ending;       /* will disarm when the vehicle is on the ground */
    bool hands_over;   /* #ARM came since the vehicle stands: a hand-over may follow */
    uint32_t sequence; /* latest request that was processed */
} arming_t;

/* One control cycle, after the supervisor's step. before: the flight state before that step.
 *
 * A request to arm counts on the ground only. A request to disarm counts on the ground; in the air it
 * waits for the ground, unless a new reference comes before. These also disarm: state CUT; on the ground,
 * a tilt or a silent link; a DESCENDING (without heights) that has reached the ground. */
void arming_step(arming_t *arming, const flight_inputs_t *in, flight_state_t before,
                 const supervisor_t *supervisor);

/* #ARM lets the tilt alone tell a pilot's flight. */
static inline bool arming_hands_over(const arming_t *arming)
{
    return arming->hands_over;
}

/* Minimum thrust in newtons per motor: the idle while armed; 0 when not armed, and in CUT. idle_percent:
 * of the throttle's range. */
float arming_idle_n(const arming_t *arming, float idle_percent, flight_state_t state);

#endif
