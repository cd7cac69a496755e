#include <math.h>
#include <stddef.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/boot.h"
#include "firmware/monitor.h"
#include "firmware/pulse_stream.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"
#include "firmware/published.h"
#include "bsp/timebase.h"
#include "firmware/xbee_port.h"

static Semaphore_Handle tick;

static Void release(UArg unused)
{
    (void)unused;
    monitor_released(MONITOR_SEND_COMM, bsp_time_us());
    Semaphore_post(tick);
}

/* The line tells one of reset, doubt and limit: with two of them it might not fit one packet. The flags tell
 * a doubt too, and the recorder all three. */
static void report(telemetry_line_t *line, const char *reset)
{
    laser_sample_t laser;
    published_t now = {.age_us = NAN, .roll_rad = NAN, .pitch_rad = NAN, .up_mps2 = NAN};

    laser_server_read(&laser);
    flight_status_server_read(&now.flight);
    /* As the supervisor sees it: a height that it does not count must not look like one on the
     * operator's screen. */
    now.height_mm = ((now.flight.flags & FLIGHT_FLAG_HEIGHT) == 0U) ? now.flight.height_mm : NAN;
    now.laser = urg_status_name(laser.status);
    if (reset != NULL) {
        now.reset = reset;
    } else if (now.flight.rule != VERDICT_NONE) {
        now.doubt = rules_name(now.flight.rule);
    } else if (now.flight.bound != BOUND_NONE && now.flight.state != FLIGHT_GROUND) {
        now.limit = bound_name(now.flight.bound);
    }
    published_telemetry(line, &now);
}

static Void task_send_comm(UArg unused0, UArg unused1)
{
    static telemetry_line_t line;
    const char *reset = boot_cause();

    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(tick, BIOS_WAIT_FOREVER);
        monitor_begin(MONITOR_SEND_COMM);
        report(&line, reset);
        /* Both would not fit the radio's 9600 bit/s, and the operator asked for the pulses. */
        if (!pulse_stream_on()) {
            xbee_port_report(&line);
        }
        /* Told once, by the first line: whoever looks later has it by #PERF. */
        reset = NULL;
        monitor_done(MONITOR_SEND_COMM);
    }
}

void task_send_comm_create(void)
{
    Task_Params task;
    Clock_Params clock;
    Semaphore_Params semaphore;

    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    tick = Semaphore_create(0, &semaphore, NULL);
    Clock_Params_init(&clock);
    clock.period = SEND_COMM_PERIOD_MS;
    clock.startFlag = TRUE;
    (void)Clock_create(release, SEND_COMM_PERIOD_MS, &clock, NULL);
    Task_Params_init(&task);
    task.instance->name = "TaskSendComm";
    task.priority = TASK_SEND_COMM_PRIORITY;
    task.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_SEND_COMM, Task_create(task_send_comm, &task, NULL));
}
