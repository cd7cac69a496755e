/* Software interrupts. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

static Void swi_low_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("low begins");
    Swi_post(swi_high);
    Swi_post(swi_high);
    say("low goes on");
}

static Void swi_mid_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("mid begins");
    Swi_post(swi_low);
    Swi_post(swi_low);
    Semaphore_post(sem);
    say("mid ends");
}

static Void swi_task(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("task");
    Swi_post(swi_mid);
    say("task goes on");
}

static int swi_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    swi_low = swi("low", 0, swi_low_function);
    swi_mid = swi("mid", 7, swi_mid_function);
    swi_high = swi("high", ~(0U), swi_high_function);
    (void)task("task", 5, swi_task);
    waiter("waiter", 9, sem);
    BIOS_start();
    return 0;
}

/* Twice posted before it begins is once run; the two posts of high are two runs, because the first had run
 * already. A task released by a Swi waits for all Swis. */
void test_swis_preempt_tasks_and_lower_swis_and_run_once_per_post(void)
{
    boot_and_run_ms(swi_main, 1);
    TEST_ASSERT_EQUAL_STRING(
        "task@0 mid begins@0 mid ends@0 low begins@0 high@0 high@0 low goes on@0 waiter@0 "
        "task goes on@0 ",
        trace);
}

static int runs;

static Void reposting(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("run");
    if (++runs < 3) {
        Swi_post(swi_low);
        Swi_post(swi_low);
        say("posted");
    }
}

static int repost_main(void)
{
    runs = 0;
    swi_low = swi("s", 3, reposting);
    swi_mid = swi("t", 3, equal_swi);
    Swi_post(swi_low);
    Swi_post(swi_mid);
    say("main");
    BIOS_start();
    return 0;
}

void test_a_swi_posted_while_it_runs_runs_again_behind_its_equals(void)
{
    boot_and_run_ms(repost_main, 1);
    TEST_ASSERT_EQUAL_STRING("main@0 run@0 posted@0 equal@0 run@0 posted@0 run@0 ", trace);
}

static Void lock_swis(UArg a0, UArg a1)
{
    UInt key = Swi_disable();
    UInt inner = Swi_disable();

    (void)a0;
    (void)a1;
    Swi_post(swi_high);
    Semaphore_post(sem);
    say("locked");
    kernel_raise(96);
    Swi_restore(inner); /* an interrupt goes through the lock at the next call */
    Semaphore_post(sem_b);
    say("still locked");
    Swi_restore(key);
    say("open");
}

static int lock_swis_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    swi_high = swi("high", 15, swi_high_function);
    hwi(96, hwi_function);
    waiter("waiter", 9, sem);
    (void)task("locker", 5, lock_swis);
    BIOS_start();
    return 0;
}

void test_swi_disable_holds_back_swis_and_tasks_but_not_hwis(void)
{
    boot_and_run_ms(lock_swis_main, 1);
    TEST_ASSERT_EQUAL_STRING("locked@0 hwi 96@0 still locked@0 high@0 waiter@0 open@0 ", trace);
}

static Void leaves_lock(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Swi_disable();
    say("key %u", Hwi_disable());
    Swi_post(swi_high);
    say("locked");
}

static Void post_again(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("task");
    Swi_post(swi_low);
}

static int leaves_lock_main(void)
{
    swi_low = swi("low", 1, leaves_lock);
    swi_high = swi("high", 9, swi_high_function);
    (void)task("task", 1, post_again);
    Swi_post(swi_low);
    BIOS_start();
    return 0;
}

void test_the_locks_that_a_swi_leaves_behind_end_with_it(void)
{
    boot_and_run_ms(leaves_lock_main, 1);
    TEST_ASSERT_EQUAL_STRING("key 0@0 locked@0 high@0 task@0 key 0@0 locked@0 high@0 ", trace);
}
