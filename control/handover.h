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

/* Before the state of the cycle is known: doubts that came or went. May give up what was learned of the hover
 * thrust. */
void handover_doubts(handover_t *handover, est_law_t *est, where_t *where, const situation_t *now);

/* When it is known: an IMU that is back in flight, a height that is believed, the ground, a lift-off, a
 * pilot's turn and the news of it. May tell the first hover thrust and that contact has ended. trim_n: what
 * floating has added to the thrust. */
void handover_place(est_law_t *est, where_t *where, const situation_t *now, const flight_inputs_t *in,
                    pilot_news_t news, float trim_n);

/* The mode has changed. */
void handover_mode(est_law_t *est, where_t *where, const situation_t *now);

/* At the end of a cycle in a descent out of a pilot's hands: what the accelerometer has felt for long is
 * forgotten, because of its bias. A pilot's climbs and falls cancel. */
void handover_given_back(est_law_t *est, const situation_t *now);

#endif
