/* Order of the calls: time base under a closed clock gate, values before the pin is handed over, the gate
 * last. */
#include "device.h"
#include "mock_epwm.h"
#include "mock_gpio.h"
#include "mock_sysctl.h"
#include "bsp/throttle.h"
#include "unity.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

static void expect_compare(uint16_t counts)
{
    EPWM_setCounterCompareValue_Expect(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, counts);
}

static void expect_init(uint32_t sysclk_hz, SysCtl_EPWMCLKDivider clock, EPWM_ClockDivider slow,
                        EPWM_HSClockDivider fast, uint16_t period, uint16_t idle)
{
    SysCtl_getClock_ExpectAndReturn(10000000U, sysclk_hz);
    SysCtl_disablePeripheral_Expect(SYSCTL_PERIPH_CLK_TBCLKSYNC);
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_EPWM2);
    SysCtl_setEPWMClockDivider_Expect(clock);
    EPWM_setClockPrescaler_Expect(EPWM2_BASE, slow, fast);
    EPWM_setEmulationMode_Expect(EPWM2_BASE, EPWM_EMULATION_FREE_RUN);
    EPWM_disablePhaseShiftLoad_Expect(EPWM2_BASE);
    EPWM_setPhaseShift_Expect(EPWM2_BASE, 0);
    EPWM_setPeriodLoadMode_Expect(EPWM2_BASE, EPWM_PERIOD_DIRECT_LOAD);
    EPWM_setTimeBasePeriod_Expect(EPWM2_BASE, period);
    EPWM_setPeriodLoadMode_Expect(EPWM2_BASE, EPWM_PERIOD_SHADOW_LOAD);
    EPWM_setTimeBasePeriod_Expect(EPWM2_BASE, period);
    EPWM_setTimeBaseCounter_Expect(EPWM2_BASE, 0);
    EPWM_disableCounterCompareShadowLoadMode_Expect(EPWM2_BASE, EPWM_COUNTER_COMPARE_A);
    expect_compare(idle);
    EPWM_setCounterCompareShadowLoadMode_Expect(EPWM2_BASE, EPWM_COUNTER_COMPARE_A,
                                                EPWM_COMP_LOAD_ON_CNTR_ZERO);
    expect_compare(idle);
    EPWM_setActionQualifierAction_Expect(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_HIGH,
                                         EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO);
    EPWM_setActionQualifierAction_Expect(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_LOW,
                                         EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA);
    EPWM_setTimeBaseCounterMode_Expect(EPWM2_BASE, EPWM_COUNTER_MODE_UP);
    GPIO_setPinConfig_Expect(GPIO_2_EPWM2A);
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_TBCLKSYNC);
}

void test_init_from_the_crystal(void)
{
    expect_init(200000000U, SYSCTL_EPWMCLK_DIV_2, EPWM_CLOCK_DIVIDER_8, EPWM_HSCLOCK_DIVIDER_6, 28332, 4166);
    bsp_throttle_init();
}

void test_init_from_the_internal_oscillator(void)
{
    expect_init(10000000U, SYSCTL_EPWMCLK_DIV_1, EPWM_CLOCK_DIVIDER_1, EPWM_HSCLOCK_DIVIDER_4, 33999, 5150);
    bsp_throttle_init();
}

void test_a_pulse_is_one_write_of_the_compare_register(void)
{
    expect_compare(3125);
    bsp_throttle_set_pulse_us(1500.0F);
    expect_compare(4166);
    bsp_throttle_idle();
}
