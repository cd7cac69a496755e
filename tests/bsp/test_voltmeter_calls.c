/* The battery's pin on mocks of driverlib: the module's clock before its registers, its trims before its
 * power, and no conversion before a millisecond of it. */
#include "device.h"
#include "mock_adc.h"
#include "mock_sysctl.h"
#include "mock_timebase.h"
#include "bsp/voltmeter.h"
#include "unity.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

static void init(uint32_t now_us)
{
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_ADCA);
    ADC_setPrescaler_Expect(ADCA_BASE, ADC_CLK_DIV_4_0);
    ADC_setMode_Expect(ADCA_BASE, ADC_RESOLUTION_12BIT, ADC_MODE_SINGLE_ENDED);
    ADC_setInterruptPulseMode_Expect(ADCA_BASE, ADC_PULSE_END_OF_CONV);
    ADC_enableConverter_Expect(ADCA_BASE);
    bsp_time_us_ExpectAndReturn(now_us);
    ADC_setupSOC_Expect(ADCA_BASE, ADC_SOC_NUMBER0, ADC_TRIGGER_SW_ONLY, ADC_CH_ADCIN0, 512);
    ADC_setInterruptSource_Expect(ADCA_BASE, ADC_INT_NUMBER1, 0);
    ADC_enableInterrupt_Expect(ADCA_BASE, ADC_INT_NUMBER1);
    ADC_clearInterruptStatus_Expect(ADCA_BASE, ADC_INT_NUMBER1);
    bsp_voltmeter_init();
}

void test_init_in_its_order(void)
{
    init(0U);
}

void test_the_clocks_wrap_does_not_shorten_the_first_millisecond(void)
{
    float pin_v = 0.0F;

    init(0xFFFFFF00U);
    bsp_time_us_ExpectAndReturn(0U);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&pin_v));
    bsp_time_us_ExpectAndReturn(743U);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&pin_v));
    bsp_time_us_ExpectAndReturn(744U);
    ADC_forceSOC_Expect(ADCA_BASE, ADC_SOC_NUMBER0);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&pin_v));
}

void test_a_result_is_read_before_the_next_conversion_starts(void)
{
    float pin_v = 0.0F;

    init(0U);
    bsp_time_us_ExpectAndReturn(1000U);
    ADC_forceSOC_Expect(ADCA_BASE, ADC_SOC_NUMBER0);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&pin_v));
    ADC_getInterruptStatus_ExpectAndReturn(ADCA_BASE, ADC_INT_NUMBER1, false);
    TEST_ASSERT_FALSE(bsp_voltmeter_take(&pin_v));
    ADC_getInterruptStatus_ExpectAndReturn(ADCA_BASE, ADC_INT_NUMBER1, true);
    ADC_readResult_ExpectAndReturn(ADCARESULT_BASE, ADC_SOC_NUMBER0, 2048U);
    ADC_clearInterruptStatus_Expect(ADCA_BASE, ADC_INT_NUMBER1);
    ADC_forceSOC_Expect(ADCA_BASE, ADC_SOC_NUMBER0);
    TEST_ASSERT_TRUE(bsp_voltmeter_take(&pin_v));
    TEST_ASSERT_EQUAL_FLOAT(1.65F, pin_v);
}
