/* eCAP1: the used subset of TI's driverlib header of this name, plain functions. Modelled: one-shot capture
 * that stops at event 2, absolute time stamps. Anything else aborts with a message. Without its clock the
 * module ignores every write, and reads as 0. */
#ifndef ECAP_H
#define ECAP_H

#include <stdint.h>

#include "inc/hw_memmap.h"

#define ECAP_ISR_SOURCE_CAPTURE_EVENT_1 0x2U
#define ECAP_ISR_SOURCE_CAPTURE_EVENT_2 0x4U

typedef enum {
    ECAP_EMULATION_STOP = 0x0,
    ECAP_EMULATION_RUN_TO_ZERO = 0x1,
    ECAP_EMULATION_FREE_RUN = 0x2
} ECAP_EmulationMode;

typedef enum { ECAP_CONTINUOUS_CAPTURE_MODE = 0, ECAP_ONE_SHOT_CAPTURE_MODE = 1 } ECAP_CaptureMode;

typedef enum { ECAP_EVENT_1 = 0, ECAP_EVENT_2 = 1, ECAP_EVENT_3 = 2, ECAP_EVENT_4 = 3 } ECAP_Events;

typedef enum { ECAP_EVNT_RISING_EDGE = 0, ECAP_EVNT_FALLING_EDGE = 1 } ECAP_EventPolarity;

void ECAP_setEmulationMode(uint32_t base, ECAP_EmulationMode mode);
void ECAP_enableCaptureMode(uint32_t base);
void ECAP_setCaptureMode(uint32_t base, ECAP_CaptureMode mode, ECAP_Events event);
void ECAP_setEventPolarity(uint32_t base, ECAP_Events event, ECAP_EventPolarity polarity);
void ECAP_enableTimeStampCapture(uint32_t base);
void ECAP_startCounter(uint32_t base);
/* The next event is event 1, and captures load again. A stopped sequence stays as it is until then. */
void ECAP_reArm(uint32_t base);

/* Flags of the events, whether or not an interrupt is enabled. They stay until they are cleared. */
uint16_t ECAP_getInterruptSource(uint32_t base);
void ECAP_clearInterrupt(uint32_t base, uint16_t intFlags);
/* Periods of SYSCLK at that event; wraps. */
uint32_t ECAP_getEventTimeStamp(uint32_t base, ECAP_Events event);

#endif
