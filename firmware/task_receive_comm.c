#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/commands.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "firmware/tasks.h"
#include "firmware/xbee_port.h"

static Void task_receive_comm(UArg unused0, UArg unused1)
{
    static xbee_message_t message;

    (void)unused0;
    (void)unused1;
    for (;;) {
        const bool waited = commands_continue();
        const uint16_t lost = xbee_port_wait(&message);

        if (!waited) {
            monitor_released(MONITOR_RECEIVE_COMM, message.arrival_us);
        }
        monitor_begin(MONITOR_RECEIVE_COMM);
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
