/* Clock objects. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

static int clock_main(void)
{
    (void)clock_object(clock_says, 3, 2, TRUE, (UArg) "periodic");
    (void)clock_object(clock_says, 3, 0, TRUE, (UArg) "once");
    (void)clock_object(clock_says, 1, 1, FALSE, (UArg) "never");
    BIOS_start();
    return 0;
}

void test_clock_functions_run_once_or_periodically_in_order_of_creation(void)
{
    boot_and_run_ms(clock_main, 7);
    TEST_ASSERT_EQUAL_STRING("periodic@3000 once@3000 periodic@5000 periodic@7000 ", trace);
}

static Void clock_driver(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    Clock_start(clk); /* 2 from now, then every 3: 7, 10 */
    Task_sleep(6);    /* 11 */
    Clock_start(clk); /* anew: 13 */
    Task_sleep(1);
    Clock_setPeriod(clk, 1); /* from the expiry at 13 on: 14, 15 */
    Task_sleep(3);           /* 15, behind the clock in the same tick */
    Clock_stop(clk);
    Clock_setTimeout(clk, 4);
    Clock_setPeriod(clk, 0);
    Task_sleep(5);    /* 20 */
    Clock_start(clk); /* 24 */
}

static int clock_control_main(void)
{
    clk = clock_object(clock_says, 2, 3, FALSE, (UArg) "tick");
    (void)task("driver", 1, clock_driver);
    BIOS_start();
    return 0;
}

void test_clocks_can_be_started_anew_stopped_and_changed(void)
{
    boot_and_run_ms(clock_control_main, 40);
    TEST_ASSERT_EQUAL_STRING("tick@7000 tick@10000 tick@13000 tick@14000 tick@15000 tick@24000 ", trace);
}

static int clock_main_start_main(void)
{
    clk = clock_object(clock_says, 65535, 0, FALSE, (UArg) "tick");
    Clock_start(clk);
    BIOS_start();
    return 0;
}

void test_a_clock_started_in_main_counts_from_bios_start(void)
{
    boot_and_run_ms(clock_main_start_main, 65534);
    TEST_ASSERT_EQUAL_STRING("", trace);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("tick@65535000 ", trace);
}

static Void clock_stops_itself(UArg unused)
{
    (void)unused;
    say("tick");
    Swi_post(swi_high);
    Semaphore_post(sem);
    say("ticks %lu", (unsigned long)Clock_getTicks());
    if (Clock_getTicks() == 4) {
        Clock_stop(clk);
    }
}

static int clock_self_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    swi_high = swi("high", 15, swi_high_function);
    waiter("task", 15, sem);
    clk = clock_object(clock_stops_itself, 2, 2, TRUE, 0);
    BIOS_start();
    return 0;
}

void test_clock_functions_run_at_the_highest_swi_priority_and_may_stop_themselves(void)
{
    boot_and_run_ms(clock_self_main, 10);
    TEST_ASSERT_EQUAL_STRING(
        "tick@2000 ticks 2@2000 high@2000 task@2000 tick@4000 ticks 4@4000 high@4000 task@4000 ", trace);
}
