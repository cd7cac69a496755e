/* Tests whether the vehicle is on the ground. Some commands delay or bypass the control, so they are
 * allowed there only. Context: Task. */
#ifndef FIRMWARE_GROUND_H
#define FIRMWARE_GROUND_H

#include <stdbool.h>

/* True in state GROUND with no thrust and no reference. */
bool ground_idle(void);

/* True in state GROUND with no reference and with at most the idle thrust of armed motors. */
bool ground_waits(void);

/* True when the vehicle is probably in the air: in any state except GROUND and CUT. */
bool ground_left(void);

#endif
