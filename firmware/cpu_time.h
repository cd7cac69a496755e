/* Measures the processor time of every job, without the time of what interrupts it. SYS/BIOS calls the hooks
 * below (registered in ccs_project/app.cfg) when a Hwi, Swi or task begins or ends. The time between two
 * hooks counts for the job that the first hook named. So every cycle counts for one job. A context switch
 * counts for the new task. The dispatcher's entry to a Hwi counts for the interrupted job. Times are in
 * cycles of BSP_CYCLE_NS.
 *
 * A job of a task lasts from one wait to the next. Two waits do not end it: a wait for a gate, and a wait
 * that returns at once. */
#ifndef FIRMWARE_CPU_TIME_H
#define FIRMWARE_CPU_TIME_H

#include <stdint.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

/* A Hwi or Swi that is not registered counts as the kernel's: its tick, its Clock Swi. */
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

/* Registers the Hwi_Handle, Swi_Handle or Task_Handle of a job. main(). */
void cpu_time_watch(cpu_time_job_t job, const void *handle);

/* Hooks, called by SYS/BIOS only: the two of a Hwi with interrupts disabled, the others with interrupts
 * enabled. */
Void cpu_time_hwi_begin(Hwi_Handle hwi);
Void cpu_time_hwi_end(Hwi_Handle hwi);
Void cpu_time_swi_begin(Swi_Handle swi);
Void cpu_time_swi_end(Swi_Handle swi);
Void cpu_time_task_switch(Task_Handle before, Task_Handle now);

/* Processor time that the calling job has used so far. Any context. */
uint32_t cpu_time_used(void);

/* Call before and after entering a gate. If the task waits there, its job continues. Task. */
void cpu_time_gate_asked(void);
void cpu_time_gate_entered(void);

/* Name of a job; its longest time since power-up or cpu_time_reset(), 0: none has ended; and the reset of all
 * longest times. Any task. */
const char *cpu_time_name(cpu_time_job_t job);
uint32_t cpu_time_longest(cpu_time_job_t job);
void cpu_time_reset(void);

#endif
