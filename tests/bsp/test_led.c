/* LD9 red = GPIO12, LD10 blue = GPIO13, lit by a low level. */
#include "bsp/led.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define RED 12
#define BLUE 13

static void ignore(int interrupt)
{
    (void)interrupt;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_drive_pin(RED, false);
    chip_drive_pin(BLUE, false);
    bsp_led_init();
}

void tearDown(void) {}

void test_both_are_dark_after_init(void)
{
    TEST_ASSERT_TRUE(chip_pin(RED));
    TEST_ASSERT_TRUE(chip_pin(BLUE));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO12.DIR"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO13.DIR"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO12.MUX"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO13.MUX"));
}

void test_each_lights_alone(void)
{
    bsp_led_red(true);
    TEST_ASSERT_FALSE(chip_pin(RED));
    TEST_ASSERT_TRUE(chip_pin(BLUE));
    bsp_led_blue(true);
    bsp_led_red(false);
    TEST_ASSERT_TRUE(chip_pin(RED));
    TEST_ASSERT_FALSE(chip_pin(BLUE));
    bsp_led_blue(false);
    TEST_ASSERT_TRUE(chip_pin(BLUE));
}
