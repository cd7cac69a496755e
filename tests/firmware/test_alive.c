/* The watchdog is serviced when every watched task has completed a cycle, and not before. */
#include "firmware/alive.h"

#include <setjmp.h>

#include "kernel.h"
#include "mock_watchdog.h"
#include "unity.h"

static uint16_t services;
static uint16_t sleeps;
static bool hung;
static jmp_buf out;

static void service(int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, kernel.hwi.depth, "a task may come between");
    services++;
}

void setUp(void)
{
    kernel_reset();
    services = 0U;
    bsp_watchdog_service_Stub(service);
}

/* The flags outlive a test: leave none. */
void tearDown(void)
{
    uint16_t before = services;

    if (hung) {
        return; /* for ever: the last test */
    }
    alive_report(ALIVE_CONTROL);
    if (services == before) {
        alive_report(ALIVE_SEND_LASER);
    }
    kernel_check();
}

void test_one_task_alone_never_services_the_watchdog(void)
{
    for (uint16_t n = 0; n < 1000U; n++) {
        alive_report(ALIVE_CONTROL);
    }
    TEST_ASSERT_EQUAL_UINT16(0, services);
}

void test_nor_does_the_other(void)
{
    for (uint16_t n = 0; n < 1000U; n++) {
        alive_report(ALIVE_SEND_LASER);
    }
    TEST_ASSERT_EQUAL_UINT16(0, services);
}

void test_both_together_service_it_once_and_begin_anew(void)
{
    for (uint16_t n = 1; n <= 5U; n++) {
        alive_report(ALIVE_CONTROL);
        TEST_ASSERT_EQUAL_UINT16(n - 1U, services);
        alive_report(ALIVE_SEND_LASER);
        TEST_ASSERT_EQUAL_UINT16(n, services);
    }
}

void test_their_order_does_not_matter(void)
{
    alive_report(ALIVE_SEND_LASER);
    alive_report(ALIVE_SEND_LASER);
    alive_report(ALIVE_CONTROL);
    TEST_ASSERT_EQUAL_UINT16(1, services);
}

void test_a_task_that_stops_stops_the_services_after_at_most_one_more(void)
{
    alive_report(ALIVE_CONTROL);
    alive_report(ALIVE_SEND_LASER);
    alive_report(ALIVE_CONTROL); /* its last cycle */
    for (uint16_t n = 0; n < 100U; n++) {
        alive_report(ALIVE_SEND_LASER);
    }
    TEST_ASSERT_EQUAL_UINT16(2, services);
}

static Void sleep(UInt32 ticks, int calls)
{
    (void)calls;
    TEST_ASSERT_GREATER_THAN_UINT32(0, ticks);
    sleeps++;
    if (sleeps == 50U) {
        longjmp(out, 1);
    }
}

/* The last test: what hangs, hangs. */
void test_z_a_task_that_is_made_to_hang_never_comes_back_and_the_other_one_alone_services_nothing(void)
{
    Task_sleep_Stub(sleep);
    hung = true;
    alive_hang();
    if (setjmp(out) == 0) {
        alive_report(ALIVE_SEND_LASER);
        TEST_FAIL_MESSAGE("came back");
    }
    TEST_ASSERT_EQUAL_UINT16(50, sleeps);
    alive_report(ALIVE_CONTROL);
    alive_report(ALIVE_CONTROL);
    TEST_ASSERT_EQUAL_UINT16(0, services);
}
