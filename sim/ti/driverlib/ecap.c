#include "ecap.h"

#include <stdbool.h>
#include <string.h>

#include "cpu.h"
#include "sim/ti/driverlib/model.h"
#include "sysctl.h"
#include "xbar.h"

#define EVENTS 4U
#define NO_PIN UINT32_MAX /* input 7 reads GPIO0 after a reset, which has no leg on this package */

static struct {
    uint32_t pin; /* that input 7 of the X-BAR leads here */
    bool one_shot, loads, runs, stopped;
    ECAP_Events last, next;
    ECAP_EventPolarity polarity[EVENTS];
    uint32_t stamps[EVENTS];
    uint16_t flags;
    sim_time_t started;
} ecap;

void ecap_reset(void)
{
    memset(&ecap, 0, sizeof ecap);
    ecap.pin = NO_PIN;
    ecap.last = ECAP_EVENT_4;
    ecap.stopped = true;
}

static bool reached(uint32_t base)
{
    if (base != ECAP1_BASE) {
        chip_unmodelled("an eCAP other than eCAP1");
    }
    return sysctl_clocked(SYSCTL_PERIPH_CLK_ECAP1);
}

static uint32_t now(void)
{
    return (uint32_t)((double)(timeline_now() - ecap.started) * 1e-9 * sysctl_sysclk_hz() + 0.5);
}

void ecap_pin_changed(uint32_t pin, bool level)
{
    const bool hears = pin == ecap.pin && sysctl_clocked(SYSCTL_PERIPH_CLK_ECAP1) && ecap.runs && ecap.loads;

    if (!hears || ecap.stopped || level != (ecap.polarity[ecap.next] == ECAP_EVNT_RISING_EDGE)) {
        return;
    }
    ecap.stamps[ecap.next] = now();
    ecap.flags |= (uint16_t)(ECAP_ISR_SOURCE_CAPTURE_EVENT_1 << ecap.next);
    if (ecap.next == ecap.last) {
        ecap.stopped = true;
    } else {
        ecap.next = (ECAP_Events)(ecap.next + 1);
    }
}

void XBAR_setInputPin(XBAR_InputNum input, uint16_t pin)
{
    EALLOW;
    if (input != XBAR_INPUT7) {
        chip_unmodelled("an input of the X-BAR other than input 7");
    }
    ecap.pin = pin;
    EDIS;
}

void ECAP_setEmulationMode(uint32_t base, ECAP_EmulationMode mode)
{
    (void)reached(base);
    (void)mode;
}

void ECAP_enableCaptureMode(uint32_t base)
{
    (void)reached(base); /* as after a reset; the other mode is not modelled */
}

void ECAP_setCaptureMode(uint32_t base, ECAP_CaptureMode mode, ECAP_Events event)
{
    if (mode != ECAP_ONE_SHOT_CAPTURE_MODE || event != ECAP_EVENT_2) {
        chip_unmodelled("an eCAP that does not stop at event 2");
    }
    if (reached(base)) {
        ecap.one_shot = true;
        ecap.last = event;
    }
}

void ECAP_setEventPolarity(uint32_t base, ECAP_Events event, ECAP_EventPolarity polarity)
{
    if (reached(base)) {
        ecap.polarity[event] = polarity;
    }
}

void ECAP_enableTimeStampCapture(uint32_t base)
{
    ecap.loads = ecap.loads || reached(base);
}

void ECAP_startCounter(uint32_t base)
{
    if (reached(base) && !ecap.runs) {
        ecap.runs = true;
        ecap.started = timeline_now();
    }
}

void ECAP_reArm(uint32_t base)
{
    if (reached(base)) {
        if (!ecap.one_shot) {
            chip_unmodelled("an eCAP that captures without end");
        }
        ecap.next = ECAP_EVENT_1;
        ecap.stopped = false;
    }
}

uint16_t ECAP_getInterruptSource(uint32_t base)
{
    return reached(base) ? ecap.flags : 0U;
}

void ECAP_clearInterrupt(uint32_t base, uint16_t intFlags)
{
    if (reached(base)) {
        ecap.flags &= (uint16_t)~intFlags;
    }
}

uint32_t ECAP_getEventTimeStamp(uint32_t base, ECAP_Events event)
{
    return reached(base) ? ecap.stamps[event] : 0U;
}
