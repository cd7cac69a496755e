/* ePWM2: the used subset of TI's driverlib header of this name, plain functions. Modelled: up-count, shadow
 * loads at zero, compare A, output A, actions at zero and at compare A going up. Anything else aborts with a
 * message. */
#ifndef EPWM_H
#define EPWM_H

#include <stdint.h>

#include "inc/hw_memmap.h"

typedef enum {
    EPWM_EMULATION_STOP_AFTER_NEXT_TB = 0,
    EPWM_EMULATION_STOP_AFTER_FULL_CYCLE = 1,
    EPWM_EMULATION_FREE_RUN = 2
} EPWM_EmulationMode;

typedef enum {
    EPWM_CLOCK_DIVIDER_1 = 0,
    EPWM_CLOCK_DIVIDER_2 = 1,
    EPWM_CLOCK_DIVIDER_4 = 2,
    EPWM_CLOCK_DIVIDER_8 = 3,
    EPWM_CLOCK_DIVIDER_16 = 4,
    EPWM_CLOCK_DIVIDER_32 = 5,
    EPWM_CLOCK_DIVIDER_64 = 6,
    EPWM_CLOCK_DIVIDER_128 = 7
} EPWM_ClockDivider;

typedef enum {
    EPWM_HSCLOCK_DIVIDER_1 = 0,
    EPWM_HSCLOCK_DIVIDER_2 = 1,
    EPWM_HSCLOCK_DIVIDER_4 = 2,
    EPWM_HSCLOCK_DIVIDER_6 = 3,
    EPWM_HSCLOCK_DIVIDER_8 = 4,
    EPWM_HSCLOCK_DIVIDER_10 = 5,
    EPWM_HSCLOCK_DIVIDER_12 = 6,
    EPWM_HSCLOCK_DIVIDER_14 = 7
} EPWM_HSClockDivider;

typedef enum { EPWM_PERIOD_SHADOW_LOAD = 0, EPWM_PERIOD_DIRECT_LOAD = 1 } EPWM_PeriodLoadMode;

typedef enum {
    EPWM_COUNTER_MODE_UP = 0,
    EPWM_COUNTER_MODE_DOWN = 1,
    EPWM_COUNTER_MODE_UP_DOWN = 2,
    EPWM_COUNTER_MODE_STOP_FREEZE = 3
} EPWM_TimeBaseCountMode;

typedef enum {
    EPWM_COUNTER_COMPARE_A = 0,
    EPWM_COUNTER_COMPARE_B = 2,
    EPWM_COUNTER_COMPARE_C = 5,
    EPWM_COUNTER_COMPARE_D = 7
} EPWM_CounterCompareModule;

typedef enum {
    EPWM_COMP_LOAD_ON_CNTR_ZERO = 0,
    EPWM_COMP_LOAD_ON_CNTR_PERIOD = 1,
    EPWM_COMP_LOAD_ON_CNTR_ZERO_PERIOD = 2,
    EPWM_COMP_LOAD_FREEZE = 3
} EPWM_CounterCompareLoadMode;

typedef enum { EPWM_AQ_OUTPUT_A = 0, EPWM_AQ_OUTPUT_B = 2 } EPWM_ActionQualifierOutputModule;

typedef enum {
    EPWM_AQ_OUTPUT_NO_CHANGE = 0,
    EPWM_AQ_OUTPUT_LOW = 1,
    EPWM_AQ_OUTPUT_HIGH = 2,
    EPWM_AQ_OUTPUT_TOGGLE = 3
} EPWM_ActionQualifierOutput;

typedef enum {
    EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO = 0,
    EPWM_AQ_OUTPUT_ON_TIMEBASE_PERIOD = 2,
    EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA = 4,
    EPWM_AQ_OUTPUT_ON_TIMEBASE_DOWN_CMPA = 6,
    EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPB = 8,
    EPWM_AQ_OUTPUT_ON_TIMEBASE_DOWN_CMPB = 10
} EPWM_ActionQualifierOutputEvent;

void EPWM_setClockPrescaler(uint32_t base, EPWM_ClockDivider prescaler,
                            EPWM_HSClockDivider highSpeedPrescaler);
void EPWM_setEmulationMode(uint32_t base, EPWM_EmulationMode emulationMode);
void EPWM_setTimeBasePeriod(uint32_t base, uint16_t periodCount);
void EPWM_setTimeBaseCounter(uint32_t base, uint16_t count);
void EPWM_setTimeBaseCounterMode(uint32_t base, EPWM_TimeBaseCountMode counterMode);
void EPWM_setPeriodLoadMode(uint32_t base, EPWM_PeriodLoadMode loadMode);
void EPWM_disablePhaseShiftLoad(uint32_t base);
void EPWM_setPhaseShift(uint32_t base, uint16_t phaseCount);
void EPWM_setCounterCompareShadowLoadMode(uint32_t base, EPWM_CounterCompareModule compModule,
                                          EPWM_CounterCompareLoadMode loadMode);
void EPWM_disableCounterCompareShadowLoadMode(uint32_t base, EPWM_CounterCompareModule compModule);
void EPWM_setCounterCompareValue(uint32_t base, EPWM_CounterCompareModule compModule, uint16_t compCount);
void EPWM_setActionQualifierAction(uint32_t base, EPWM_ActionQualifierOutputModule epwmOutput,
                                   EPWM_ActionQualifierOutput output, EPWM_ActionQualifierOutputEvent event);

#endif
