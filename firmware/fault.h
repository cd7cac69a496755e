/* Handlers for every internal fault of the firmware: SYS/BIOS errors and failed asserts, stack overflows,
 * interrupts without a handler, a failed create, a return from main(), and driverlib's asserts in a build
 * with DEBUG.
 *
 * Each handler disables the interrupts and sets the throttle to the idle pulse, the red LED on and the
 * blue LED off. It repeats this until the watchdog resets the chip, 0.84 s later, so no task can raise the
 * thrust again. In the air the vehicle then falls, as with any loss of the firmware; the remedy is the
 * pilot's switch.
 *
 * Any context. The handlers do not use SYS/BIOS services, except to disable interrupts. They do not
 * return. The firmware does not call them: ccs_project/app.cfg registers them as Error.raiseHook,
 * System.abortFxn and System.exitFxn. */
#ifndef FIRMWARE_FAULT_H
#define FIRMWARE_FAULT_H

#include <stdint.h>
#include <xdc/runtime/Error.h>
#include <xdc/std.h>

/* The action that each handler repeats: idle pulse, red LED on, blue LED off. This function returns. */
void fault_make_safe(void);

Void fault_error(Error_Block *error);
Void fault_abort(Void);
Void fault_exit(Int status);

/* Declared as in driverlib's debug.h. */
void __error__(const char *file, uint32_t line);

#endif
