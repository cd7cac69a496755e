/* Semaphores: counts, and who is served. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

static Void count_down(UArg a0, UArg a1)
{
    int count = 0;

    (void)a0;
    (void)a1;
    for (int i = 0; i < 5; i++) {
        Semaphore_post(sem);
        Semaphore_post(sem_b);
    }
    say("counts %d %d", (int)Semaphore_getCount(sem), (int)Semaphore_getCount(sem_b));
    while (Semaphore_pend(sem, BIOS_NO_WAIT)) {
        count++;
    }
    say("counting %d", count);
    for (count = 0; Semaphore_pend(sem_b, BIOS_NO_WAIT); count++) {
    }
    say("binary %d", count);
    Semaphore_reset(sem, 3);
    say("reset %d", (int)Semaphore_getCount(sem));
    Bool taken = Semaphore_pend(sem, 7);

    say("pend %u left %d", taken, (int)Semaphore_getCount(sem));
}

static int count_main(void)
{
    sem = semaphore(2, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_BINARY);
    (void)task("counter", 5, count_down);
    BIOS_start();
    return 0;
}

void test_counting_semaphores_count_and_binary_ones_stay_at_one(void)
{
    boot_and_run_ms(count_main, 1);
    TEST_ASSERT_EQUAL_STRING("counts 7 1@0 counting 7@0 binary 1@0 reset 3@0 pend 1 left 2@0 ", trace);
}

static Semaphore_Mode mode;

static Void post_four(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    UInt key = Task_disable();

    for (int i = 0; i < 4; i++) {
        Semaphore_post(sem);
        Semaphore_post(sem_b);
    }
    Task_restore(key);
}

static Void wait_once(UArg name, UArg delay)
{
    Task_sleep((UInt32)delay);
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("%s", (const char *)name);
}

static Void post_one_by_one(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    for (int i = 0; i < 4; i++) {
        Semaphore_post(sem);
        Task_sleep(1);
    }
}

static int served_main(void)
{
    static const char *const names[] = {"low1", "high1", "low2", "high2"};

    sem = semaphore(0, mode);
    for (UInt i = 0; i < 4; i++) { /* they begin to wait in this order, at ticks 1 to 4 */
        Task_Params params;

        Task_Params_init(&params);
        params.priority = i % 2 == 0 ? 2 : 4;
        params.arg0 = (UArg)names[i];
        params.arg1 = i + 1;
        (void)Task_create(wait_once, &params, NULL);
    }
    (void)task("poster", 9, post_one_by_one);
    BIOS_start();
    return 0;
}

TEST_CASE(0)
TEST_CASE(1)
void test_plain_semaphores_serve_the_longest_waiting_task(int m)
{
    mode = m == 0 ? Semaphore_Mode_COUNTING : Semaphore_Mode_BINARY;
    boot_and_run_ms(served_main, 20);
    TEST_ASSERT_EQUAL_STRING("low1@5000 high1@6000 low2@7000 high2@8000 ", trace);
}

TEST_CASE(0)
TEST_CASE(1)
void test_priority_semaphores_serve_the_highest_task_and_fifo_among_equals(int m)
{
    mode = m == 0 ? Semaphore_Mode_COUNTING_PRIORITY : Semaphore_Mode_BINARY_PRIORITY;
    boot_and_run_ms(served_main, 20);
    TEST_ASSERT_EQUAL_STRING("high1@5000 high2@6000 low1@7000 low2@8000 ", trace);
}

static int all_at_once_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("low", 2, sem);
    waiter("high", 4, sem);
    waiter("high_b", 4, sem_b);
    (void)task("poster", 9, post_four);
    BIOS_start();
    return 0;
}

/* Under Task_disable the posts go to the queues first (sem: low, high, then count 2), the tasks run
 * afterwards by priority: high was released before high_b; each finds the left counts. */
void test_posts_under_task_disable_release_first_and_run_afterwards(void)
{
    boot_and_run_ms(all_at_once_main, 10);
    TEST_ASSERT_EQUAL_STRING(
        "high@5000 high@5000 high@5000 high_b@5000 high_b@5000 high_b@5000 high_b@5000 low@5000 ", trace);
}
