/* Whose time it is, told by the hooks, on a clock of cycles that the test moves. The records outlive a test.
 */
#include "firmware/cpu_time.h"

#include "kernel.h"
#include "mock_timebase.h"
#include "unity.h"

#define TASKS (CPU_TIME_JOBS - CPU_TIME_TASK)

static uint32_t now;
static Task_Mode modes[CPU_TIME_JOBS + 1];
static char handles[CPU_TIME_JOBS];
static char idle, tick, clock_swi;

static uint32_t cycles(int calls)
{
    (void)calls;
    return now;
}

static Hwi_Handle hwi(cpu_time_job_t job)
{
    return (Hwi_Handle)(void *)&handles[job];
}

static Swi_Handle swi(cpu_time_job_t job)
{
    return (Swi_Handle)(void *)&handles[job];
}

static Task_Handle task(int number)
{
    return (Task_Handle)(void *)&handles[CPU_TIME_TASK + number];
}

static Task_Handle idle_task(void)
{
    return (Task_Handle)(void *)&idle;
}

static Task_Mode mode(Task_Handle handle, int calls)
{
    (void)calls;
    return handle == idle_task() ? Task_Mode_READY : modes[(char *)handle - handles];
}

/* From one task to another, the first of which waits or can go on. */
static void change(Task_Handle before, Task_Mode its_mode, Task_Handle next)
{
    if (before != idle_task()) {
        modes[(char *)before - handles] = its_mode;
    }
    cpu_time_task_switch(before, next);
}

static uint32_t longest(int job)
{
    return cpu_time_longest((cpu_time_job_t)job);
}

void setUp(void)
{
    kernel_reset();
    now = 0xFFFFFF00U; /* wraps on the way */
    bsp_time_cycles_Stub(cycles);
    Task_getMode_Stub(mode);
    for (int job = 0; job < CPU_TIME_JOBS; job++) {
        if (job != CPU_TIME_CLOCK && job != CPU_TIME_CLOCK_SWI) {
            cpu_time_watch((cpu_time_job_t)job, &handles[job]);
        }
    }
    cpu_time_task_switch(NULL, idle_task());
    for (int i = 0; i < TASKS; i++) { /* each begins anew */
        change(idle_task(), Task_Mode_READY, task(i));
        change(task(i), Task_Mode_BLOCKED, idle_task());
    }
    cpu_time_reset();
}

void tearDown(void)
{
    kernel_check();
}

void test_a_tasks_job_lasts_from_wait_to_wait_and_the_longest_is_kept(void)
{
    static const uint32_t work[] = {300U, 700U, 500U};

    for (int i = 0; i < 3; i++) {
        change(idle_task(), Task_Mode_READY, task(2));
        now += work[i];
        change(task(2), Task_Mode_BLOCKED, idle_task());
        now += 10000U;
    }
    TEST_ASSERT_EQUAL_UINT32(700, longest(CPU_TIME_TASK + 2));
    TEST_ASSERT_EQUAL_UINT32(0, longest(CPU_TIME_TASK + 1));
}

void test_what_preempts_a_task_is_not_its_own(void)
{
    change(idle_task(), Task_Mode_READY, task(3));
    now += 100U;
    change(task(3), Task_Mode_READY, task(0));
    now += 2000U;
    change(task(0), Task_Mode_BLOCKED, task(3));
    now += 30U;
    change(task(3), Task_Mode_BLOCKED, idle_task());
    TEST_ASSERT_EQUAL_UINT32(130, longest(CPU_TIME_TASK + 3));
    TEST_ASSERT_EQUAL_UINT32(2000, longest(CPU_TIME_TASK));
}

void test_interrupts_and_swis_nest_within_a_task_and_within_each_other(void)
{
    change(idle_task(), Task_Mode_READY, task(4));
    now += 1U;
    cpu_time_swi_begin(swi(CPU_TIME_XBEE_SWI));
    now += 10U;
    cpu_time_swi_begin(swi(CPU_TIME_LASER_SWI));
    now += 100U;
    cpu_time_hwi_begin(hwi(CPU_TIME_IMU_TRANSMIT));
    now += 1000U;
    cpu_time_hwi_begin((Hwi_Handle)(void *)&tick);
    now += 10000U;
    cpu_time_hwi_end((Hwi_Handle)(void *)&tick);
    now += 2000U;
    cpu_time_hwi_end(hwi(CPU_TIME_IMU_TRANSMIT));
    now += 200U;
    cpu_time_swi_end(swi(CPU_TIME_LASER_SWI));
    now += 20U;
    cpu_time_swi_end(swi(CPU_TIME_XBEE_SWI));
    now += 2U;
    change(task(4), Task_Mode_BLOCKED, idle_task());
    TEST_ASSERT_EQUAL_UINT32(10000, longest(CPU_TIME_CLOCK));
    TEST_ASSERT_EQUAL_UINT32(3000, longest(CPU_TIME_IMU_TRANSMIT));
    TEST_ASSERT_EQUAL_UINT32(300, longest(CPU_TIME_LASER_SWI));
    TEST_ASSERT_EQUAL_UINT32(30, longest(CPU_TIME_XBEE_SWI));
    TEST_ASSERT_EQUAL_UINT32(3, longest(CPU_TIME_TASK + 4));
}

void test_who_is_not_watched_is_the_kernels_and_two_of_them_count_as_one(void)
{
    cpu_time_swi_begin((Swi_Handle)(void *)&clock_swi);
    now += 7U;
    cpu_time_hwi_begin((Hwi_Handle)(void *)&tick);
    now += 40U;
    cpu_time_hwi_begin((Hwi_Handle)(void *)&idle);
    now += 5U;
    cpu_time_hwi_end((Hwi_Handle)(void *)&idle);
    now += 10U;
    cpu_time_hwi_end((Hwi_Handle)(void *)&tick);
    cpu_time_swi_end((Swi_Handle)(void *)&clock_swi);
    TEST_ASSERT_EQUAL_UINT32(55, longest(CPU_TIME_CLOCK));
    TEST_ASSERT_EQUAL_UINT32(7, longest(CPU_TIME_CLOCK_SWI));
}

void test_a_wait_at_a_gate_does_not_end_the_job(void)
{
    change(idle_task(), Task_Mode_READY, task(1));
    now += 50U;
    cpu_time_gate_asked();
    change(task(1), Task_Mode_BLOCKED, task(5));
    now += 4000U;
    change(task(5), Task_Mode_READY, task(1));
    cpu_time_gate_entered();
    now += 6U;
    TEST_ASSERT_EQUAL_UINT32(56, cpu_time_used());
    change(task(1), Task_Mode_BLOCKED, idle_task());
    TEST_ASSERT_EQUAL_UINT32(56, longest(CPU_TIME_TASK + 1));
}

void test_what_is_used_is_that_of_the_job_that_asks(void)
{
    change(idle_task(), Task_Mode_READY, task(1));
    now += 50U;
    cpu_time_hwi_begin(hwi(CPU_TIME_LASER_RECEIVE));
    now += 9U;
    TEST_ASSERT_EQUAL_UINT32(9, cpu_time_used());
    cpu_time_hwi_end(hwi(CPU_TIME_LASER_RECEIVE));
    TEST_ASSERT_EQUAL_UINT32(50, cpu_time_used());
    change(task(1), Task_Mode_BLOCKED, idle_task());
}

void test_reset_forgets_the_longest_and_not_the_job_in_hand(void)
{
    change(idle_task(), Task_Mode_READY, task(1));
    now += 50U;
    change(task(1), Task_Mode_BLOCKED, task(2));
    now += 30U;
    cpu_time_reset();
    TEST_ASSERT_EQUAL_UINT32(0, longest(CPU_TIME_TASK + 1));
    now += 3U;
    change(task(2), Task_Mode_BLOCKED, idle_task());
    TEST_ASSERT_EQUAL_UINT32(33, longest(CPU_TIME_TASK + 2));
}

void test_every_job_is_called_as_its_row_of_the_analysis(void)
{
    static const char *const names[CPU_TIME_JOBS] = {
        "Clock",        "SCIA_RX",        "SCIA_TX",          "SCIB_RX",     "SCIB_TX",
        "SCIC_RX",      "SCIC_TX",        "Clock_swi",        "IMU_SWI",     "Laser_SWI",
        "XBee_SWI",     "TaskIMU",        "TaskReceiveLaser", "TaskControl", "TaskSendLaser",
        "TaskSendComm", "TaskReceiveComm"};

    for (int job = 0; job < CPU_TIME_JOBS; job++) {
        TEST_ASSERT_EQUAL_STRING(names[job], cpu_time_name((cpu_time_job_t)job));
    }
}
