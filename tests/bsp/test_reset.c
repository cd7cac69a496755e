/* The cause of a reset, on the chip model. */
#include "bsp/reset.h"

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
