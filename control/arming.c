#include "control/arming.h"

#include "control/thrust.h"

static void obey(arming_t *arming, const flight_inputs_t *in, flight_state_t state)
{
    if (in->arm_sequence == arming->sequence) {
        return;
    }
    arming->sequence = in->arm_sequence;
    arming->armed = arming->armed || (in->arm && state == FLIGHT_GROUND);
    arming->ending = arming->armed && !in->arm;
    arming->hands_over = in->arm;
}

static bool fault(flight_state_t before, const supervisor_t *supervisor)
{
    const flight_state_t state = supervisor->state;
    const bool blind = before == FLIGHT_DESCENDING && state == FLIGHT_GROUND;
    const bool alarmed = (supervisor->flags & (FLIGHT_FLAG_LINK | FLIGHT_FLAG_TILT)) != 0U;

    return state == FLIGHT_CUT || blind || (state == FLIGHT_GROUND && alarmed);
}

void arming_step(arming_t *arming, const flight_inputs_t *in, flight_state_t before,
                 const supervisor_t *supervisor)
{
    const flight_state_t state = supervisor->state;

    obey(arming, in, state);
    arming->ending = arming->ending && !(supervisor->reference_m > 0.0F);
    if ((arming->ending && state == FLIGHT_GROUND) || fault(before, supervisor)) {
        arming->armed = false;
        arming->ending = false;
    }
    arming->hands_over = arming->hands_over && arming->armed && state == FLIGHT_GROUND;
}

float arming_idle_n(const arming_t *arming, float idle_percent, flight_state_t state)
{
    return (arming->armed && state != FLIGHT_CUT) ? thrust_of_percent(idle_percent) : 0.0F;
}
