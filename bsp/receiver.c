/* Without an interrupt: eCAP1 captures a rising edge and the falling edge after it, and then stops, so both
 * time stamps are of one pulse however late they are read. What breaks: nobody clears its flag. Then every
 * call would find the same pulse. */
#include "bsp/receiver.h"

#include "device.h"

#define STICK_PIN 10U
#define SAMPLE_DIVIDER 510U
#define US_PER_COUNT (1.0e6F / (float)DEVICE_SYSCLK_FREQ)
#define BOTH_EDGES (ECAP_ISR_SOURCE_CAPTURE_EVENT_1 | ECAP_ISR_SOURCE_CAPTURE_EVENT_2)

static void open_pin(void)
{
    GPIO_setPadConfig(STICK_PIN, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationPeriod(STICK_PIN, SAMPLE_DIVIDER);
    GPIO_setQualificationMode(STICK_PIN, GPIO_QUAL_6SAMPLE);
    GPIO_setDirectionMode(STICK_PIN, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig(GPIO_10_GPIO10);
    XBAR_setInputPin(XBAR_INPUT7, STICK_PIN);
}

void bsp_receiver_init(void)
{
    open_pin();
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ECAP1);
    ECAP_setEmulationMode(ECAP1_BASE, ECAP_EMULATION_FREE_RUN);
    ECAP_enableCaptureMode(ECAP1_BASE);
    ECAP_setCaptureMode(ECAP1_BASE, ECAP_ONE_SHOT_CAPTURE_MODE, ECAP_EVENT_2);
    ECAP_setEventPolarity(ECAP1_BASE, ECAP_EVENT_1, ECAP_EVNT_RISING_EDGE);
    ECAP_setEventPolarity(ECAP1_BASE, ECAP_EVENT_2, ECAP_EVNT_FALLING_EDGE);
    ECAP_enableTimeStampCapture(ECAP1_BASE);
    ECAP_startCounter(ECAP1_BASE);
    ECAP_reArm(ECAP1_BASE);
}

bool bsp_receiver_take(float *pulse_us)
{
    uint32_t rose;
    uint32_t fell;

    if ((ECAP_getInterruptSource(ECAP1_BASE) & ECAP_ISR_SOURCE_CAPTURE_EVENT_2) == 0U) {
        return false;
    }
    rose = ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_1);
    fell = ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_2);
    ECAP_clearInterrupt(ECAP1_BASE, BOTH_EDGES);
    ECAP_reArm(ECAP1_BASE);
    *pulse_us = (float)(fell - rose) * US_PER_COUNT;
    return true;
}
