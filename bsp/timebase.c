#include "bsp/timebase.h"

#include "device.h"

#define SYSCLK_PER_US ((uint16_t)(DEVICE_SYSCLK_FREQ / 1000000U))
#define FULL_SCALE 0xFFFFFFFFU

typedef char a_cycle_has_its_length[(DEVICE_SYSCLK_FREQ / 1000U * BSP_CYCLE_NS == 1000000U) ? 1 : -1];

static void start(uint32_t timer, uint16_t divider)
{
    CPUTimer_stopTimer(timer);
    CPUTimer_setPeriod(timer, FULL_SCALE);
    CPUTimer_setPreScaler(timer, (uint16_t)(divider - 1U));
    CPUTimer_startTimer(timer);
}

void bsp_time_init(void)
{
    start(CPUTIMER1_BASE, SYSCLK_PER_US);
    start(CPUTIMER2_BASE, 1U);
}

uint32_t bsp_time_us(void)
{
    return FULL_SCALE - CPUTimer_getTimerCount(CPUTIMER1_BASE);
}

uint32_t bsp_time_cycles(void)
{
    return FULL_SCALE - CPUTimer_getTimerCount(CPUTIMER2_BASE);
}
