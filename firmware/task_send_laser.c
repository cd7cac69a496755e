#include <stddef.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/alive.h"
#include "firmware/geometry.h"
#include "firmware/laser_port.h"
#include "firmware/mounting.h"
#include "bsp/led.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"
#include "bsp/timebase.h"

#define PERIOD_TICKS (SEND_LASER_PERIOD_MS / SEND_LASER_TICK_MS)
#define TICK_US (1000U * SEND_LASER_TICK_MS)

static Semaphore_Handle tick;
static uint16_t ticks; /* since the latest release */

/* Every 150 ms, and earlier where the driver wants it: what the scanner says changes that. */
static Void release(UArg unused)
{
    (void)unused;
    ++ticks;
    if (ticks < PERIOD_TICKS && TICK_US * (uint32_t)ticks < laser_port_pause_us()) {
        return;
    }
    ticks = 0U;
    monitor_released(MONITOR_SEND_LASER, bsp_time_us());
    Semaphore_post(tick);
}

/* Blinks at the pace of the period, also while steps are more frequent. */
static void show(urg_status_t status)
{
    const bool odd = (bsp_time_us() / (1000UL * SEND_LASER_PERIOD_MS)) % 2U != 0U;

    bsp_led_blue(status == URG_OK || odd);
    bsp_led_red(status == URG_LOST);
}

/* A copy in terms of the firmware: the driver's report is the driver's business, and longer. */
static void publish(const urg_report_t *urg)
{
    static laser_sample_t sample;

    sample.status = urg->status;
    sample.rate = urg->rate;
    sample.power_up_rate = urg->first_rate_known ? urg->first_rate : 0U;
    sample.restarts = urg->restarts;
    sample.timeouts = urg->timeouts;
    sample.seen = urg->seen;
    laser_server_write(&sample);
}

/* Each time, because the parameters may have changed. The driver compares, and does nothing when they
 * have not. */
static void order_rays(void)
{
    geometry_t geometry;

    geometry_mounted(&geometry);
    scip_range_t range = scip_layout_range(&geometry.layout, LASER_STREAM_RATE);
    laser_port_order(&range);
}

static Void task_send_laser(UArg unused0, UArg unused1)
{
    static laser_statistics_t statistics;

    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(tick, BIOS_WAIT_FOREVER);
        monitor_begin(MONITOR_SEND_LASER);
        order_rays();
        laser_port_step(&statistics);
        publish(&statistics.urg);
        show(statistics.urg.status);
        monitor_done(MONITOR_SEND_LASER);
        /* Also while no scanner answers: a missing sensor is no reason to reset the vehicle's computer
         * in the air. */
        alive_report(ALIVE_SEND_LASER);
    }
}

void task_send_laser_create(void)
{
    Task_Params task;
    Clock_Params clock;
    Semaphore_Params semaphore;

    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    tick = Semaphore_create(0, &semaphore, NULL);
    Clock_Params_init(&clock);
    ticks = 0U;
    clock.period = SEND_LASER_TICK_MS;
    clock.startFlag = TRUE;
    (void)Clock_create(release, SEND_LASER_TICK_MS, &clock, NULL);
    Task_Params_init(&task);
    task.instance->name = "TaskSendLaser";
    task.priority = TASK_SEND_LASER_PRIORITY;
    task.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_SEND_LASER, Task_create(task_send_laser, &task, NULL));
}
