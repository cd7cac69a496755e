/* Waits that end by time. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

static Void sleeper(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(0);
    say("0");
    Task_sleep(1);
    say("1");
    Task_sleep(2);
    say("2");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); /* posted at 4500 us */
    say("posted");
    Task_sleep(1);
    say("1");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); /* at 5999 us */
    Task_sleep(3);
    say("3 ticks %lu", (unsigned long)Clock_getTicks());
}

static int sleep_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    hwi(96, post_sem);
    (void)task("sleeper", 5, sleeper);
    BIOS_start();
    return 0;
}

void test_a_sleep_of_n_ends_at_the_nth_tick_after_the_call(void)
{
    raise_at_us(4500, 96);
    raise_at_us(5999, 96);
    boot_and_run_ms(sleep_main, 20);
    TEST_ASSERT_EQUAL_STRING("0@0 1@1000 2@3000 posted@4500 1@5000 3 ticks 8@8000 ", trace);
}

static Void pender(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        say(Semaphore_pend(sem, 3) ? "got" : "timeout");
    }
}

static int pend_timeout_main(void)
{
    sem = semaphore(0, Semaphore_Mode_BINARY);
    hwi(96, post_sem);
    (void)task("pender", 5, pender);
    BIOS_start();
    return 0;
}

/* Waits of 3 ticks: 0-3, 3-5.5 (posted), 5.5-8, 8-11. At 11.0 the tick (38) and the post (96) fall together:
 * both Hwis run before the Clock Swi, so the post comes first; the time-out must not strike a second time.
 * 11-14. */
void test_a_pend_times_out_at_the_tick_unless_posted_before(void)
{
    raise_at_us(5500, 96);
    raise_at_us(11000, 96);
    boot_and_run_ms(pend_timeout_main, 14);
    TEST_ASSERT_EQUAL_STRING("timeout@3000 got@5500 timeout@8000 got@11000 timeout@14000 ", trace);
    TEST_ASSERT_EQUAL_INT(0, Semaphore_getCount(sem));
}

static Void longest_sleeper(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(65534);
    say("slept");
    say(Semaphore_pend(sem, 65534) ? "got" : "timeout");
}

static int longest_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    (void)task("sleeper", 5, longest_sleeper);
    BIOS_start();
    return 0;
}

void test_65534_ticks_is_the_longest_finite_wait(void)
{
    boot_and_run_ms(longest_main, 140000);
    TEST_ASSERT_EQUAL_STRING("slept@65534000 timeout@131068000 ", trace);
}

static Void sleeps_until_3(UArg name, UArg first)
{
    Task_sleep((UInt32)first);
    Task_sleep(3 - (UInt32)first);
    say("%s", (const char *)name);
}

static int equal_timeouts_main(void)
{
    static const char *const names[] = {"a", "b", "c"};
    static const UArg first[] = {1, 0, 2};

    for (int i = 0; i < 3; i++) {
        Task_Params params;

        Task_Params_init(&params);
        params.arg0 = (UArg)names[i];
        params.arg1 = first[i];
        (void)Task_create(sleeps_until_3, &params, NULL);
    }
    BIOS_start();
    return 0;
}

void test_equal_timeouts_release_equal_tasks_in_order_of_waiting(void)
{
    boot_and_run_ms(equal_timeouts_main, 5);
    TEST_ASSERT_EQUAL_STRING("b@3000 a@3000 c@3000 ", trace);
}
