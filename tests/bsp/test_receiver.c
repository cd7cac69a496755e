/* The pulses of the pilot's receiver on GPIO10, by eCAP1. */
#include "bsp/receiver.h"

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define STICK 10

static void ignore(int interrupt)
{
    (void)interrupt;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_drive_pin(STICK, false);
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    bsp_receiver_init();
}

void tearDown(void) {}

static void wait(sim_time_t length)
{
    const sim_time_t end = timeline_now() + length;

    while (timeline_next() <= end) { /* the watchdog's */
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void pulse(sim_time_t length)
{
    chip_drive_pin(STICK, true);
    wait(length);
    chip_drive_pin(STICK, false);
    wait(20 * SIM_MS - length);
}

static void expect(float us)
{
    float found = -1.0F;

    TEST_ASSERT_TRUE(bsp_receiver_take(&found));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, us, found);
}

static void expect_none(void)
{
    float found = -1.0F;

    TEST_ASSERT_FALSE(bsp_receiver_take(&found));
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, found);
}

void test_each_pulse_is_taken_once(void)
{
    expect_none();
    pulse(1500 * SIM_US);
    expect(1500.0F);
    expect_none();
    pulse(1100 * SIM_US);
    expect(1100.0F);
    expect_none();
}

void test_a_pulse_that_is_not_over_is_none_yet(void)
{
    chip_drive_pin(STICK, true);
    wait(SIM_MS);
    expect_none();
    wait(SIM_MS);
    chip_drive_pin(STICK, false);
    expect(2000.0F);
}

/* However late it is read, its two edges are of one pulse. */
void test_of_several_pulses_it_is_the_first_and_never_a_mixture(void)
{
    for (int i = 0; i < 7; i++) {
        pulse((1000 + 100 * i) * SIM_US);
    }
    expect(1000.0F);
    expect_none();
    pulse(1900 * SIM_US);
    expect(1900.0F);
}

void test_taken_within_a_pulse_the_next_whole_one_follows(void)
{
    pulse(1500 * SIM_US);
    chip_drive_pin(STICK, true);
    wait(700 * SIM_US);
    expect(1500.0F);
    wait(500 * SIM_US);
    chip_drive_pin(STICK, false);
    wait(18 * SIM_MS);
    expect_none();
    pulse(1300 * SIM_US);
    expect(1300.0F);
}

void test_the_counters_wrap_does_not_show(void)
{
    SysCtl_disableWatchdog();
    wait(INT64_C(21474836480) - 700 * SIM_US); /* 2^32 periods of 5 ns */
    pulse(1500 * SIM_US);
    expect(1500.0F);
}

void test_no_other_pin_matters(void)
{
    for (uint32_t pin = 0; pin < 16; pin++) {
        if (pin != STICK) {
            chip_drive_pin(pin, false);
            wait(SIM_MS);
            chip_drive_pin(pin, true);
            wait(SIM_MS);
            chip_drive_pin(pin, false);
        }
    }
    expect_none();
}

void test_an_open_pin_gives_no_pulse(void)
{
    chip_drive_pin(STICK, true);
    wait(10 * SIM_S);
    expect_none();
}

void test_it_is_an_input_with_pull_up_that_asks_for_six_equal_samples(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO10.MUX"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO10.DIR"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO10.PUD"));
    TEST_ASSERT_EQUAL_UINT32(2, chip_register("GPIO10.QSEL"));
    TEST_ASSERT_EQUAL_UINT32(255, chip_register("GPIO10.QUALPRD"));
}
