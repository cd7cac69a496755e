/* The idle that keeps the motors turning. The autopilot's motors are started by its own stick command and may stop when
 * its throttle is under 10 %: between the pilot's hand-over and the take-off, and from one flight to the next, the firmware
 * then gives IDLE percent instead of none. The operator arms; nothing else does. Pure; the caller owns the state, all zero
 * at first. */
#ifndef CONTROL_ARMING_H
#define CONTROL_ARMING_H

#include <stdbool.h>
#include <stdint.h>

#include "control/supervisor.h"

typedef struct {
    bool armed;
    bool ending;            /* disarms on the ground */
    uint32_t sequence;      /* of the latest wish seen */
} arming_t;

/* One control cycle, after the supervisor's; before: the state that it was in until then. A wish to arm counts on the
 * ground alone; one to disarm there too, or when the vehicle is there again without a reference having come meanwhile. What
 * else disarms: CUT; on the ground a tilt or a silent link; a ground that was reached without heights. */
void arming_step(arming_t *arming, const flight_inputs_t *in, flight_state_t before, const supervisor_t *supervisor);

/* The least thrust, newtons per motor: the idle while armed, 0 else and in CUT. */
float arming_idle_n(const arming_t *arming, float idle_percent, flight_state_t state);

#endif
