/* The first pulse must be a whole one: the time base is set up with its clock gated and the pin still a plain
 * output held low, the pin is handed over while the PWM output is low, and only then the clock starts, at
 * count zero. Period and compare are first written without their shadows, because a shadow is only loaded
 * when the counter passes zero. */
#include "bsp/throttle.h"

#include "device.h"

#define COUNTS_PER_US (25.0F / 12.0F)

typedef struct {
    SysCtl_EPWMCLKDivider clock;
    EPWM_HSClockDivider fast;
    EPWM_ClockDivider slow;
    uint16_t period_counts;
    uint16_t idle_counts;
} time_base_t;

/* 200 MHz / 2 / 6 / 8: counts of 0.48 us. */
static const time_base_t CRYSTAL = {SYSCTL_EPWMCLK_DIV_2, EPWM_HSCLOCK_DIVIDER_6, EPWM_CLOCK_DIVIDER_8,
                                    BSP_THROTTLE_PERIOD_COUNTS, BSP_THROTTLE_IDLE_COUNTS};

/* Internal oscillator, 10 MHz within 3 %, / 4: counts of 0.4 us. 2.06 ms, so that the pulse is never under 2
 * ms. */
static const time_base_t NO_CRYSTAL = {SYSCTL_EPWMCLK_DIV_1, EPWM_HSCLOCK_DIVIDER_4, EPWM_CLOCK_DIVIDER_1,
                                       33999U, 5150U};

static void set_time_base(const time_base_t *base)
{
    SysCtl_setEPWMClockDivider(base->clock);
    EPWM_setClockPrescaler(EPWM2_BASE, base->slow, base->fast);
    EPWM_setEmulationMode(EPWM2_BASE, EPWM_EMULATION_FREE_RUN);
    EPWM_disablePhaseShiftLoad(EPWM2_BASE);
    EPWM_setPhaseShift(EPWM2_BASE, 0U);
    EPWM_setPeriodLoadMode(EPWM2_BASE, EPWM_PERIOD_DIRECT_LOAD);
    EPWM_setTimeBasePeriod(EPWM2_BASE, base->period_counts);
    EPWM_setPeriodLoadMode(EPWM2_BASE, EPWM_PERIOD_SHADOW_LOAD);
    EPWM_setTimeBasePeriod(EPWM2_BASE, base->period_counts);
    EPWM_setTimeBaseCounter(EPWM2_BASE, 0U);
}

static void set_compare(uint16_t counts)
{
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, counts);
}

static void set_pulse(uint16_t counts)
{
    EPWM_disableCounterCompareShadowLoadMode(EPWM2_BASE, EPWM_COUNTER_COMPARE_A);
    set_compare(counts);
    EPWM_setCounterCompareShadowLoadMode(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, EPWM_COMP_LOAD_ON_CNTR_ZERO);
    set_compare(counts);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_HIGH,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_LOW,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA);
}

void bsp_throttle_init(void)
{
    const bool crystal = SysCtl_getClock(DEVICE_OSCSRC_FREQ) == DEVICE_SYSCLK_FREQ;
    const time_base_t *base = crystal ? &CRYSTAL : &NO_CRYSTAL;

    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_TBCLKSYNC);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_EPWM2);
    set_time_base(base);
    set_pulse(base->idle_counts);
    EPWM_setTimeBaseCounterMode(EPWM2_BASE, EPWM_COUNTER_MODE_UP);
    GPIO_setPinConfig(GPIO_2_EPWM2A);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TBCLKSYNC);
}

void bsp_throttle_set_pulse_us(float pulse_us)
{
    const float counts = pulse_us * COUNTS_PER_US;
    if (!(counts < (float)BSP_THROTTLE_IDLE_COUNTS)) {
        bsp_throttle_idle();
    } else if (counts < (float)BSP_THROTTLE_FULL_COUNTS) {
        set_compare(BSP_THROTTLE_FULL_COUNTS);
    } else {
        set_compare((uint16_t)(counts + 0.5F));
    }
}

void bsp_throttle_idle(void)
{
    set_compare(BSP_THROTTLE_IDLE_COUNTS);
}
