/* The watchdog, on the chip model. */
#include "bsp/watchdog.h"

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define PERIOD (256 * 51200 * 64) /* 838.9 ms */

static int bites;

static void bite(void *unused)
{
    (void)unused;
    bites++;
    chip_restart();
    SysCtl_disableWatchdog(); /* as bsp_board_init() does first of all */
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void ignore(int interrupt)
{
    (void)interrupt;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_watchdog_connect(bite, NULL);
    SysCtl_disableWatchdog();
    bites = 0;
}

void tearDown(void) {}

void test_before_the_start_it_never_bites(void)
{
    run_until(100 * SIM_S);
    TEST_ASSERT_EQUAL_INT(0, bites);
}

void test_it_bites_0_84_s_after_the_start(void)
{
    run_until(5 * SIM_S);
    bsp_watchdog_start();
    run_until(5 * SIM_S + PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, bites);
    run_until(5 * SIM_S + PERIOD);
    TEST_ASSERT_EQUAL_INT(1, bites);
    TEST_ASSERT_INT_WITHIN(1000000, 838860800, PERIOD);
}

void test_a_service_gives_another_period(void)
{
    bsp_watchdog_start();
    for (int i = 1; i <= 100; i++) {
        run_until(i * (PERIOD - SIM_MS));
        bsp_watchdog_service();
    }
    TEST_ASSERT_EQUAL_INT(0, bites);
    run_until(timeline_now() + PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, bites);
    run_until(timeline_now() + 1);
    TEST_ASSERT_EQUAL_INT(1, bites);
}

void test_the_start_gives_a_whole_period_whatever_was_counted_before(void)
{
    SysCtl_enableWatchdog();
    run_until(13 * SIM_MS);
    bsp_watchdog_start();
    run_until(13 * SIM_MS + PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, bites);
}
