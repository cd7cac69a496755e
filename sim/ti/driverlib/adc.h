/* ADC A: the used subset of TI's driverlib header of this name, plain functions. Modelled: 12 bits,
 * single-ended, start of conversion 0 by software, its end on ADCINT1. Anything else aborts with a message,
 * and so does what TI's data sheet and manual forbid: a clock above 50 MHz, an acquisition window below 75
 * ns, a conversion without power, in the first 500 us of it, or without the trims that ADC_setMode() loads.
 * Without its clock the module ignores every write, and reads as 0. */
#ifndef ADC_H
#define ADC_H

#include <stdbool.h>
#include <stdint.h>

#include "inc/hw_memmap.h"

typedef enum { ADC_CLK_DIV_1_0 = 0U, ADC_CLK_DIV_2_0 = 2U, ADC_CLK_DIV_4_0 = 6U } ADC_ClkPrescale;

typedef enum { ADC_RESOLUTION_12BIT = 0x00U, ADC_RESOLUTION_16BIT = 0x40U } ADC_Resolution;

typedef enum { ADC_MODE_SINGLE_ENDED = 0x00U, ADC_MODE_DIFFERENTIAL = 0x80U } ADC_SignalMode;

typedef enum { ADC_TRIGGER_SW_ONLY = 0U, ADC_TRIGGER_CPU1_TINT0 = 1U } ADC_Trigger;

typedef enum { ADC_CH_ADCIN0 = 0U, ADC_CH_ADCIN1 = 1U, ADC_CH_ADCIN2 = 2U, ADC_CH_ADCIN15 = 15U } ADC_Channel;

typedef enum { ADC_PULSE_END_OF_ACQ_WIN = 0x00U, ADC_PULSE_END_OF_CONV = 0x04U } ADC_PulseMode;

typedef enum { ADC_INT_NUMBER1 = 0U, ADC_INT_NUMBER2 = 1U } ADC_IntNumber;

typedef enum { ADC_SOC_NUMBER0 = 0U, ADC_SOC_NUMBER1 = 1U } ADC_SOCNumber;

void ADC_setPrescaler(uint32_t base, ADC_ClkPrescale clkPrescale);
/* Loads the trims of offset and linearity too. */
void ADC_setMode(uint32_t base, ADC_Resolution resolution, ADC_SignalMode signalMode);
void ADC_setInterruptPulseMode(uint32_t base, ADC_PulseMode pulseMode);
/* Powers it up; it needs 500 us before the first conversion. */
void ADC_enableConverter(uint32_t base);
/* sampleWindow: 1 .. 512 periods of SYSCLK. */
void ADC_setupSOC(uint32_t base, ADC_SOCNumber socNumber, ADC_Trigger trigger, ADC_Channel channel,
                  uint32_t sampleWindow);
void ADC_setInterruptSource(uint32_t base, ADC_IntNumber adcIntNum, uint16_t intTrigger);
/* Without it the flag is not set either. */
void ADC_enableInterrupt(uint32_t base, ADC_IntNumber adcIntNum);
bool ADC_getInterruptStatus(uint32_t base, ADC_IntNumber adcIntNum);
void ADC_clearInterruptStatus(uint32_t base, ADC_IntNumber adcIntNum);
void ADC_forceSOC(uint32_t base, ADC_SOCNumber socNumber);
/* Until a conversion has ended, the result of the one before. */
uint16_t ADC_readResult(uint32_t resultBase, ADC_SOCNumber socNumber);

#endif
