/* The cause of a reset, on the chip model. */
#include "bsp/reset.h"

#include "bsp/watchdog.h"
#include "dog.h"
#include "sim/ti/driverlib/chip.h"
#include "unity.h"

void setUp(void)
{
    dog_begin();
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
    dog_run_until(DOG_PERIOD);
    TEST_ASSERT_EQUAL_INT(1, dog_bites());
    TEST_ASSERT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
}

void test_the_cause_is_forgotten_once_it_was_told(void)
{
    bsp_watchdog_start();
    dog_run_until(DOG_PERIOD);
    TEST_ASSERT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
    TEST_ASSERT_NOT_EQUAL(BSP_RESET_WATCHDOG, bsp_reset_cause());
}

void test_after_an_nmi_the_cause_is_the_nmi(void)
{
    chip_nmi();
    dog_run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT(1, dog_bites());
    TEST_ASSERT_EQUAL(BSP_RESET_NMI, bsp_reset_cause());
}
