#include "firmware/cpu_time.h"

#include <stdbool.h>
#include <stddef.h>

#include "bsp/timebase.h"

#define NOBODY CPU_TIME_JOBS /* the idle task, and main() before the kernel runs */

/* Those of Annex IV's table, so that `rta.py --measured` finds its rows. */
static const char *const names[] = {
    [CPU_TIME_CLOCK] = "Clock",
    [CPU_TIME_LASER_RECEIVE] = "SCIA_RX",
    [CPU_TIME_LASER_TRANSMIT] = "SCIA_TX",
    [CPU_TIME_IMU_RECEIVE] = "SCIB_RX",
    [CPU_TIME_IMU_TRANSMIT] = "SCIB_TX",
    [CPU_TIME_XBEE_RECEIVE] = "SCIC_RX",
    [CPU_TIME_XBEE_TRANSMIT] = "SCIC_TX",
    [CPU_TIME_CLOCK_SWI] = "Clock_swi",
    [CPU_TIME_IMU_SWI] = "IMU_SWI",
    [CPU_TIME_LASER_SWI] = "Laser_SWI",
    [CPU_TIME_XBEE_SWI] = "XBee_SWI",
    [CPU_TIME_TASK] = "TaskIMU",
    [CPU_TIME_TASK + 1] = "TaskReceiveLaser",
    [CPU_TIME_TASK + 2] = "TaskControl",
    [CPU_TIME_TASK + 3] = "TaskSendLaser",
    [CPU_TIME_TASK + 4] = "TaskSendComm",
    [CPU_TIME_TASK + 5] = "TaskReceiveComm",
};
typedef char every_job_has_a_name[(sizeof names / sizeof names[0] == CPU_TIME_JOBS) ? 1 : -1];

typedef struct {
    const void *handle;
    uint32_t used; /* by the job in hand */
    uint32_t longest;
    uint16_t depth; /* Hwi, Swi: begun so often and not ended */
    uint16_t below; /* whom it interrupted */
    bool at_gate;   /* task: a wait is one for a gate */
} record_t;

static record_t records[CPU_TIME_JOBS + 1];
static uint16_t current = NOBODY;
static uint32_t since; /* who is current has the processor from here on */

void cpu_time_watch(cpu_time_job_t job, const void *handle)
{
    records[job].handle = handle;
}

static uint16_t find(const void *handle, uint16_t first, uint16_t end, uint16_t unknown)
{

    for (uint16_t job = first; job < end; ++job) {
        if (records[job].handle == handle) {
            return job;
        }
    }
    return unknown;
}

/* Interrupts off. */
static void charge(void)
{
    const uint32_t now = bsp_time_cycles();

    records[current].used += now - since;
    since = now;
}

static void finish(record_t *record)
{
    if (record->used > record->longest) {
        record->longest = record->used;
    }
    record->used = 0U;
}

/* Two Hwis of the kernel's own may nest: they count as one. */
static void begin(uint16_t job)
{
    const UInt key = Hwi_disable();
    record_t *record = &records[job];

    charge();
    /* What it interrupted gets the processor back at its end. That need not be who was current when it
     * was posted. */
    if (record->depth == 0U) {
        record->used = 0U;
        record->below = current;
    }
    ++record->depth;
    current = job;
    Hwi_restore(key);
}

static void end(uint16_t job)
{
    const UInt key = Hwi_disable();
    record_t *record = &records[job];

    charge();
    --record->depth;
    if (record->depth == 0U) {
        finish(record);
        current = record->below;
    }
    Hwi_restore(key);
}

static uint16_t hwi_of(Hwi_Handle hwi)
{
    return find(hwi, CPU_TIME_LASER_RECEIVE, CPU_TIME_CLOCK_SWI, CPU_TIME_CLOCK);
}

static uint16_t swi_of(Swi_Handle swi)
{
    return find(swi, CPU_TIME_IMU_SWI, CPU_TIME_TASK, CPU_TIME_CLOCK_SWI);
}

Void cpu_time_hwi_begin(Hwi_Handle hwi)
{
    begin(hwi_of(hwi));
}

Void cpu_time_hwi_end(Hwi_Handle hwi)
{
    end(hwi_of(hwi));
}

Void cpu_time_swi_begin(Swi_Handle swi)
{
    begin(swi_of(swi));
}

Void cpu_time_swi_end(Swi_Handle swi)
{
    end(swi_of(swi));
}

static uint16_t task_of(Task_Handle task)
{
    return (task == NULL) ? NOBODY : find(task, CPU_TIME_TASK, CPU_TIME_JOBS, NOBODY);
}

Void cpu_time_task_switch(Task_Handle before, Task_Handle now)
{
    const UInt key = Hwi_disable();
    record_t *record = &records[task_of(before)];

    charge();
    /* A task that was preempted has not ended its job, and one that waits at a gate goes on behind it.
     * Only a wait for its next release ends the job. */
    if (before != NULL && Task_getMode(before) == Task_Mode_BLOCKED && !record->at_gate) {
        finish(record);
    }
    current = task_of(now);
    Hwi_restore(key);
}

/* The kernel calls the same hook for both waits, and does not say for which. */
void cpu_time_gate_asked(void)
{
    records[current].at_gate = true;
}

void cpu_time_gate_entered(void)
{
    records[current].at_gate = false;
}

uint32_t cpu_time_used(void)
{
    const UInt key = Hwi_disable();

    charge();
    const uint32_t used = records[current].used;
    Hwi_restore(key);
    return used;
}

const char *cpu_time_name(cpu_time_job_t job)
{
    return names[job];
}

uint32_t cpu_time_longest(cpu_time_job_t job)
{
    const UInt key = Hwi_disable();
    const uint32_t longest = records[job].longest;

    Hwi_restore(key);
    return longest;
}

/* What the jobs in hand have used stays: their next longest time would be too short otherwise. */
void cpu_time_reset(void)
{
    const UInt key = Hwi_disable();

    for (uint16_t job = 0U; job < (uint16_t)CPU_TIME_JOBS; ++job) {
        records[job].longest = 0U;
    }
    Hwi_restore(key);
}
