/* The watchdog, on the chip model. */
#include "bsp/watchdog.h"

#include "device.h"
#include "dog.h"
#include "unity.h"

void setUp(void)
{
    dog_begin();
}

void tearDown(void) {}

void test_before_the_start_it_never_bites(void)
{
    dog_run_until(100 * SIM_S);
    TEST_ASSERT_EQUAL_INT(0, dog_bites());
}

void test_it_bites_0_84_s_after_the_start(void)
{
    dog_run_until(5 * SIM_S);
    bsp_watchdog_start();
    dog_run_until(5 * SIM_S + DOG_PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, dog_bites());
    dog_run_until(5 * SIM_S + DOG_PERIOD);
    TEST_ASSERT_EQUAL_INT(1, dog_bites());
    TEST_ASSERT_INT_WITHIN(1000000, 838860800, DOG_PERIOD);
}

void test_a_service_gives_another_period(void)
{
    bsp_watchdog_start();
    for (int i = 1; i <= 100; i++) {
        dog_run_until(i * (DOG_PERIOD - SIM_MS));
        bsp_watchdog_service();
    }
    TEST_ASSERT_EQUAL_INT(0, dog_bites());
    dog_run_until(timeline_now() + DOG_PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, dog_bites());
    dog_run_until(timeline_now() + 1);
    TEST_ASSERT_EQUAL_INT(1, dog_bites());
}

void test_the_start_gives_a_whole_period_whatever_was_counted_before(void)
{
    SysCtl_enableWatchdog();
    dog_run_until(13 * SIM_MS);
    bsp_watchdog_start();
    dog_run_until(13 * SIM_MS + DOG_PERIOD - 1);
    TEST_ASSERT_EQUAL_INT(0, dog_bites());
}
