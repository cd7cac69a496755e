#include "firmware/fault.h"

#include <stdbool.h>
#include <ti/sysbios/family/c28/Hwi.h>

#include "bsp/led.h"
#include "bsp/throttle.h"

void fault_make_safe(void)
{
    bsp_throttle_idle();
    bsp_led_red(true);
    bsp_led_blue(false);
}

static void stay_safe(void)
{
    (void)Hwi_disable();
    for (;;) {
        fault_make_safe();
    }
}

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

void __error__(const char *file, uint32_t line)
{
    (void)file;
    (void)line;
    stay_safe();
}
