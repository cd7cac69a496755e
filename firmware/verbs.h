/* The commands that are no parameters: one function a verb, one file a subject. Each sends its answers and returns
 * whether the line was valid. TaskReceiveComm only. */
#ifndef FIRMWARE_VERBS_H
#define FIRMWARE_VERBS_H

#include <stdbool.h>

#include "answer.h"

/* verb_laser.c: `#LASER`: state, rate, frames, errors by cause, last cause. */
bool verb_laser(answer_t *answer);

#endif
