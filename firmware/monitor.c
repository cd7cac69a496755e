#include "firmware/monitor.h"

#include <ti/sysbios/family/c28/Hwi.h>

#include "bsp/timebase.h"
#include "firmware/cpu_time.h"
#include "firmware/schedule.h"

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
typedef char every_task_has_a_processor_time[(CPU_TIME_JOBS - CPU_TIME_TASK == MONITOR_TASKS) ? 1 : -1];
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

typedef struct {
    bool held;
    monitor_access_t access; /* in force while it is held */
    uint32_t longest_wait_us;
    uint32_t longest_hold;
} gate_t;

static gate_t gates[MONITOR_SERVERS];

void monitor_watch(monitor_task_t task, Task_Handle handle)
{
    records[task].handle = handle;
    cpu_time_watch((cpu_time_job_t)(CPU_TIME_TASK + task), handle);
}

/* The first release counts. A task that is late is late since then, also when it was released again
 * meanwhile. */
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
        ++record->late;
    }
}

void monitor_asking(monitor_server_t server, monitor_access_t *access)
{
    access->asked_us = bsp_time_us();
    access->used = cpu_time_used();
    /* Asked before the gate is entered. Its answer may be old by one task switch: then a hold counts
     * that had to wait, which is too long and not too short. */
    access->contended = gates[server].held;
    cpu_time_gate_asked();
}

void monitor_entered(monitor_server_t server, const monitor_access_t *access)
{
    gate_t *gate = &gates[server];
    const uint32_t wait_us = bsp_time_us() - access->asked_us;

    cpu_time_gate_entered();
    gate->access = *access;
    gate->held = true;
    if (wait_us > gate->longest_wait_us) {
        gate->longest_wait_us = wait_us;
    }
}

/* A copy, because behind the gate the next task puts its own there. */
monitor_access_t monitor_leaving(monitor_server_t server)
{
    const monitor_access_t access = gates[server].access;

    gates[server].held = false;
    return access;
}

void monitor_left(monitor_server_t server, const monitor_access_t *access)
{
    const uint32_t hold = cpu_time_used() - access->used;
    /* Two tasks may have left the same gate one behind the other, and both compare here. */
    const UInt key = Hwi_disable();

    if (!access->contended && hold > gates[server].longest_hold) {
        gates[server].longest_hold = hold;
    }
    Hwi_restore(key);
}

/* Two of its numbers belong together. The kernel's look at the stack takes long and stands outside. */
void monitor_report(monitor_task_t task, monitor_report_t *report)
{
    Task_Stat stat;

    Task_stat(records[task].handle, &stat);
    report->name = names[task];
    report->stack_used = (uint32_t)stat.used;
    report->stack_size = (uint32_t)stat.stackSize;
    const UInt key = Hwi_disable();
    report->longest_us = records[task].longest_us;
    report->late = records[task].late;
    Hwi_restore(key);
}

uint32_t monitor_longest_wait_us(monitor_server_t server)
{
    return gates[server].longest_wait_us;
}

uint32_t monitor_longest_hold(monitor_server_t server)
{
    return gates[server].longest_hold;
}

void monitor_reset(void)
{
    UInt key = Hwi_disable();

    for (uint16_t i = 0U; i < (uint16_t)MONITOR_TASKS; ++i) {
        records[i].longest_us = 0U;
        records[i].late = 0U;
    }
    for (uint16_t i = 0U; i < (uint16_t)MONITOR_SERVERS; ++i) {
        gates[i].longest_wait_us = 0U;
        gates[i].longest_hold = 0U;
    }
    Hwi_restore(key);
    cpu_time_reset();
}
