/* Where every fault of the firmware itself ends: SYS/BIOS's errors and failed asserts, stack overflows, interrupts that
 * nobody serves, a failed create, a return from main(), driverlib's asserts in a build with DEBUG.
 *
 * Each of these turns interrupts off, makes the throttle pulse the idle one, lights the red LED, darkens the blue one, and
 * does so until the watchdog resets the chip, 0.84 s later: no task can raise the thrust meanwhile. In the air that lets
 * the vehicle fall, as any loss of the firmware does; the pilot's switch takes over. Any context; nothing of SYS/BIOS is
 * relied upon. None returns.
 *
 * Nobody in the firmware calls them: ccs_project/app.cfg names them as Error.raiseHook, System.abortFxn and
 * System.exitFxn. */
#ifndef FIRMWARE_FAULT_H
#define FIRMWARE_FAULT_H

#include <stdint.h>
#include <xdc/runtime/Error.h>
#include <xdc/std.h>

/* What each of them does over and over: idle pulse, red on, blue off. Returns. */
void fault_make_safe(void);

Void fault_error(Error_Block *error);
Void fault_abort(Void);
Void fault_exit(Int status);

/* As driverlib's debug.h declares it. */
void __error__(const char *file, uint32_t line);

#endif
