/* The monitor on a clock that the test moves. Its figures outlive a test; monitor_reset() is the first thing
 * each does. */
#include "firmware/monitor.h"

#include "kernel.h"
#include "mock_cpu_time.h"
#include "mock_timebase.h"
#include "unity.h"

static uint32_t now_us;
static uint32_t used; /* processor time of the task that calls */
static uint16_t resets;
static uint16_t watched;
static int at_gate;
static monitor_report_t report;

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

static uint32_t used_now(int calls)
{
    (void)calls;
    return used;
}

static void cpu_time_forgets(int calls)
{
    (void)calls;
    resets++;
}

static void watch(cpu_time_job_t job, const void *handle, int calls)
{
    (void)calls;
    (void)handle;
    watched |= (uint16_t)(1U << (job - CPU_TIME_TASK));
}

static void asked(int calls)
{
    (void)calls;
    at_gate++;
}

static void got(int calls)
{
    (void)calls;
    at_gate--;
}

/* A task's handle is only handed back. */
static Void stat(Task_Handle handle, Task_Stat *statbuf, int calls)
{
    (void)calls;
    statbuf->used = (SizeT)(uintptr_t)handle;
    statbuf->stackSize = 512U;
}

void setUp(void)
{
    kernel_reset();
    now_us = 0xFFFFF000U; /* wraps on the way */
    used = 0U;
    bsp_time_us_Stub(time_us);
    Task_stat_Stub(stat);
    cpu_time_used_Stub(used_now);
    cpu_time_reset_Stub(cpu_time_forgets);
    cpu_time_watch_Stub(watch);
    cpu_time_gate_asked_Stub(asked);
    cpu_time_gate_entered_Stub(got);
    at_gate = 0;
    for (uint16_t task = 0; task < MONITOR_TASKS; task++) {
        monitor_begin((monitor_task_t)task); /* takes a release that an earlier test has left */
    }
    monitor_reset();
}

void tearDown(void)
{
    kernel_check();
}

static void assert_report(monitor_task_t task, uint32_t longest_us, uint32_t late)
{
    monitor_report(task, &report);
    TEST_ASSERT_EQUAL_UINT32(longest_us, report.longest_us);
    TEST_ASSERT_EQUAL_UINT32(late, report.late);
}

static void job(monitor_task_t task, uint32_t delay_us, uint32_t work_us)
{
    monitor_released(task, now_us);
    now_us += delay_us;
    monitor_begin(task);
    now_us += work_us;
    monitor_done(task);
}

void test_a_response_goes_from_the_release_to_the_end_of_the_job(void)
{
    job(MONITOR_CONTROL, 300U, 700U);
    assert_report(MONITOR_CONTROL, 1000U, 0U);
}

void test_the_longest_response_stays(void)
{
    job(MONITOR_IMU, 300U, 700U);
    job(MONITOR_IMU, 1300U, 700U);
    job(MONITOR_IMU, 30U, 70U);
    assert_report(MONITOR_IMU, 2000U, 0U);
}

void test_every_task_has_its_own_figures_and_its_name(void)
{
    static const char *const names[MONITOR_TASKS] = {"TaskIMU",       "TaskReceiveLaser", "TaskControl",
                                                     "TaskSendLaser", "TaskSendComm",     "TaskReceiveComm"};

    for (uint32_t task = 0; task < MONITOR_TASKS; task++) {
        job((monitor_task_t)task, 0U, 100U + task);
    }
    for (uint32_t task = 0; task < MONITOR_TASKS; task++) {
        assert_report((monitor_task_t)task, 100U + task, 0U);
        TEST_ASSERT_EQUAL_STRING(names[task], report.name);
    }
}

/* The deadlines of the seed's Annex IV. */
void test_a_response_equal_to_the_deadline_is_in_time_and_one_microsecond_more_is_late(void)
{
    static const uint32_t deadlines_ms[MONITOR_TASKS] = {25U, 100U, 108U, 150U, 200U, 300U};

    for (uint32_t task = 0; task < MONITOR_TASKS; task++) {
        const uint32_t deadline_us = 1000U * deadlines_ms[task];

        job((monitor_task_t)task, 0U, deadline_us);
        assert_report((monitor_task_t)task, deadline_us, 0U);
        job((monitor_task_t)task, 1U, deadline_us);
        assert_report((monitor_task_t)task, deadline_us + 1U, 1U);
        job((monitor_task_t)task, 0U, deadline_us);
        assert_report((monitor_task_t)task, deadline_us + 1U, 1U);
    }
}

void test_a_deadline_may_change_from_job_to_job(void)
{
    monitor_set_deadline(MONITOR_CONTROL, 25000U);
    job(MONITOR_CONTROL, 0U, 25000U);
    assert_report(MONITOR_CONTROL, 25000U, 0U);
    job(MONITOR_CONTROL, 0U, 25001U);
    assert_report(MONITOR_CONTROL, 25001U, 1U);
    monitor_set_deadline(MONITOR_CONTROL, 108000U);
    job(MONITOR_CONTROL, 0U, 108000U);
    assert_report(MONITOR_CONTROL, 108000U, 1U);
}

void test_of_releases_before_the_job_begins_the_first_counts(void)
{
    monitor_released(MONITOR_SEND_COMM, now_us);
    now_us += 200000U;
    monitor_released(MONITOR_SEND_COMM, now_us);
    now_us += 50000U;
    monitor_begin(MONITOR_SEND_COMM);
    monitor_done(MONITOR_SEND_COMM);
    assert_report(MONITOR_SEND_COMM, 250000U, 1U);
}

void test_a_release_during_a_job_is_the_next_ones(void)
{
    monitor_released(MONITOR_IMU, now_us);
    monitor_begin(MONITOR_IMU);
    now_us += 24000U;
    monitor_released(MONITOR_IMU, now_us);
    now_us += 500U;
    monitor_done(MONITOR_IMU);
    assert_report(MONITOR_IMU, 24500U, 0U);
    monitor_begin(MONITOR_IMU);
    now_us += 25000U;
    monitor_done(MONITOR_IMU);
    assert_report(MONITOR_IMU, 25500U, 1U);
}

void test_a_job_without_a_release_counts_from_its_begin(void)
{
    now_us += 150000U; /* a time-out */
    monitor_begin(MONITOR_CONTROL);
    now_us += 400U;
    monitor_done(MONITOR_CONTROL);
    assert_report(MONITOR_CONTROL, 400U, 0U);
}

/* An access that waits for wait_us and works for hold cycles. */
static void access(uint32_t server, uint32_t wait_us, uint32_t hold)
{
    monitor_access_t access;

    monitor_asking((monitor_server_t)server, &access);
    TEST_ASSERT_EQUAL_INT(1, at_gate);
    now_us += wait_us;
    used += hold / 2U;
    monitor_entered((monitor_server_t)server, &access);
    TEST_ASSERT_EQUAL_INT(0, at_gate);
    access = monitor_leaving((monitor_server_t)server);
    used += hold - hold / 2U;
    monitor_left((monitor_server_t)server, &access);
}

void test_the_longest_wait_and_hold_are_kept_per_server(void)
{
    for (uint32_t server = 0; server < MONITOR_SERVERS; server++) {
        access(server, 10U + server, 100U);
        access(server, 2U, 1000U + server);
        access(server, 1U, 50U);
    }
    for (uint32_t server = 0; server < MONITOR_SERVERS; server++) {
        TEST_ASSERT_EQUAL_UINT32(10U + server, monitor_longest_wait_us((monitor_server_t)server));
        TEST_ASSERT_EQUAL_UINT32(1000U + server, monitor_longest_hold((monitor_server_t)server));
    }
}

/* The lower task holds the gate; the higher one waits, and its processor time is that of its switches too. */
void test_a_hold_behind_a_wait_does_not_count(void)
{
    monitor_access_t lower, higher;

    monitor_asking(MONITOR_ALTITUDE, &lower);
    monitor_entered(MONITOR_ALTITUDE, &lower);
    used = 5000U;
    monitor_asking(MONITOR_ALTITUDE, &higher);
    used = 40U;
    lower = monitor_leaving(MONITOR_ALTITUDE);
    monitor_left(MONITOR_ALTITUDE, &lower);
    used = 9000U;
    monitor_entered(MONITOR_ALTITUDE, &higher);
    higher = monitor_leaving(MONITOR_ALTITUDE);
    monitor_left(MONITOR_ALTITUDE, &higher);
    TEST_ASSERT_EQUAL_UINT32(40, monitor_longest_hold(MONITOR_ALTITUDE));
    access(MONITOR_ALTITUDE, 0U, 60U);
    TEST_ASSERT_EQUAL_UINT32(60, monitor_longest_hold(MONITOR_ALTITUDE));
}

void test_every_task_that_is_watched_is_measured(void)
{
    watched = 0U;
    for (uint16_t i = 0; i < MONITOR_TASKS; i++) {
        monitor_watch((monitor_task_t)i, NULL);
    }
    TEST_ASSERT_EQUAL_HEX16(0x3F, watched);
}

void test_reset_clears_responses_deadlines_and_waits(void)
{
    for (uint16_t task = 0; task < MONITOR_TASKS; task++) {
        job((monitor_task_t)task, 0U, 400000U);
    }
    for (uint16_t server = 0; server < MONITOR_SERVERS; server++) {
        access(server, 5U, 5U);
    }
    resets = 0U;
    monitor_reset();
    TEST_ASSERT_EQUAL_UINT16(1, resets);
    for (uint16_t task = 0; task < MONITOR_TASKS; task++) {
        assert_report((monitor_task_t)task, 0U, 0U);
    }
    for (uint16_t server = 0; server < MONITOR_SERVERS; server++) {
        TEST_ASSERT_EQUAL_UINT32(0, monitor_longest_wait_us((monitor_server_t)server));
        TEST_ASSERT_EQUAL_UINT32(0, monitor_longest_hold((monitor_server_t)server));
    }
    job(MONITOR_IMU, 1U, 2U);
    assert_report(MONITOR_IMU, 3U, 0U);
}

void test_a_reset_between_release_and_end_loses_nothing_of_that_job(void)
{
    monitor_released(MONITOR_IMU, now_us);
    now_us += 100U;
    monitor_begin(MONITOR_IMU);
    monitor_reset();
    now_us += 100U;
    monitor_done(MONITOR_IMU);
    assert_report(MONITOR_IMU, 200U, 0U);
}

void test_the_stack_is_that_of_the_watched_task(void)
{
    for (uintptr_t task = 0; task < MONITOR_TASKS; task++) {
        monitor_watch((monitor_task_t)task, (Task_Handle)(100U + task));
    }
    for (uint32_t task = 0; task < MONITOR_TASKS; task++) {
        monitor_report((monitor_task_t)task, &report);
        TEST_ASSERT_EQUAL_UINT32(100U + task, report.stack_used);
        TEST_ASSERT_EQUAL_UINT32(512, report.stack_size);
    }
}

void test_figures_are_read_and_cleared_with_interrupts_off(void)
{
    kernel.hwi.disabled = 0U;
    monitor_report(MONITOR_IMU, &report);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    monitor_reset();
    TEST_ASSERT_EQUAL_UINT16(2, kernel.hwi.disabled);
}
