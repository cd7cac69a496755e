#include "firmware/monitor.h"

#include <stdbool.h>
#include <ti/sysbios/family/c28/Hwi.h>

#include "firmware/schedule.h"
#include "bsp/timebase.h"

static const char *const names[] = {
    [MONITOR_IMU] = "TaskIMU",
    [MONITOR_RECEIVE_LASER] = "TaskReceiveLaser",
    [MONITOR_CONTROL] = "TaskControl",
    [MONITOR_SEND_LASER] = "TaskSendLaser",
    [MONITOR_SEND_COMM] = "TaskSendComm",
    [MONITOR_RECEIVE_COMM] = "TaskReceiveComm",
};
typedef char every_task_has_a_name[(sizeof names / sizeof names[0] == MONITOR_TASKS) ? 1 : -1];

static uint32_t deadlines_us[] = {
    [MONITOR_IMU] = TASK_IMU_DEADLINE_MS * 1000UL,
    [MONITOR_RECEIVE_LASER] = TASK_RECEIVE_LASER_DEADLINE_MS * 1000UL,
    [MONITOR_CONTROL] = TASK_CONTROL_DEADLINE_MS * 1000UL,
    [MONITOR_SEND_LASER] = TASK_SEND_LASER_DEADLINE_MS * 1000UL,
    [MONITOR_SEND_COMM] = TASK_SEND_COMM_DEADLINE_MS * 1000UL,
    [MONITOR_RECEIVE_COMM] = TASK_RECEIVE_COMM_DEADLINE_MS * 1000UL,
};
typedef char
    every_task_has_a_deadline[(sizeof deadlines_us / sizeof deadlines_us[0] == MONITOR_TASKS) ? 1 : -1];

typedef struct {
    Task_Handle handle;
    bool pending; /* released and not yet begun */
    uint32_t released_us;
    uint32_t begun_us; /* release of the job in hand */
    uint32_t longest_us;
    uint32_t late;
} record_t;

static record_t records[MONITOR_TASKS];
static uint32_t longest_wait_us[MONITOR_SERVERS];

void monitor_watch(monitor_task_t task, Task_Handle handle)
{
    records[task].handle = handle;
}

void monitor_released(monitor_task_t task, uint32_t when_us)
{
    record_t *record = &records[task];

    if (!record->pending) {
        record->released_us = when_us;
        record->pending = true;
    }
}

void monitor_set_deadline(monitor_task_t task, uint32_t deadline_us)
{
    deadlines_us[task] = deadline_us;
}

void monitor_begin(monitor_task_t task)
{
    record_t *record = &records[task];

    record->begun_us = record->pending ? record->released_us : bsp_time_us();
    record->pending = false;
}

void monitor_done(monitor_task_t task)
{
    record_t *record = &records[task];
    uint32_t response_us = bsp_time_us() - record->begun_us;

    if (response_us > record->longest_us) {
        record->longest_us = response_us;
    }
    if (response_us > deadlines_us[task]) {
        record->late++;
    }
}

void monitor_entered(monitor_server_t server, uint32_t asked_us)
{
    uint32_t wait_us = bsp_time_us() - asked_us;

    if (wait_us > longest_wait_us[server]) {
        longest_wait_us[server] = wait_us;
    }
}

void monitor_report(monitor_task_t task, monitor_report_t *report)
{
    Task_Stat stat;
    UInt key;

    Task_stat(records[task].handle, &stat);
    report->name = names[task];
    report->stack_used = (uint32_t)stat.used;
    report->stack_size = (uint32_t)stat.stackSize;
    key = Hwi_disable();
    report->longest_us = records[task].longest_us;
    report->late = records[task].late;
    Hwi_restore(key);
}

uint32_t monitor_longest_wait_us(monitor_server_t server)
{
    return longest_wait_us[server];
}

void monitor_reset(void)
{
    UInt key = Hwi_disable();
    uint16_t i;

    for (i = 0U; i < (uint16_t)MONITOR_TASKS; i++) {
        records[i].longest_us = 0U;
        records[i].late = 0U;
    }
    for (i = 0U; i < (uint16_t)MONITOR_SERVERS; i++) {
        longest_wait_us[i] = 0U;
    }
    Hwi_restore(key);
}
