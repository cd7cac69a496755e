#include "bsp/timebase.h"

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

static void ignore(int interrupt)
{
    (void)interrupt;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    SysCtl_disableWatchdog();
    timeline_move_to(5 * SIM_MS);
    (void)SysCtl_setClock(DEVICE_SETCLOCK_CFG); /* spoils the count of the timer in use */
    bsp_time_init();
}

void tearDown(void) {}

static void after(sim_time_t delay)
{
    timeline_move_to(5 * SIM_MS + delay);
}

void test_it_starts_at_zero_after_the_clocks_were_set(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_us());
}

void test_it_counts_whole_microseconds(void)
{
    after(999);
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_us());
    after(1000);
    TEST_ASSERT_EQUAL_UINT32(1, bsp_time_us());
    after(75 * SIM_S + 999);
    TEST_ASSERT_EQUAL_UINT32(75000000, bsp_time_us());
}

void test_it_wraps_after_two_to_the_32_microseconds(void)
{
    after(4294967295 * SIM_US);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFFU, bsp_time_us());
    after(4294967296 * SIM_US);
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_us());
    after(4294967296 * SIM_US + 10 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT32(10000, bsp_time_us());
}

void test_a_second_init_starts_over(void)
{
    after(SIM_S);
    bsp_time_init();
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_us());
    after(SIM_S + 7 * SIM_US);
    TEST_ASSERT_EQUAL_UINT32(7, bsp_time_us());
}

void test_cycles_of_5_ns_are_counted_and_wrap(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_cycles());
    after(1 * SIM_MS + 4);
    TEST_ASSERT_EQUAL_UINT32(SIM_MS / BSP_CYCLE_NS, bsp_time_cycles());
    after(SIM_S + 5);
    TEST_ASSERT_EQUAL_UINT32(200000001, bsp_time_cycles());
    after(4294967296 * 5 + 35);
    TEST_ASSERT_EQUAL_UINT32(7, bsp_time_cycles());
}
