/* Processor load and stack marks, as the firmware asks for them. */
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/utils/Load.h>

#include "sim/ti/sysbios/kernel.h"
#include "unity.h"

static const kernel_cost_t jobs[] = {{"worker", -1, 100 * SIM_MS}};
static const kernel_costs_t costs = {.jobs = jobs, .job_count = 1};

static Semaphore_Handle work;
static Task_Handle worker_task;
static Task_Handle waiting_task;

static __attribute__((noinline)) void dig_a_pit(void)
{
    volatile char pit[4096];

    for (size_t i = 0; i < sizeof pit; i++) {
        pit[i] = 1;
    }
}

static Void worker(UArg dig, UArg unused)
{
    (void)unused;
    for (;;) {
        (void)Semaphore_pend(work, BIOS_WAIT_FOREVER);
        if (dig > 0) {
            dig_a_pit();
        }
    }
}

static Void waits(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    (void)Semaphore_pend(Semaphore_create(0, NULL, NULL), BIOS_WAIT_FOREVER);
}

static Void post(UArg unused)
{
    (void)unused;
    Semaphore_post(work);
}

static UInt32 period;
static UArg depth;

static int boot_main(void)
{
    Task_Params task;
    Clock_Params clock;

    work = Semaphore_create(0, NULL, NULL);
    Task_Params_init(&task);
    task.instance->name = "worker";
    task.arg0 = depth;
    task.priority = 3;
    worker_task = Task_create(worker, &task, NULL);
    Task_Params_init(&task);
    task.priority = 1;
    waiting_task = Task_create(waits, &task, NULL);
    Clock_Params_init(&clock);
    clock.period = period;
    clock.startFlag = period > 0;
    (void)Clock_create(post, period > 0 ? period : 1, &clock, NULL);
    BIOS_start();
    return 0;
}

static void boot(UInt32 every_ms)
{
    period = every_ms;
    kernel_boot(boot_main, &costs);
}

static void run_ms(int ms)
{
    TEST_ASSERT_TRUE(kernel_run_until(timeline_now() + ms * SIM_MS));
}

void setUp(void)
{
    timeline_reset();
    depth = 0;
}

void tearDown(void) {}

void test_an_idle_processor_has_no_load(void)
{
    boot(0);
    run_ms(1600);
    TEST_ASSERT_EQUAL_UINT32(0, Load_getCPULoad());
}

void test_the_load_is_that_of_the_latest_whole_half_second(void)
{
    boot(250); /* 100 ms of 250 */
    run_ms(499);
    TEST_ASSERT_EQUAL_UINT32(0, Load_getCPULoad());
    run_ms(600);
    TEST_ASSERT_EQUAL_UINT32(40, Load_getCPULoad());
    run_ms(5000);
    TEST_ASSERT_EQUAL_UINT32(40, Load_getCPULoad());
}

void test_a_processor_that_is_never_idle_is_loaded_fully(void)
{
    boot(90);
    run_ms(2000);
    TEST_ASSERT_EQUAL_UINT32(100, Load_getCPULoad());
}

void test_a_boot_begins_a_new_measurement(void)
{
    boot(90);
    run_ms(1234);
    boot(0);
    TEST_ASSERT_EQUAL_UINT32(0, Load_getCPULoad());
    run_ms(501);
    TEST_ASSERT_EQUAL_UINT32(0, Load_getCPULoad());
}

void test_the_stacks_mark_is_the_most_that_was_used(void)
{
    Task_Stat shallow, before, after;

    depth = 1;
    boot(100);
    run_ms(50);
    Task_stat(worker_task, &before);
    run_ms(2000);
    Task_stat(worker_task, &after);
    Task_stat(waiting_task, &shallow);
    TEST_ASSERT_EQUAL_INT(3, after.priority);
    TEST_ASSERT_GREATER_THAN_UINT64(0, before.used);
    TEST_ASSERT_GREATER_THAN_UINT64(before.used + 3000U, after.used);
    TEST_ASSERT_LESS_THAN_UINT64(after.stackSize, after.used);
    TEST_ASSERT_LESS_THAN_UINT64(after.used, shallow.used);
}
