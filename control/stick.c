/* What breaks: a control cycle of 108 ms sees each fifth pulse. Then a stick that is waggled looks like
 * noise, and does not count until it rests. */
#include "control/stick.h"

#include <math.h>

#include "control/between.h"
#include "control/median.h"

/* ArduPilot, RC_Channel.cpp: the range of RC_MIN and RC_MAX. */
#define SHORTEST_US 800.0F
#define LONGEST_US 2200.0F /* the same */
#define TRAVEL_US 400.0F   /* from the middle to an end, at a remote control's delivered travel of 100 % */
#define PULSE_S 0.02F      /* period of a remote control's pulses */
#define SILENT_S 0.35F     /* two control cycles of 150 ms at most, a pulse of 20 ms, rounded up */
#define WANDER_SHARE (PULSE_S / SILENT_S) /* over the time after which silence is noticed */
#define NOISY_US 100.0F            /* chosen: a hand that moves the stick from end to end in 0.2 s has 80 */
#define QUIET_US (0.5F * NOISY_US) /* hysteresis */

static void hear(stick_t *stick, float pulse_us)
{
    const uint16_t latest = (uint16_t)((stick->next + STICK_PULSES - 1U) % STICK_PULSES);

    if (stick->count > 0U) {
        const float change_us = fabsf(pulse_us - stick->pulses_us[latest]);
        stick->wander_us += WANDER_SHARE * (change_us - stick->wander_us);
    }
    stick->noisy = stick->wander_us > (stick->noisy ? QUIET_US : NOISY_US);
    stick->pulses_us[stick->next] = pulse_us;
    stick->next = (uint16_t)((stick->next + 1U) % STICK_PULSES);
    stick->count = (uint16_t)(stick->count + ((stick->count < STICK_PULSES) ? 1U : 0U));
    stick->silence_s = 0.0F;
}

void stick_step(stick_t *stick, bool came, float pulse_us, float step_s)
{
    stick->silence_s = at_most(stick->silence_s + step_s, SILENT_S);
    if (came && pulse_us >= SHORTEST_US && pulse_us <= LONGEST_US) {
        hear(stick, pulse_us);
    } else if (stick->silence_s >= SILENT_S) {
        stick->count = 0U;
        stick->wander_us = 0.0F;
        stick->noisy = false;
    }
}

bool stick_is_good(const stick_t *stick)
{
    return stick->count == STICK_PULSES && !stick->noisy;
}

float stick_pulse_us(const stick_t *stick)
{
    return median_of(stick->pulses_us, STICK_PULSES);
}

float stick_up(const stick_t *stick, float middle_us)
{
    return between(-1.0F, (middle_us - stick_pulse_us(stick)) / TRAVEL_US, 1.0F);
}
