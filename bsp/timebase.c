#include "bsp/timebase.h"

#include "device.h"

#define SYSCLK_PER_US ((uint16_t)(DEVICE_SYSCLK_FREQ / 1000000U))
#define FULL_SCALE 0xFFFFFFFFU

void bsp_time_init(void)
{
    CPUTimer_stopTimer(CPUTIMER1_BASE);
    CPUTimer_setPeriod(CPUTIMER1_BASE, FULL_SCALE);
    CPUTimer_setPreScaler(CPUTIMER1_BASE, (uint16_t)(SYSCLK_PER_US - 1U));
    CPUTimer_startTimer(CPUTIMER1_BASE);
}

uint32_t bsp_time_us(void)
{
    return FULL_SCALE - CPUTimer_getTimerCount(CPUTIMER1_BASE);
}
