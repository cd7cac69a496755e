/* Why the firmware was reset, and the data that it keeps over a reset. */
#ifndef FIRMWARE_BOOT_H
#define FIRMWARE_BOOT_H

#include <stdbool.h>

#include "control/attitude.h"

/* Call once in main(), after bsp_board_init(). */
void boot_init(void);

/* Cause of the reset: "POWER", "PIN", "WATCHDOG", "NMI" or "OTHER". Zero-terminated, static. Any context. */
const char *boot_cause(void);

/* True when the watchdog has reset the chip. Then the vehicle may be in the air, the sensors already run,
 * and nothing may wait. */
bool boot_is_restart(void);

/* Stores the offset of the angles, so that it survives a restart. TaskIMU. */
void boot_keep_offset(const attitude_t *offset);
/* Reads the stored offset. Returns false, and does not write *offset, when this is not a restart or no
 * offset was stored. TaskIMU. */
bool boot_kept_offset(attitude_t *offset);

#endif
