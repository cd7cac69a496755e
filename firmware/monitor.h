/* What the firmware measures of itself: per task the longest response and the deadlines missed, per server the longest
 * wait. A response goes from what releases the task to the end of its job. Times in microseconds. */
#ifndef FIRMWARE_MONITOR_H
#define FIRMWARE_MONITOR_H

#include <stdint.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

typedef enum {
    MONITOR_IMU,
    MONITOR_RECEIVE_LASER,
    MONITOR_CONTROL,
    MONITOR_SEND_LASER,
    MONITOR_SEND_COMM,
    MONITOR_RECEIVE_COMM,
    MONITOR_TASKS
} monitor_task_t;

typedef enum {
    MONITOR_ALTITUDE,
    MONITOR_IMU_SAMPLE,
    MONITOR_LASER_STATUS,
    MONITOR_REFERENCE,
    MONITOR_PARAMETERS,
    MONITOR_FLIGHT_STATUS,
    MONITOR_SERVERS
} monitor_server_t;

/* The task, for its stack. main(). */
void monitor_watch(monitor_task_t task, Task_Handle handle);

/* Released at that time. A release before the task's next monitor_begin() changes nothing. Any context, one per task. */
void monitor_released(monitor_task_t task, uint32_t when_us);
/* From now on that task has this deadline, from its release. By the task itself. */
void monitor_set_deadline(monitor_task_t task, uint32_t deadline_us);
/* By the task itself: after its wait (without a release before it, the job counts from here); at the end of its job. */
void monitor_begin(monitor_task_t task);
void monitor_done(monitor_task_t task);

/* A server was entered, asked for at that time. By the task that has just entered it. */
void monitor_entered(monitor_server_t server, uint32_t asked_us);

typedef struct {
    const char *name;
    uint32_t longest_us;
    uint32_t late;              /* deadlines missed */
    uint32_t stack_used;        /* most ever, in the kernel's units: 16-bit cells on the chip */
    uint32_t stack_size;
} monitor_report_t;

/* Since power-up or monitor_reset(); the stack's mark since power-up. Task. */
void monitor_report(monitor_task_t task, monitor_report_t *report);
uint32_t monitor_longest_wait_us(monitor_server_t server);
void monitor_reset(void);

#endif
