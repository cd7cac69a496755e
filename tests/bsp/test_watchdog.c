/* The watchdog and the cause of a reset, on the chip model. */
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

void tearDown(void)
{
}

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

void test_after_power_on_the_cause_is_power(void)
{
    TEST_ASSERT_EQUAL(BSP_RESET_POWER, bsp_reset_cause());
}

void test_after_a_bite_the_cause_is_the_watchdog_though_the_boot_rom_remembers_the_power_on(void)
{
    TEST_ASSERT_EQUAL(BSP_RESET_POWER, bsp_reset_cause());
    bsp_watchdog_start();
    run_until(PERIOD);
    TEST_ASSERT_EQUAL_INT(1, bites);
    TEST_ASSERT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
}

void test_the_cause_is_forgotten_once_it_was_told(void)
{
    bsp_watchdog_start();
    run_until(PERIOD);
    TEST_ASSERT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
    TEST_ASSERT_NOT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
}
