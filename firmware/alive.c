#include "firmware/alive.h"

#include <stdint.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

#include "bsp/watchdog.h"

#define ALL ((uint16_t)((1U << ALIVE_COUNT) - 1U))

static uint16_t reported;

void alive_report(alive_t task)
{
    UInt key = Hwi_disable();

    reported = (uint16_t)(reported | (1U << task));
    if (reported == ALL) {
        reported = 0U;
        bsp_watchdog_service();
    }
    Hwi_restore(key);
}
