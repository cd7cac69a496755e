/* CPU timers 0..2: the used subset of TI's driverlib header of this name, plain functions. They count down at
 * SYSCLK / (prescaler + 1) and reload the period after zero. Their interrupts are not modelled. */
#ifndef CPUTIMER_H
#define CPUTIMER_H

#include <stdint.h>

#include "inc/hw_memmap.h"

void CPUTimer_stopTimer(uint32_t base);
void CPUTimer_resumeTimer(uint32_t base);
/* Reloads the counter, then runs. */
void CPUTimer_startTimer(uint32_t base);
void CPUTimer_reloadTimerCounter(uint32_t base);
/* Takes effect at the next reload. */
void CPUTimer_setPeriod(uint32_t base, uint32_t periodCount);
/* Divides by prescaler + 1. */
void CPUTimer_setPreScaler(uint32_t base, uint16_t prescaler);
uint32_t CPUTimer_getTimerCount(uint32_t base);

#endif
