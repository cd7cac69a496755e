/* Two tables choose the mode from the supervisor's state: one with an estimate, one without.
 * What breaks: a state without a row in both tables is IDLE: no thrust, so the vehicle falls. */
#include "control/modes.h"

/* For states flown without an estimate. */
static const flight_mode_t modes_without_estimate[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = FLIGHT_MODE_IDLE,     [FLIGHT_TAKEOFF] = FLIGHT_MODE_LAW,
    [FLIGHT_FLYING] = FLIGHT_MODE_LAW,      [FLIGHT_FLOATING] = FLIGHT_MODE_FLOAT,
    [FLIGHT_COASTING] = FLIGHT_MODE_HOVER,  [FLIGHT_DESCENDING] = FLIGHT_MODE_BLIND_DESCENT,
    [FLIGHT_LANDING] = FLIGHT_MODE_DESCENT, [FLIGHT_LOWERING] = FLIGHT_MODE_DESCENT,
    [FLIGHT_CUT] = FLIGHT_MODE_IDLE,
};
static const flight_mode_t modes_with_estimate[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = FLIGHT_MODE_IDLE,       [FLIGHT_TAKEOFF] = FLIGHT_MODE_EST_HOLD,
    [FLIGHT_FLYING] = FLIGHT_MODE_EST_HOLD,   [FLIGHT_FLOATING] = FLIGHT_MODE_EST_HOLD,
    [FLIGHT_COASTING] = FLIGHT_MODE_EST_HOLD, [FLIGHT_DESCENDING] = FLIGHT_MODE_EST_SINK,
    [FLIGHT_LANDING] = FLIGHT_MODE_EST_LAND,  [FLIGHT_LOWERING] = FLIGHT_MODE_EST_LAND,
    [FLIGHT_CUT] = FLIGHT_MODE_IDLE,
};

control_law_t modes_law(const parameters_t *parameters, bool estimated)
{
    const control_law_t wanted = (control_law_t)parameters_choice(parameters, PARAMETER_LAW);

    return (wanted == LAW_EST && !estimated) ? LAW_PIDT : wanted;
}

/* True when the present state flies by the estimate. In TAKEOFF and FLYING the chosen law decides. In the
 * other states the estimate is used whenever there is one that the heights do not contradict. */
static bool uses_estimate(const supervisor_t *supervisor, const mode_choice_t *choice)
{
    switch (supervisor->state) {
    case FLIGHT_TAKEOFF:
    case FLIGHT_FLYING:
        return choice->law == LAW_EST;
    case FLIGHT_COASTING:
        return choice->law == LAW_EST || (choice->airborne && choice->estimated);
    case FLIGHT_LANDING:
    case FLIGHT_LOWERING:
        return choice->estimated && supervisor_has_estimate(supervisor);
    default:
        return choice->estimated;
    }
}

/* While the pilot has the throttle the command is the hover thrust, so that the hand-back does not cut the
 * motors. */
flight_mode_t modes_select(const supervisor_t *supervisor, const evidence_t *evidence,
                           const mode_choice_t *choice)
{
    const flight_state_t state = supervisor->state;

    if (state == FLIGHT_FLOATING && !choice->has_throttle) {
        return FLIGHT_MODE_HOVER;
    }
    if (state == FLIGHT_COASTING && choice->estimated && choice->airborne && doubts(evidence, DOUBT_SIGHT)) {
        return FLIGHT_MODE_EST_SINK; /* the last heights were wrong: do not hold them */
    }
    return (uses_estimate(supervisor, choice) ? modes_with_estimate : modes_without_estimate)[state];
}

bool modes_use_estimate(flight_mode_t mode)
{
    return mode == FLIGHT_MODE_EST_HOLD || mode == FLIGHT_MODE_EST_LAND || mode == FLIGHT_MODE_EST_SINK;
}

bool modes_hold(flight_mode_t mode)
{
    return mode == FLIGHT_MODE_EST_HOLD || mode == FLIGHT_MODE_FLOAT;
}

bool modes_hold_reference(flight_mode_t mode, control_law_t law)
{
    return mode == FLIGHT_MODE_EST_HOLD || (mode == FLIGHT_MODE_LAW && law == LAW_PIDT);
}
