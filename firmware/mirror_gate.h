/* Refuses a take-off when the mirrors do not show the ground that the vehicle stands on
 * (control/sense/zeros.h), with LAYOUT THREE. Context: Task, TaskReceiveComm only. */
#ifndef FIRMWARE_MIRROR_GATE_H
#define FIRMWARE_MIRROR_GATE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* Returns true on the ground when flight_mirrors_forbid() is true. Then it has sent `ERR NAME two mirrors
 * show no ground, see #MIRRORS`. Otherwise sends nothing. */
bool mirror_gate_refuses(answer_t *answer);

/* On the ground, when one mirror does not show it: appends ` (mirror FORE shows no ground, see #MIRRORS)`. */
void mirror_gate_remark(answer_t *answer);

/* Appends the names of these mirrors, bits by mirror_t: "FRONT+AFT"; "-": none. */
void mirror_gate_names(answer_t *answer, uint16_t mirrors);

#endif
