/* What the estimate is told when something comes or goes: a doubt, the ground, a pilot, a mode. Nobody else
 * tells it anything but samples and commands.
 *
 * Newtons per motor. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_HANDOVER_H
#define CONTROL_HANDOVER_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight_io.h"
#include "control/situation.h"

typedef struct {
    uint16_t doubts; /* DOUBT_* of the previous cycle */
} handover_t;

/* The frames of this cycle carry the estimate to now. before: as the previous cycle left it. in: with the
 * frames that are believed. */
void handover_frames(est_law_t *est, const situation_t *before, const flight_inputs_t *in);

/* A height of this cycle, if there is one that is believed. */
void handover_height(est_law_t *est, const situation_t *now, const flight_inputs_t *in);

/* Doubts that came or went in this cycle. May give up what was learned of the hover thrust. */
void handover_doubts(handover_t *handover, est_law_t *est, where_t *where, const situation_t *now);

/* The IMU is back in flight: the estimate starts again. Call before the height of the cycle is fused. */
void handover_imu(est_law_t *est, const situation_t *now);

/* The ground, a pilot's turn and a lift-off. May tell the first hover thrust and that contact has ended. */
void handover_contact(est_law_t *est, where_t *where, const situation_t *now, bool has_throttle);

/* News of who has the throttle. trim_n: what floating has added to the thrust. */
void handover_pilot(est_law_t *est, where_t *where, const situation_t *now, pilot_news_t news, float trim_n);

/* The mode has changed. */
void handover_mode(est_law_t *est, where_t *where, const situation_t *now);

/* Law EST takes off: contact is told when its ramp has left the ground. Call before laws_step(). */
void handover_take_off(est_law_t *est, where_t *where, const situation_t *now);

/* The hover thrust of this cycle. */
void handover_hover(est_law_t *est, const situation_t *now);

/* At the end of a cycle in a descent out of a pilot's hands: what the accelerometer has felt for long is
 * forgotten, because of its bias. A pilot's climbs and falls cancel. */
void handover_given_back(est_law_t *est, const situation_t *now);

#endif
