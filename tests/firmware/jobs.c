#include "jobs.h"

#include <string.h>

#include "unity.h"

jobs_t jobs[MONITOR_TASKS];

static void watch(monitor_task_t task, Task_Handle handle, int calls)
{
    (void)calls;
    TEST_ASSERT_NOT_NULL(handle);
    TEST_ASSERT_NULL_MESSAGE(jobs[task].handle, "watched twice");
    jobs[task].handle = handle;
}

static void released(monitor_task_t task, uint32_t when_us, int calls)
{
    (void)calls;
    jobs[task].released++;
    jobs[task].released_us = when_us;
}

static void begin(monitor_task_t task, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(jobs[task].done, jobs[task].begun, "a job within a job");
    jobs[task].begun++;
}

static void done(monitor_task_t task, int calls)
{
    (void)calls;
    jobs[task].done++;
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(jobs[task].begun, jobs[task].done, "a job that was not begun");
}

static void set_deadline(monitor_task_t task, uint32_t deadline_us, int calls)
{
    (void)calls;
    jobs[task].deadline_us = deadline_us;
}

void jobs_reset(void)
{
    (void)memset(jobs, 0, sizeof jobs);
    monitor_watch_Stub(watch);
    monitor_released_Stub(released);
    monitor_set_deadline_Stub(set_deadline);
    monitor_begin_Stub(begin);
    monitor_done_Stub(done);
}

void jobs_assert(monitor_task_t task, uint16_t count)
{
    for (uint16_t i = 0; i < MONITOR_TASKS; i++) {
        const uint16_t expected = i == task ? count : 0U;

        TEST_ASSERT_EQUAL_UINT16(expected, jobs[i].begun);
        TEST_ASSERT_EQUAL_UINT16(expected, jobs[i].done);
        TEST_ASSERT_EQUAL(i == task, jobs[i].handle != NULL);
    }
}
