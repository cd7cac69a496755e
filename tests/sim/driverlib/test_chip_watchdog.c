/* The chip model's watchdog and causes of reset: counts of 512 periods of 10 MHz (51.2 us), prescaler 1 to
 * 64, 256 to go. */
#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define PERIOD_1 (256 * 51200)

static int bites;
static sim_time_t bitten_at;
static int context;

static void bite(void *argument)
{
    TEST_ASSERT_EQUAL_PTR(&context, argument);
    bites++;
    bitten_at = timeline_now();
}

static void ignore(int interrupt)
{
    (void)interrupt;
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_watchdog_connect(bite, &context);
    bites = 0;
}

void tearDown(void) {}

void test_it_counts_from_reset_on_and_bites_after_13_ms(void)
{
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT(1, bites);
    TEST_ASSERT_EQUAL_INT64(13107200, bitten_at); /* TI: 13.1 ms */
}

void test_disabled_it_rests_and_counts_on_from_there(void)
{
    run_until(10 * SIM_MS);
    SysCtl_disableWatchdog();
    TEST_ASSERT_EQUAL_HEX32(0x40, chip_register("WDCR"));
    run_until(10 * SIM_S);
    TEST_ASSERT_EQUAL_INT(0, bites);
    SysCtl_enableWatchdog();
    TEST_ASSERT_EQUAL_HEX32(0, chip_register("WDCR"));
    run_until(20 * SIM_S);
    TEST_ASSERT_INT_WITHIN(51200, 10 * SIM_S + PERIOD_1 - 10 * SIM_MS, bitten_at);
}

void test_every_prescaler_has_its_period(void)
{
    static const SysCtl_WDPrescaler prescalers[] = {
        SYSCTL_WD_PRESCALE_1,  SYSCTL_WD_PRESCALE_2,  SYSCTL_WD_PRESCALE_4, SYSCTL_WD_PRESCALE_8,
        SYSCTL_WD_PRESCALE_16, SYSCTL_WD_PRESCALE_32, SYSCTL_WD_PRESCALE_64};

    for (int i = 0; i < 7; i++) {
        setUp();
        SysCtl_setWatchdogPrescaler(prescalers[i]);
        SysCtl_serviceWatchdog();
        TEST_ASSERT_EQUAL_HEX32(prescalers[i], chip_register("WDCR"));
        run_until(100 * SIM_S);
        TEST_ASSERT_EQUAL_INT64((sim_time_t)PERIOD_1 << i, bitten_at);
    }
}

void test_a_new_prescaler_keeps_the_count(void)
{
    run_until(PERIOD_1 / 2);
    SysCtl_setWatchdogPrescaler(SYSCTL_WD_PRESCALE_64);
    run_until(100 * SIM_S);
    TEST_ASSERT_EQUAL_INT64(PERIOD_1 / 2 + 32 * (sim_time_t)PERIOD_1, bitten_at);
}

void test_a_service_begins_the_count_anew(void)
{
    for (int i = 1; i < 50; i++) {
        run_until(i * 13 * SIM_MS);
        SysCtl_serviceWatchdog();
    }
    TEST_ASSERT_EQUAL_INT(0, bites);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT64(49 * 13 * SIM_MS + PERIOD_1, bitten_at);
}

void test_a_service_while_disabled_starts_nothing(void)
{
    SysCtl_disableWatchdog();
    SysCtl_serviceWatchdog();
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT(0, bites);
}

void test_power_on_sets_two_causes_that_the_boot_rom_notes(void)
{
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_POR | SYSCTL_CAUSE_XRS, SysCtl_getResetCause());
    SysCtl_clearResetCause(0xFFFFFFFFU);
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_POR | SYSCTL_CAUSE_XRS, SysCtl_getResetCause());
}

void test_the_causes_outlive_a_restart_until_they_are_cleared(void)
{
    run_until(SIM_S);
    chip_restart();
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_WDRS, SysCtl_getResetCause() & SYSCTL_CAUSE_WDRS);
    SysCtl_clearResetCause(SYSCTL_CAUSE_POR);
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_WDRS, SysCtl_getResetCause() & SYSCTL_CAUSE_WDRS);
    SysCtl_clearResetCause(SYSCTL_CAUSE_WDRS);
    TEST_ASSERT_EQUAL_HEX32(0, SysCtl_getResetCause() & SYSCTL_CAUSE_WDRS);
}

void test_power_on_forgets_the_watchdog(void)
{
    run_until(SIM_S);
    chip_reset(ignore);
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_POR | SYSCTL_CAUSE_XRS, SysCtl_getResetCause());
}

void test_a_restart_puts_every_register_back_and_keeps_the_wires(void)
{
    (void)SysCtl_setClock(DEVICE_SETCLOCK_CFG);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIC);
    SysCtl_setWatchdogPrescaler(SYSCTL_WD_PRESCALE_64);
    run_until(100 * SIM_MS);
    chip_restart();
    TEST_ASSERT_EQUAL_UINT32(10000000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
    TEST_ASSERT_EQUAL_HEX32(0, chip_register("WDCR"));
    TEST_ASSERT_EQUAL_HEX32(0, chip_register("PCLKCR7"));
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT64(100 * SIM_MS + PERIOD_1, bitten_at);
}

void test_with_nobody_to_restart_the_chip_it_bites_no_more(void)
{
    chip_watchdog_connect(NULL, NULL);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_WDRS, SysCtl_getResetCause() & SYSCTL_CAUSE_WDRS);
}

void test_an_nmi_that_nobody_services_resets_after_65536_cycles_and_once(void)
{
    SysCtl_disableWatchdog();
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    chip_nmi();
    chip_nmi();
    TEST_ASSERT_EQUAL_UINT(2, chip_nmis());
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT(1, bites);
    TEST_ASSERT_EQUAL_INT64(65536 * 5, bitten_at);
    TEST_ASSERT_EQUAL_HEX32(SYSCTL_CAUSE_NMIWDRS, SysCtl_getResetCause() & SYSCTL_CAUSE_NMIWDRS);
    TEST_ASSERT_EQUAL_HEX32(0, SysCtl_getResetCause() & SYSCTL_CAUSE_WDRS);
}
