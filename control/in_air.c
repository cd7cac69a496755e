/* One window per parameter: within it the value stays near the one at its begin. All further rules follow
 * from what a parameter does to the thrust of a hover. */
#include "control/in_air.h"

#include <math.h>

#include "control/where/hover_thrust.h"

#define WINDOW_US ((uint32_t)(4.0e6F * HOVER_TIME_S)) /* 98 % of a hover thrust is learned anew */
#define STEP_N 0.2F   /* chosen: PD then hangs 43 mm lower with the least KP that flew, 0.00466 */
#define SHARE 0.25F   /* chosen: half of what makes a loop swing that is tuned to half its limit */
#define MARGIN_N 0.3F /* chosen: 0.4 m/s2 to brake with */

typedef enum { FREE, GROUND_ONLY, NEWTONS, GAIN, LAW } kind_t;

/* What is not named is 0, FREE; but the mirrors are not. */
static const kind_t kinds[PARAMETER_COUNT] = {
    [PARAMETER_GRAV] = NEWTONS,
    [PARAMETER_USAT] = NEWTONS,
    [PARAMETER_DSAT] = NEWTONS,
    [PARAMETER_KP] = GAIN,
    [PARAMETER_KD] = GAIN,
    [PARAMETER_KI] = GAIN,
    [PARAMETER_PKP] = GAIN,
    [PARAMETER_PKI] = GAIN,
    [PARAMETER_PKD] = GAIN,
    [PARAMETER_POSK] = GAIN,
    [PARAMETER_VELK] = GAIN,
    [PARAMETER_CRATE] = GAIN, /* the vehicle's model: law EST divides by it */
    [PARAMETER_GAIN] = GAIN,
    [PARAMETER_LAG] = GAIN,
    [PARAMETER_DELAY] = GAIN,
    [PARAMETER_DAMP] = GAIN,
    [PARAMETER_CLAG] = GAIN,
    [PARAMETER_LAW] = LAW,
    [PARAMETER_SEL] = GROUND_ONLY, /* decides who has the throttle */
    [PARAMETER_STICK] = GROUND_ONLY,
    [PARAMETER_SMID] = GROUND_ONLY,
    [PARAMETER_CELLS] = GROUND_ONLY, /* but BAT NONE ends what a wrong voltage orders, at any time */
    [PARAMETER_VDIV] = GROUND_ONLY,
    [PARAMETER_IROLL] = GROUND_ONLY,
    [PARAMETER_IPITCH] = GROUND_ONLY,
    [PARAMETER_IDOWN] = GROUND_ONLY,
    [PARAMETER_IUNIT] = GROUND_ONLY,
};

/* With the mirrors' places the height would jump. */
static kind_t kind_of(parameter_id_t id)
{
    return parameter_table[id].group == PARAMETERS_MIRRORS ? GROUND_ONLY : kinds[id];
}

static bool gives_gravity_alone(const parameters_t *parameters)
{
    return parameters->value[PARAMETER_USAT] == 0.0F && parameters->value[PARAMETER_DSAT] == 0.0F;
}

/* What the laws PD and PID can add to the hover thrust, or take away: the less of both. */
static float margin_n(const parameters_t *parameters, float hover_n)
{
    const float *value = parameters->value;
    const float above_n = value[PARAMETER_GRAV] + value[PARAMETER_USAT] - hover_n;
    const float below_n = hover_n - (value[PARAMETER_GRAV] - value[PARAMETER_DSAT]);

    return (above_n < below_n) ? above_n : below_n;
}

static in_air_t judge_newtons(const parameters_t *now, parameter_id_t id, float from, float to, float hover_n)
{
    const bool alone = gives_gravity_alone(now);
    parameters_t then = *now;

    then.value[id] = to;
    const float off_n = fabsf(then.value[PARAMETER_GRAV] - hover_n);
    /* Towards it is fine: a battery may have taken the hover thrust away from it. */
    if (off_n > HOVER_THRUST_MARGIN_N && off_n >= fabsf(now->value[PARAMETER_GRAV] - hover_n)) {
        return IN_AIR_OFF_HOVER;
    }
    if (alone && id == PARAMETER_GRAV) {
        return IN_AIR_FINE;
    }
    if (fabsf(to - from) > STEP_N || fabsf(to - now->value[id]) > STEP_N) {
        return IN_AIR_TOO_MANY_N;
    }
    const float left_n = margin_n(&then, hover_n);
    return (left_n < MARGIN_N && left_n < margin_n(now, hover_n)) ? IN_AIR_OFF_HOVER : IN_AIR_FINE;
}

static in_air_t judge(const parameters_t *now, const in_air_window_t *window, parameter_id_t id, float to,
                      float hover_n)
{
    const float value = now->value[id];
    const float from = window->open ? window->from : value;

    switch (kind_of(id)) {
    case GROUND_ONLY:
        return IN_AIR_NEVER;
    case NEWTONS:
        return judge_newtons(now, id, from, to, hover_n);
    case GAIN:
        return (fabsf(to - from) > SHARE * from || fabsf(to - value) > SHARE * value) ? IN_AIR_OVER_QUARTER
                                                                                      : IN_AIR_FINE;
    case LAW:
        return (window->open && to != (float)LAW_EST) ? IN_AIR_TOO_OFTEN : IN_AIR_FINE;
    case FREE:
    default:
        return IN_AIR_FINE;
    }
}

in_air_t in_air_change(in_air_pace_t *pace, const parameters_t *parameters, parameter_id_t id, float to,
                       float hover_n, uint32_t now_us)
{
    in_air_window_t *window = &pace->window[id];

    window->open = window->open && now_us - window->since_us < WINDOW_US;
    if (to == parameters->value[id]) {
        return IN_AIR_FINE;
    }
    const in_air_t verdict = judge(parameters, window, id, to, hover_n);
    if (verdict == IN_AIR_FINE && !window->open) {
        *window = (in_air_window_t){.open = true, .from = parameters->value[id], .since_us = now_us};
    }
    return verdict;
}
