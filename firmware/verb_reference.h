/* Commands for the flight: `#SETR metres`, `#LAND`, `#STOP`. Context: Task, TaskReceiveComm only. Each
 * sends its answer and returns whether the line was valid. */
#ifndef FIRMWARE_VERB_REFERENCE_H
#define FIRMWARE_VERB_REFERENCE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* `#SETR metres`: 0 .. FLIGHT_REFERENCE_MAX_M above the terrain; 0 lands. The same value again is a new
 * command. */
bool verb_setr(answer_t *answer);

/* `#LAND` and `#STOP`: the same as `#SETR 0`. Characters after the name are ignored. */
bool verb_land(answer_t *answer);

/* Writes "OK SETR 0.6" with the value that was set last. The line is begun, but neither ended nor sent. */
void verb_reference_write_value(answer_t *answer);

#endif
