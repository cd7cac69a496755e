/* A watchdog that bites, on the chip model. */
#ifndef TESTS_BSP_DOG_H
#define TESTS_BSP_DOG_H

#include "sim/timeline.h"

#define DOG_PERIOD (256 * 51200 * 64) /* 838.9 ms */

/* The chip anew, the watchdog off, no bite yet. */
void dog_begin(void);
void dog_run_until(sim_time_t end);
/* Since dog_begin(). */
int dog_bites(void);

#endif
