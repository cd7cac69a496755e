/* What the operator wants of the flight: `#SETR metres`, `#LAND`, `#STOP`. TaskReceiveComm only. */
#ifndef FIRMWARE_VERB_REFERENCE_H
#define FIRMWARE_VERB_REFERENCE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* `#SETR metres`: 0 .. FLIGHT_REFERENCE_MAX_M; 0 lands. The same value again is a new command. */
bool verb_setr(answer_t *answer);

/* `#LAND` and `#STOP`, whatever stands behind the name: as `#SETR 0`. */
bool verb_land(answer_t *answer);

/* "OK SETR 0.6", what was typed last: begun, neither ended nor sent. */
void verb_reference_write_value(answer_t *answer);

#endif
