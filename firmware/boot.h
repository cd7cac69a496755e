/* How the firmware came to run, and what it remembers of the time before. */
#ifndef FIRMWARE_BOOT_H
#define FIRMWARE_BOOT_H

#include <stdbool.h>

#include "control/attitude.h"

/* After bsp_board_init(). main(), once. */
void boot_init(void);

/* "POWER" "PIN" "WATCHDOG" "NMI" "OTHER". */
const char *boot_cause(void);

/* A watchdog has reset the chip, so the vehicle may be in the air: sensors are up, and nothing may wait. */
bool boot_is_restart(void);

/* The attitude's offset, kept over a restart. TaskIMU. */
void boot_keep_offset(const attitude_t *offset);
/* False, and *offset untouched, unless this is a restart and one was kept. */
bool boot_kept_offset(attitude_t *offset);

#endif
