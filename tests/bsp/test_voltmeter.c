/* The battery's divider on ADCINA0, by ADC A. */
#include "bsp/voltmeter.h"

#include "bsp/timebase.h"
#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define CHANNEL 0
#define MODULE_OHM 1350.0

static void ignore(int interrupt)
{
    (void)interrupt;
}

static void wait(sim_time_t length)
{
    const sim_time_t end = timeline_now() + length;

    while (timeline_next() <= end) { /* the watchdog's */
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    SysCtl_disableWatchdog();
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    for (uint32_t channel = 0; channel < 16; channel++) {
        chip_drive_analog(channel, 0.0, MODULE_OHM);
    }
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TIMER1);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TIMER2);
    bsp_time_init();
    bsp_voltmeter_init();
}

void tearDown(void) {}

static void expect(float volts)
{
    float found = -1.0F;

    wait(25 * SIM_MS);
    (void)bsp_voltmeter_take(&found); /* of before */
    wait(25 * SIM_MS);
    TEST_ASSERT_TRUE(bsp_voltmeter_take(&found));
    TEST_ASSERT_FLOAT_WITHIN(0.51F * BSP_VOLTMETER_STEP_V, volts, found);
}

void test_it_tells_the_voltage_of_its_own_pin_from_end_to_end(void)
{
    static const double volts[] = {0.0, 0.001, 1.386, 1.663, 2.5, 3.299};

    for (uint32_t other = 1; other < 16; other++) {
        chip_drive_analog(other, 3.0, MODULE_OHM);
    }
    for (size_t i = 0; i < sizeof volts / sizeof volts[0]; i++) {
        chip_drive_analog(CHANNEL, volts[i], MODULE_OHM);
        expect((float)volts[i]);
    }
}

void test_beyond_its_range_it_is_at_the_end(void)
{
    chip_drive_analog(CHANNEL, 5.0, MODULE_OHM);
    expect(4095.0F * BSP_VOLTMETER_STEP_V);
}

/* A model that converts within 500 us of its power aborts, and so would this test. */
void test_in_its_first_millisecond_it_tells_nothing_and_converts_nothing(void)
{
    float found = -1.0F;

    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_FALSE(bsp_voltmeter_take(&found));
        wait(100 * SIM_US);
    }
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, found);
    wait(100 * SIM_US);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&found)); /* it starts the first one */
    wait(3 * SIM_US);
    TEST_ASSERT_TRUE(bsp_voltmeter_take(&found));
}

void test_before_a_conversion_has_ended_there_is_none(void)
{
    float found = -1.0F;

    chip_drive_analog(CHANNEL, 1.5, MODULE_OHM);
    expect(1.5F);
    wait(2 * SIM_US);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&found));
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, found);
    wait(SIM_US);
    TEST_ASSERT_TRUE(bsp_voltmeter_take(&found));
}

void test_each_conversion_is_taken_once_however_late(void)
{
    chip_drive_analog(CHANNEL, 1.5, MODULE_OHM);
    expect(1.5F);
    wait(10 * SIM_S);
    expect(1.5F);
}

/* Of ten times the module's, a window of 75 ns would miss a third. */
void test_a_divider_of_ten_times_the_resistance_is_read_as_well(void)
{
    chip_drive_analog(CHANNEL, 1.5, 10.0 * MODULE_OHM);
    expect(1.5F);
}
