#include "adc.h"

#include <math.h>
#include <string.h>

#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sysctl.h"

#define CHANNELS 16U
#define CODES 4096.0
#define REFERENCE_V 3.3 /* VREFHI; TI's data sheet: 2.4 V .. VDDA */

/* SPRS881, 12-bit single-ended mode: clock, window, conversion of 10.5 periods, power-up, input model. */
#define CLOCK_MOST_HZ 50000000.0
#define WINDOW_LEAST_NS 75.0
#define CONVERSION_CLOCKS 10.5
#define POWER_UP (500 * SIM_US)
#define SWITCH_OHM 425.0
#define CAPACITOR_F 14.5e-12

typedef struct {
    double volts, ohms;
} source_t;

static source_t sources[CHANNELS]; /* the world's: they stay through a reset */

static struct {
    double divider;
    bool trimmed, late, powered, interrupt, flag;
    uint16_t channel, window, result, coming;
    bool converting;
    sim_time_t powered_at, ready_at;
} adc;

void adc_reset(void)
{
    memset(&adc, 0, sizeof adc);
    adc.divider = 1.0;
}

void chip_drive_analog(uint32_t channel, double volts, double ohms)
{
    if (channel >= CHANNELS) {
        chip_unmodelled("no such analog channel");
    }
    sources[channel] = (source_t){volts, ohms};
}

static bool reached(uint32_t base)
{
    if (base != ADCA_BASE) {
        chip_unmodelled("an ADC other than ADC A");
    }
    return sysctl_clocked(SYSCTL_PERIPH_CLK_ADCA);
}

static void demand(bool so, const char *what)
{
    if (!so) {
        chip_unmodelled(what);
    }
}

void ADC_setPrescaler(uint32_t base, ADC_ClkPrescale clkPrescale)
{
    if (reached(base)) {
        adc.divider = 1.0 + (double)clkPrescale / 2.0;
    }
}

void ADC_setMode(uint32_t base, ADC_Resolution resolution, ADC_SignalMode signalMode)
{
    demand(resolution == ADC_RESOLUTION_12BIT && signalMode == ADC_MODE_SINGLE_ENDED,
           "an ADC that is not in its 12-bit single-ended mode");
    adc.trimmed = adc.trimmed || reached(base);
}

void ADC_setInterruptPulseMode(uint32_t base, ADC_PulseMode pulseMode)
{
    if (reached(base)) {
        adc.late = pulseMode == ADC_PULSE_END_OF_CONV;
    }
}

void ADC_enableConverter(uint32_t base)
{
    if (reached(base) && !adc.powered) {
        adc.powered = true;
        adc.powered_at = timeline_now();
    }
}

void ADC_setupSOC(uint32_t base, ADC_SOCNumber socNumber, ADC_Trigger trigger, ADC_Channel channel,
                  uint32_t sampleWindow)
{
    demand(socNumber == ADC_SOC_NUMBER0 && trigger == ADC_TRIGGER_SW_ONLY,
           "an ADC's start of conversion other than 0, by software");
    demand(sampleWindow >= 1U && sampleWindow <= 512U, "an acquisition window beyond 512 periods");
    if (reached(base)) {
        adc.channel = (uint16_t)channel;
        adc.window = (uint16_t)sampleWindow;
    }
}

void ADC_setInterruptSource(uint32_t base, ADC_IntNumber adcIntNum, uint16_t intTrigger)
{
    demand(adcIntNum == ADC_INT_NUMBER1 && intTrigger == (uint16_t)ADC_SOC_NUMBER0,
           "an ADC's interrupt other than 1, of conversion 0");
    (void)reached(base);
}

void ADC_enableInterrupt(uint32_t base, ADC_IntNumber adcIntNum)
{
    demand(adcIntNum == ADC_INT_NUMBER1, "an ADC's interrupt other than 1");
    adc.interrupt = adc.interrupt || reached(base);
}

static void catch_up(void)
{
    if (adc.converting && timeline_now() >= adc.ready_at) {
        adc.converting = false;
        adc.result = adc.coming;
        adc.flag = adc.flag || adc.interrupt;
    }
}

bool ADC_getInterruptStatus(uint32_t base, ADC_IntNumber adcIntNum)
{
    demand(adcIntNum == ADC_INT_NUMBER1, "an ADC's interrupt other than 1");
    if (!reached(base)) {
        return false;
    }
    catch_up();
    return adc.flag;
}

void ADC_clearInterruptStatus(uint32_t base, ADC_IntNumber adcIntNum)
{
    demand(adcIntNum == ADC_INT_NUMBER1, "an ADC's interrupt other than 1");
    if (reached(base)) {
        catch_up();
        adc.flag = false;
    }
}

/* The capacitor begins empty: what the window does not charge is missing. */
static uint16_t sampled(double window_s)
{
    const source_t *source = &sources[adc.channel];
    const double share = 1.0 - exp(-window_s / ((source->ohms + SWITCH_OHM) * CAPACITOR_F));
    const double code = floor(source->volts * share / REFERENCE_V * CODES + 0.5);

    return (uint16_t)fmin(fmax(code, 0.0), CODES - 1.0);
}

void ADC_forceSOC(uint32_t base, ADC_SOCNumber socNumber)
{
    const double sysclk_hz = sysctl_sysclk_hz();

    demand(socNumber == ADC_SOC_NUMBER0, "an ADC's start of conversion other than 0");
    if (!reached(base)) {
        return;
    }
    catch_up();
    const double window_ns = (double)adc.window * 1e9 / sysclk_hz;
    const double clock_hz = sysclk_hz / adc.divider;

    demand(adc.powered, "a conversion of an ADC without power");
    demand(timeline_now() - adc.powered_at >= POWER_UP, "a conversion in the first 500 us of an ADC's power");
    demand(adc.trimmed, "a conversion of an ADC without its trims");
    demand(adc.late, "an ADC's flag before its result");
    demand(clock_hz <= CLOCK_MOST_HZ, "an ADC's clock above 50 MHz");
    demand(window_ns >= WINDOW_LEAST_NS, "an ADC's acquisition window below 75 ns");
    adc.coming = sampled(window_ns * 1e-9);
    adc.converting = true;
    adc.ready_at = timeline_now() + (sim_time_t)llround(window_ns + CONVERSION_CLOCKS * 1e9 / clock_hz);
}

uint16_t ADC_readResult(uint32_t resultBase, ADC_SOCNumber socNumber)
{
    demand(resultBase == ADCARESULT_BASE && socNumber == ADC_SOC_NUMBER0,
           "an ADC's result other than that of conversion 0 of ADC A");
    catch_up();
    return sysctl_clocked(SYSCTL_PERIPH_CLK_ADCA) ? adc.result : 0U;
}
