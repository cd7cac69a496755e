#include "flight.h"

#include <math.h>

#include "thrust.h"

#define HOVER_MARGIN_N 1.5F
#define HOVER_TIME_S 2.5F
#define BRIDGE_TIME_S 0.4F
#define BRIDGE_START_N 0.5F
#define STEP_MAX_S 0.5F
#define GAP_MAX_S 0.3F
#define BLIND_MAX_S 60.0F

typedef enum { CHARGE_IDLE, CHARGE_LAW, CHARGE_HOVER, CHARGE_DESCENT, CHARGE_BLIND } charge_t;

static const charge_t in_charge[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = CHARGE_IDLE,      [FLIGHT_TAKEOFF] = CHARGE_LAW,      [FLIGHT_FLYING] = CHARGE_LAW,
    [FLIGHT_FLOATING] = CHARGE_HOVER,   [FLIGHT_COASTING] = CHARGE_HOVER,   [FLIGHT_DESCENDING] = CHARGE_BLIND,
    [FLIGHT_LANDING] = CHARGE_DESCENT,  [FLIGHT_LOWERING] = CHARGE_DESCENT,
};

void flight_init(flight_t *flight)
{
    *flight = (flight_t){.hover_n = 0.0F};
    supervisor_init(&flight->supervisor);
}

static float between(float lowest, float value, float highest)
{
    return fminf(fmaxf(value, lowest), highest);
}

static float seconds(uint32_t time_us, float at_most_s)
{
    return fminf((float)time_us * 1.0e-6F, at_most_s);
}

static void keep_hover(flight_t *flight, float gravity_n)
{
    const flight_state_t state = flight->supervisor.state;

    if (state == FLIGHT_GROUND || state == FLIGHT_TAKEOFF || state == FLIGHT_FLOATING) {
        flight->hover_n = gravity_n;
    } else if (state == FLIGHT_FLYING) {
        const float share = seconds(flight->supervisor.step_us, STEP_MAX_S) / HOVER_TIME_S;
        flight->hover_n += share * (flight->thrust_n - flight->hover_n);
    }
    flight->hover_n = between(gravity_n - HOVER_MARGIN_N, flight->hover_n, gravity_n + HOVER_MARGIN_N);
    flight->hover_n = between(0.0F, flight->hover_n, THRUST_MAX_N);
}

/* Another is in charge. The law keeps its integral action through COASTING alone. */
static void hand_over(flight_t *flight, charge_t before, charge_t now)
{
    if (before == CHARGE_DESCENT) {
        flight->hover_n += flight->descent.trim_n;
    }
    if (now == CHARGE_DESCENT) {
        descent_start(&flight->descent, flight->supervisor.height.rate_mm_s);
    }
    if (now == CHARGE_LAW) {
        pid_resume(&flight->law);
    } else if (now != CHARGE_HOVER) {
        pid_reset(&flight->law);
    }
}

/* Returns true when the law has gained or lost its integral action since its previous sample. */
static bool step_law(flight_t *flight, const parameters_t *parameters)
{
    const height_track_t *height = &flight->supervisor.height;
    const float *value = parameters->value;
    const pid_gains_t gains = {
        .kp_n_per_mm = value[PARAMETER_KP],
        .kd_n_per_mm = value[PARAMETER_KD],
        .ki_n_per_mm = (value[PARAMETER_LAW] == (float)LAW_PID) ? value[PARAMETER_KI] : 0.0F,
        .gravity_n = value[PARAMETER_GRAV],
        .ascension_n = value[PARAMETER_USAT],
        .descension_n = value[PARAMETER_DSAT],
    };
    const bool every_release = value[PARAMETER_RELEASE] == (float)RELEASE_FREE;
    const bool had_integral = flight->integral;

    if (!every_release && !height->is_new && flight->law.primed) {
        return false;
    }
    flight->wanted_n = pid_step(&flight->law, &gains, flight->supervisor.reference_m * 1000.0F - height->height_mm);
    flight->integral = gains.ki_n_per_mm > 0.0F;
    return flight->integral != had_integral;
}

static void step_descent(flight_t *flight, bool started)
{
    const height_track_t *height = &flight->supervisor.height;
    const float gap_s = height->is_new ? seconds(height->gap_us, GAP_MAX_S) : 0.0F;

    if (height->is_new || started) {
        flight->wanted_n =
            descent_step(&flight->descent, flight->hover_n, height->height_mm, height->rate_mm_s, gap_s);
    }
}

/* What the one in charge wants. Returns true when it is the law and the law has changed. */
static bool decide(flight_t *flight, const parameters_t *parameters, charge_t before, charge_t now)
{
    switch (now) {
    case CHARGE_LAW:
        return step_law(flight, parameters);
    case CHARGE_HOVER:
        flight->wanted_n = flight->hover_n;
        break;
    case CHARGE_DESCENT:
        step_descent(flight, before != now);
        break;
    case CHARGE_BLIND:
        flight->wanted_n = descent_blind(flight->hover_n, seconds(flight->supervisor.state_us, BLIND_MAX_S));
        break;
    case CHARGE_IDLE:
    default:
        flight->wanted_n = 0.0F;
        break;
    }
    return false;
}

static void bridge(flight_t *flight, charge_t before, charge_t now, bool law_changed)
{
    const float hover_n = flight->hover_n;

    if (before != now && (before == CHARGE_IDLE || now == CHARGE_IDLE || now == CHARGE_DESCENT)) {
        flight->bridge_n = 0.0F;
    } else if (before != now) {
        flight->bridge_n =
            between(hover_n - BRIDGE_START_N, flight->thrust_n, hover_n + BRIDGE_START_N) - flight->wanted_n;
    } else if (law_changed) {
        flight->bridge_n = flight->thrust_n - flight->wanted_n;
    } else {
        flight->bridge_n *= BRIDGE_TIME_S / (BRIDGE_TIME_S + seconds(flight->supervisor.step_us, STEP_MAX_S));
    }
}

void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in, flight_outputs_t *out)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const charge_t before = in_charge[supervisor->state];

    supervisor_step(&flight->supervisor, parameters->value[PARAMETER_LINK], in);
    const charge_t now = in_charge[supervisor->state];
    if (before != now) {
        hand_over(flight, before, now);
    }
    keep_hover(flight, parameters->value[PARAMETER_GRAV]);
    const bool law_changed = decide(flight, parameters, before, now);
    bridge(flight, before, now, law_changed);
    flight->thrust_n = between(0.0F, flight->wanted_n + flight->bridge_n, THRUST_MAX_N);

    out->thrust_n = flight->thrust_n;
    out->pulse_us = thrust_to_pulse_us(flight->thrust_n);
    out->state = supervisor->state;
    out->flags = supervisor->flags;
    out->reference_m = supervisor->reference_m;
}
