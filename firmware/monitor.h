/* Run-time measurements. Per task: the longest response time and the missed deadlines. Per server: the
 * longest wait and the longest hold. A response time lasts from the release of the task to the end of its
 * job. Times are in microseconds. */
#ifndef FIRMWARE_MONITOR_H
#define FIRMWARE_MONITOR_H

#include <stdbool.h>
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

/* Registers the task, to measure its stack. main(). */
void monitor_watch(monitor_task_t task, Task_Handle handle);

/* The task was released at when_us. A second release before the task's next monitor_begin() changes
 * nothing. Any context, but only one context per task. */
void monitor_released(monitor_task_t task, uint32_t when_us);
/* Sets the task's deadline, counted from its release. Call from the task itself. */
void monitor_set_deadline(monitor_task_t task, uint32_t deadline_us);
/* Call from the task itself: monitor_begin() after its wait, monitor_done() at the end of its job. Without
 * a release before, the response time counts from monitor_begin(). */
void monitor_begin(monitor_task_t task);
void monitor_done(monitor_task_t task);

/* Measure the access to a server's gate. Call in this order: monitor_asking() before entering the gate,
 * monitor_entered() after it, monitor_leaving() before leaving, monitor_left() after it with the value that
 * monitor_leaving() returned. Any task, and main() before the tasks run. */
typedef struct {
    uint32_t asked_us;
    uint32_t used; /* processor time of the job so far, firmware/cpu_time.h */
    bool contended;
} monitor_access_t;
void monitor_asking(monitor_server_t server, monitor_access_t *access);
void monitor_entered(monitor_server_t server, const monitor_access_t *access);
monitor_access_t monitor_leaving(monitor_server_t server);
void monitor_left(monitor_server_t server, const monitor_access_t *access);

typedef struct {
    const char *name;
    uint32_t longest_us;
    uint32_t late;       /* missed deadlines */
    uint32_t stack_used; /* maximum so far, in the kernel's units: 16-bit cells on the chip */
    uint32_t stack_size;
} monitor_report_t;

/* Values since power-up or monitor_reset(); the stack's maximum always since power-up. Any task. */
void monitor_report(monitor_task_t task, monitor_report_t *report);
uint32_t monitor_longest_wait_us(monitor_server_t server);
/* Longest processor time from entering a gate to having left it, in cycles of BSP_CYCLE_NS. An access that
 * had to wait does not count, because its time contains task switches. */
uint32_t monitor_longest_hold(monitor_server_t server);
void monitor_reset(void);

#endif
