/* When nothing flies and nothing is about to: the time for what stalls or bypasses control. */
#ifndef FIRMWARE_GROUND_H
#define FIRMWARE_GROUND_H

#include <stdbool.h>

/* In GROUND with no thrust, and no reference is set. Task. */
bool ground_idle(void);

/* On the ground with no reference, be it that the armed motors idle. Task. */
bool ground_waits(void);

/* In the air, as far as is known: a state other than GROUND and CUT. Task. */
bool ground_left(void);

#endif
