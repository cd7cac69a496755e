/* The mocked monitor: keeps what a task says of its jobs, and fails the test when a job ends that was not
 * begun or begins in another one. */
#ifndef TESTS_FIRMWARE_JOBS_H
#define TESTS_FIRMWARE_JOBS_H

#include <stdbool.h>
#include <stdint.h>

#include "mock_monitor.h"

typedef struct {
    Task_Handle handle;
    uint16_t released;    /* releases told */
    uint32_t released_us; /* the latest */
    uint32_t deadline_us; /* the latest told, 0: none */
    uint16_t begun;
    uint16_t done;
} jobs_t;

extern jobs_t jobs[MONITOR_TASKS];

/* From setUp. */
void jobs_reset(void);

/* Fails unless that task alone was watched and measured: `count` jobs, all done. */
void jobs_assert(monitor_task_t task, uint16_t count);

#endif
