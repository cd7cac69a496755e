/* Without an interrupt and without waiting: a conversion lasts 2.8 us, and is read by the next control cycle.
 * What breaks: a value is as old as the cycle before. A battery does not mind. */
#include "bsp/voltmeter.h"

#include <stdint.h>

#include "device.h"
#include "bsp/timebase.h"

#define POWER_UP_US UINT32_C(1000) /* TI's data sheet: 500; TI's examples wait so long */

/* The longest window there is, 2.56 us: nothing is in a hurry. The module's divider is 1.4 kOhm, and with the
 * switch's 425 Ohm and 14.5 pF it takes 0.24 us to half a step. */
#define WINDOW_CYCLES 512U

static uint32_t powered_us;
static bool started;

void bsp_voltmeter_init(void)
{
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ADCA);
    ADC_setPrescaler(ADCA_BASE, ADC_CLK_DIV_4_0); /* 50 MHz, the most that the data sheet allows */
    ADC_setMode(ADCA_BASE, ADC_RESOLUTION_12BIT, ADC_MODE_SINGLE_ENDED);
    ADC_setInterruptPulseMode(ADCA_BASE, ADC_PULSE_END_OF_CONV);
    ADC_enableConverter(ADCA_BASE);
    powered_us = bsp_time_us();
    started = false;
    ADC_setupSOC(ADCA_BASE, ADC_SOC_NUMBER0, ADC_TRIGGER_SW_ONLY, ADC_CH_ADCIN0, WINDOW_CYCLES);
    ADC_setInterruptSource(ADCA_BASE, ADC_INT_NUMBER1, (uint16_t)ADC_SOC_NUMBER0);
    ADC_enableInterrupt(ADCA_BASE, ADC_INT_NUMBER1); /* for its flag: the PIE does not pass it on */
    ADC_clearInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1);
}

bool bsp_voltmeter_take(float *pin_v)
{
    if (!started) {
        if (bsp_time_us() - powered_us >= POWER_UP_US) {
            started = true;
            ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
        }
        return false;
    }
    if (!ADC_getInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1)) {
        return false;
    }
    *pin_v = (float)ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0) * BSP_VOLTMETER_STEP_V;
    ADC_clearInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1);
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
    return true;
}
