/* The receiver's pin on mocks of driverlib: the module's clock before its registers, the arming last. */
#include "device.h"
#include "mock_ecap.h"
#include "mock_gpio.h"
#include "mock_sysctl.h"
#include "mock_xbar.h"
#include "bsp/receiver.h"
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
    GPIO_setPadConfig_Expect(10, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationPeriod_Expect(10, 510);
    GPIO_setQualificationMode_Expect(10, GPIO_QUAL_6SAMPLE);
    GPIO_setDirectionMode_Expect(10, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig_Expect(GPIO_10_GPIO10);
    XBAR_setInputPin_Expect(XBAR_INPUT7, 10);
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_ECAP1);
    ECAP_setEmulationMode_Expect(ECAP1_BASE, ECAP_EMULATION_FREE_RUN);
    ECAP_enableCaptureMode_Expect(ECAP1_BASE);
    ECAP_setCaptureMode_Expect(ECAP1_BASE, ECAP_ONE_SHOT_CAPTURE_MODE, ECAP_EVENT_2);
    ECAP_setEventPolarity_Expect(ECAP1_BASE, ECAP_EVENT_1, ECAP_EVNT_RISING_EDGE);
    ECAP_setEventPolarity_Expect(ECAP1_BASE, ECAP_EVENT_2, ECAP_EVNT_FALLING_EDGE);
    ECAP_enableTimeStampCapture_Expect(ECAP1_BASE);
    ECAP_startCounter_Expect(ECAP1_BASE);
    ECAP_reArm_Expect(ECAP1_BASE);
    bsp_receiver_init();
}

void test_without_the_second_edge_nothing_else_is_read(void)
{
    float pulse_us = 0.0F;

    ECAP_getInterruptSource_ExpectAndReturn(ECAP1_BASE, ECAP_ISR_SOURCE_CAPTURE_EVENT_1);
    TEST_ASSERT_FALSE(bsp_receiver_take(&pulse_us));
}

void test_both_stamps_are_read_before_it_is_armed_again(void)
{
    float pulse_us = 0.0F;

    ECAP_getInterruptSource_ExpectAndReturn(ECAP1_BASE, 6);
    ECAP_getEventTimeStamp_ExpectAndReturn(ECAP1_BASE, ECAP_EVENT_1, 0xFFFFFF00U);
    ECAP_getEventTimeStamp_ExpectAndReturn(ECAP1_BASE, ECAP_EVENT_2, 299744U);
    ECAP_clearInterrupt_Expect(ECAP1_BASE, 6);
    ECAP_reArm_Expect(ECAP1_BASE);
    TEST_ASSERT_TRUE(bsp_receiver_take(&pulse_us));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 1500.0F, pulse_us);
}
