#include "firmware/alive.h"

#include <stdbool.h>
#include <stdint.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "bsp/watchdog.h"

#define ALL ((uint16_t)((1U << ALIVE_COUNT) - 1U))

#define HANG_TICKS 1000U

static uint16_t reported;
static bool hangs;

void alive_hang(void)
{
    hangs = true;
}

/* Serviced by whoever completes the set, not by a task of its own: such a task would go on while the
 * two hang. The watchdog then bites within its time-out after either of them stops. */
void alive_report(alive_t task)
{

    /* It sleeps and does not spin: a spinning task of this priority would starve the tasks below it,
     * and the test would show that instead of the watchdog. */
    while (hangs && task == ALIVE_SEND_LASER) {
        Task_sleep(HANG_TICKS);
    }
    const UInt key = Hwi_disable();

    reported = (uint16_t)(reported | (1U << task));
    if (reported == ALL) {
        reported = 0U;
        bsp_watchdog_service();
    }
    Hwi_restore(key);
}
