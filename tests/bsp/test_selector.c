/* Who has the throttle: GPIO3, high or open = the firmware, low = the pilot. */
#include "bsp/selector.h"

#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define SELECTOR 3

static void ignore(int interrupt)
{
    (void)interrupt;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_drive_pin(SELECTOR, true);
    bsp_selector_init();
}

void tearDown(void) {}

void test_a_high_level_is_the_firmware_and_a_low_one_the_pilot(void)
{
    TEST_ASSERT_TRUE(bsp_selector_ours());
    chip_drive_pin(SELECTOR, false);
    TEST_ASSERT_FALSE(bsp_selector_ours());
    chip_drive_pin(SELECTOR, true);
    TEST_ASSERT_TRUE(bsp_selector_ours());
}

void test_no_other_pin_of_the_group_matters(void)
{
    for (uint32_t pin = 0; pin < 8; pin++) {
        chip_drive_pin(pin, pin == SELECTOR);
    }
    TEST_ASSERT_TRUE(bsp_selector_ours());
    for (uint32_t pin = 0; pin < 8; pin++) {
        chip_drive_pin(pin, pin != SELECTOR);
    }
    TEST_ASSERT_FALSE(bsp_selector_ours());
}

void test_it_is_an_input_with_pull_up_that_asks_for_six_equal_samples(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.MUX"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.DIR"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.PUD"));
    TEST_ASSERT_EQUAL_UINT32(2, chip_register("GPIO3.QSEL"));
    TEST_ASSERT_EQUAL_UINT32(255, chip_register("GPIO3.QUALPRD"));
}
