/* The selector's pin on mocks of driverlib: pull-up and qualification before it becomes an input. */
#include "device.h"
#include "mock_gpio.h"
#include "bsp/selector.h"
#include "unity.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

void test_init_in_its_order(void)
{
    GPIO_setPadConfig_Expect(3, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationPeriod_Expect(3, 510);
    GPIO_setQualificationMode_Expect(3, GPIO_QUAL_6SAMPLE);
    GPIO_setDirectionMode_Expect(3, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig_Expect(GPIO_3_GPIO3);
    bsp_selector_init();
}

void test_each_call_reads_the_pin(void)
{
    GPIO_readPin_ExpectAndReturn(3, 0);
    TEST_ASSERT_FALSE(bsp_selector_ours());
    GPIO_readPin_ExpectAndReturn(3, 1);
    TEST_ASSERT_TRUE(bsp_selector_ours());
}
