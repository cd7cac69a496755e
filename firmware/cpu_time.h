/* Processor time of every job, without what interrupted it. SYS/BIOS tells by its hooks for which Hwi, Swi or
 * task the processor works (ccs_project/app.cfg names the hooks below); the time between two hooks belongs to
 * the job that the first one named. So every cycle belongs to some job: the context switch to a task to that
 * task, the dispatcher's own entry to a Hwi to the job that it interrupts. Times are in cycles of
 * BSP_CYCLE_NS.
 *
 * A task's job lasts from one wait to the next: a wait at a gate does not end it, and neither does one that
 * returns at once. */
#ifndef FIRMWARE_CPU_TIME_H
#define FIRMWARE_CPU_TIME_H

#include <stdint.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

/* A Hwi or Swi that nobody watches is the kernel's: its tick and its Clock Swi. */
typedef enum {
    CPU_TIME_CLOCK,
    CPU_TIME_LASER_RECEIVE, /* receive and transmit of each UART, in the order of bsp_uart_t */
    CPU_TIME_LASER_TRANSMIT,
    CPU_TIME_IMU_RECEIVE,
    CPU_TIME_IMU_TRANSMIT,
    CPU_TIME_XBEE_RECEIVE,
    CPU_TIME_XBEE_TRANSMIT,
    CPU_TIME_CLOCK_SWI,
    CPU_TIME_IMU_SWI,
    CPU_TIME_LASER_SWI,
    CPU_TIME_XBEE_SWI,
    CPU_TIME_TASK, /* the first of the tasks, in the order of monitor_task_t */
    CPU_TIME_JOBS = CPU_TIME_TASK + 6
} cpu_time_job_t;

/* The job has that Hwi_Handle, Swi_Handle or Task_Handle. main(). */
void cpu_time_watch(cpu_time_job_t job, const void *handle);

/* SYS/BIOS's hooks: the two of a Hwi with interrupts off, the others with interrupts on. */
Void cpu_time_hwi_begin(Hwi_Handle hwi);
Void cpu_time_hwi_end(Hwi_Handle hwi);
Void cpu_time_swi_begin(Swi_Handle swi);
Void cpu_time_swi_end(Swi_Handle swi);
Void cpu_time_task_switch(Task_Handle before, Task_Handle now);

/* What the calling job has used so far. Any context. */
uint32_t cpu_time_used(void);

/* Around a call that enters a gate: should the task have to wait there, its job goes on. Task. */
void cpu_time_gate_asked(void);
void cpu_time_gate_entered(void);

/* Longest job since power-up or cpu_time_reset(); 0: it never ended one. Any task. */
const char *cpu_time_name(cpu_time_job_t job);
uint32_t cpu_time_longest(cpu_time_job_t job);
void cpu_time_reset(void);

#endif
