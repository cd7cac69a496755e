#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "bsp/timebase.h"
#include "firmware/commands.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "firmware/tasks.h"
#include "firmware/xbee_port.h"

/* A line is a job from the instant at which both it and the task were ready: what was being sent before it
 * is no part of its response. */
static uint32_t release_of(uint32_t arrival_us, uint32_t free_us)
{
    const uint32_t now_us = bsp_time_us();

    return (now_us - arrival_us < now_us - free_us) ? arrival_us : free_us;
}

static Void task_receive_comm(UArg unused0, UArg unused1)
{
    static xbee_message_t message;

    (void)unused0;
    (void)unused1;
    for (;;) {
        const uint32_t free_us = commands_continue();
        const uint16_t lost = xbee_port_wait(&message);

        monitor_released(MONITOR_RECEIVE_COMM, release_of(message.arrival_us, free_us));
        monitor_begin(MONITOR_RECEIVE_COMM);
        /* Before the line itself, because they came before it. */
        if (lost > 0U) {
            commands_report_lost(lost);
        }
        commands_execute(&message);
        monitor_done(MONITOR_RECEIVE_COMM);
    }
}

void task_receive_comm_create(void)
{
    Task_Params params;

    xbee_port_create();
    Task_Params_init(&params);
    params.instance->name = "TaskReceiveComm";
    params.priority = TASK_RECEIVE_COMM_PRIORITY;
    params.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_RECEIVE_COMM, Task_create(task_receive_comm, &params, NULL));
}
