#include "dog.h"

#include <stddef.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"

static int bites;

static void bite(void *unused)
{
    (void)unused;
    bites++;
    chip_restart();
    SysCtl_disableWatchdog(); /* as bsp_board_init() does first of all */
}

static void ignore(int interrupt)
{
    (void)interrupt;
}

void dog_begin(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_watchdog_connect(bite, NULL);
    SysCtl_disableWatchdog();
    bites = 0;
}

void dog_run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

int dog_bites(void)
{
    return bites;
}
