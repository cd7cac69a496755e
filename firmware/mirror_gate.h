/* Refuses a take-off when the mirrors do not show the ground that the vehicle stands on: one mirror against
 * another with LAYOUT THREE (control/sense/zeros.h), and the height with any (where/supervisor.h). Context:
 * Task, TaskReceiveComm only. */
#ifndef FIRMWARE_MIRROR_GATE_H
#define FIRMWARE_MIRROR_GATE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* Returns true on the ground when two mirrors are wrong. Then it has sent `ERR NAME two mirrors show no
 * ground, see #MIRRORS`. Otherwise sends nothing. The height is not asked: a pilot may take off with it. */
bool mirror_gate_refuses_arm(answer_t *answer);

/* The same when flight_mirrors_forbid() is true; by the height it sends `ERR NAME height shows no ground:
 * mirrors blocked, or past an edge`. */
bool mirror_gate_refuses_reference(answer_t *answer);

/* On the ground, when one mirror does not show it: appends ` (mirror FORE shows no ground, see #MIRRORS)`. */
void mirror_gate_remark(answer_t *answer);

/* Appends the names of these mirrors, bits by mirror_t: "FRONT+AFT"; "-": none. */
void mirror_gate_names(answer_t *answer, uint16_t mirrors);

#endif
