#include "firmware/fault.h"

#include <stdbool.h>
#include <ti/sysbios/family/c28/Hwi.h>

#include "bsp/led.h"
#include "bsp/throttle.h"

/* No thrust. Whether this is right in the air is not asked any more: a program that does not know its
 * own state must not hold a vehicle up. */
void fault_make_safe(void)
{
    bsp_throttle_idle();
    bsp_led_red(true);
    bsp_led_blue(false);
}

static void stay_safe(void)
{
    (void)Hwi_disable();
    /* Again and again, until the watchdog resets the chip: whatever broke may still write to the pin's
     * registers. */
    for (;;) {
        fault_make_safe();
    }
}

/* An error of SYS/BIOS, for instance a stack that overflowed. */
Void fault_error(Error_Block *error)
{
    (void)error;
    stay_safe();
}

Void fault_abort(Void)
{
    stay_safe();
}

Void fault_exit(Int status)
{
    (void)status;
    stay_safe();
}

/* Driverlib's, by this very name: an argument that it does not know. */
void __error__(const char *file, uint32_t line)
{
    (void)file;
    (void)line;
    stay_safe();
}
