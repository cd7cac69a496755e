#include "control/flight.h"

#include <math.h>

#include "control/between.h"
#include "control/thrust.h"

#define HOVER_MARGIN_N 1.5F
#define HOVER_TIME_S 2.5F
#define BRIDGE_TIME_S 0.4F
#define BRIDGE_START_N 0.5F
#define STEP_MAX_S 0.5F
#define GAP_MAX_S 0.3F
#define BLIND_MAX_S 60.0F

#define PIDT_WINDOW_N 3.0F

/* Without an estimate, or by a law that needs none. */
static const flight_charge_t charges[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = CHARGE_IDLE,      [FLIGHT_TAKEOFF] = CHARGE_LAW,      [FLIGHT_FLYING] = CHARGE_LAW,
    [FLIGHT_FLOATING] = CHARGE_HOVER,   [FLIGHT_COASTING] = CHARGE_HOVER,   [FLIGHT_DESCENDING] = CHARGE_BLIND,
    [FLIGHT_LANDING] = CHARGE_DESCENT,  [FLIGHT_LOWERING] = CHARGE_DESCENT, [FLIGHT_CUT] = CHARGE_IDLE,
};
static const flight_charge_t charges_est[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = CHARGE_IDLE,      [FLIGHT_TAKEOFF] = CHARGE_HOLD,     [FLIGHT_FLYING] = CHARGE_HOLD,
    [FLIGHT_FLOATING] = CHARGE_HOVER,   [FLIGHT_COASTING] = CHARGE_HOLD,    [FLIGHT_DESCENDING] = CHARGE_SINK,
    [FLIGHT_LANDING] = CHARGE_LAND,     [FLIGHT_LOWERING] = CHARGE_LAND,    [FLIGHT_CUT] = CHARGE_IDLE,
};

void flight_init(flight_t *flight)
{
    *flight = (flight_t){.hover_n = 0.0F};
    supervisor_init(&flight->supervisor);
    est_law_init(&flight->est);
}

static bool is_est(flight_charge_t charge)
{
    return charge == CHARGE_HOLD || charge == CHARGE_LAND || charge == CHARGE_SINK;
}

static float seconds(uint32_t time_us, float at_most_s)
{
    return fminf((float)time_us * 1.0e-6F, at_most_s);
}

static void keep_hover(flight_t *flight, float gravity_n)
{
    const flight_state_t state = flight->supervisor.state;
    const bool grounded = state == FLIGHT_GROUND || state == FLIGHT_TAKEOFF;

    flight->weighed = !grounded && (flight->weighed || state == FLIGHT_FLYING);
    if (!flight->weighed && (grounded || state == FLIGHT_FLOATING)) {
        flight->hover_n = gravity_n;
    } else if (est_law_ready(&flight->est) && flight->est.lifted) {
        flight->hover_n = flight->est.hover.thrust_n;
    } else if (state == FLIGHT_FLYING) {
        const float share = seconds(flight->supervisor.step_us, STEP_MAX_S) / HOVER_TIME_S;
        flight->hover_n += share * (flight->thrust_n - flight->hover_n);
    }
    flight->hover_n = between(gravity_n - HOVER_MARGIN_N, flight->hover_n, gravity_n + HOVER_MARGIN_N);
    flight->hover_n = between(0.0F, flight->hover_n, THRUST_MAX_N);
}

/* Another is in charge. The law keeps its integral action through COASTING alone. */
static void hand_over(flight_t *flight, flight_charge_t before, flight_charge_t now)
{
    if (before == CHARGE_DESCENT) {
        flight->hover_n += flight->descent.trim_n;
    }
    if (now == CHARGE_DESCENT) {
        descent_start(&flight->descent, flight->supervisor.height.rate_mm_s);
    }
    if (now == CHARGE_LAW) {
        pid_resume(&flight->law);
        pidt_resume(&flight->pidt);
    } else if (flight->supervisor.state != FLIGHT_COASTING) {
        pid_reset(&flight->law);
        pidt_reset(&flight->pidt);
    }
    if (is_est(now) && !is_est(before) && before != CHARGE_IDLE) {
        est_law_take_over(&flight->est, flight->thrust_n, flight->hover_n);
    }
}

static float reference_mm(const flight_t *flight)
{
    return flight->supervisor.reference_m * 1000.0F;
}

/* Returns true when the law has gained or lost its integral action since its previous sample. */
static bool step_pid(flight_t *flight, const parameters_t *parameters)
{
    const height_track_t *height = &flight->supervisor.height;
    const float *value = parameters->value;
    const pid_gains_t gains = {
        .kp_n_per_mm = value[PARAMETER_KP],
        .kd_n_per_mm = value[PARAMETER_KD],
        .ki_n_per_mm = (flight->flown == LAW_PID) ? value[PARAMETER_KI] : 0.0F,
        .gravity_n = value[PARAMETER_GRAV],
        .ascension_n = value[PARAMETER_USAT],
        .descension_n = value[PARAMETER_DSAT],
    };
    const bool every_release = value[PARAMETER_RELEASE] == (float)RELEASE_FREE;
    const bool had_integral = flight->integral;

    if (!every_release && !height->is_new && flight->law.primed) {
        return false;
    }
    flight->wanted_n = pid_step(&flight->law, &gains, reference_mm(flight) - height->height_mm);
    flight->integral = gains.ki_n_per_mm > 0.0F;
    return flight->integral != had_integral;
}

static void step_pidt(flight_t *flight, const parameters_t *parameters)
{
    const height_track_t *height = &flight->supervisor.height;
    const float *value = parameters->value;
    const pidt_gains_t gains = {
        .kp_n_per_m = value[PARAMETER_PKP],
        .ki_n_per_m_s = value[PARAMETER_PKI],
        .kd_n_s_per_m = value[PARAMETER_PKD],
        .gravity_n = value[PARAMETER_GRAV],
        .most_n = fminf(value[PARAMETER_GRAV] + PIDT_WINDOW_N, THRUST_MAX_N),
        .least_n = fmaxf(value[PARAMETER_GRAV] - PIDT_WINDOW_N, 0.0F),
    };

    if (height->is_new || !flight->pidt.primed) {
        const uint32_t rays_us = flight->est.rays_us;
        flight->wanted_n = pidt_step(&flight->pidt, &gains, flight->supervisor.reference_m,
                                     height->height_mm * 0.001F, seconds(rays_us - flight->pidt_rays_us, GAP_MAX_S));
        flight->pidt_rays_us = rays_us;
    }
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

/* What the one in charge wants. Returns true when it is the law and its integral action came or went. */
static bool decide(flight_t *flight, const parameters_t *parameters, bool new_charge)
{
    const float reference_m = flight->supervisor.reference_m;

    switch (flight->charge) {
    case CHARGE_LAW:
        if (flight->flown != LAW_PIDT) {
            return step_pid(flight, parameters);
        }
        step_pidt(flight, parameters);
        break;
    case CHARGE_HOLD:
        flight->wanted_n = est_law_step(&flight->est, parameters, EST_HOLD, reference_m);
        break;
    case CHARGE_LAND:
        flight->wanted_n = est_law_step(&flight->est, parameters, EST_LAND, 0.0F);
        break;
    case CHARGE_SINK:
        flight->wanted_n = est_law_step(&flight->est, parameters, EST_SINK, 0.0F);
        break;
    case CHARGE_HOVER:
        flight->wanted_n = flight->hover_n;
        break;
    case CHARGE_DESCENT:
        step_descent(flight, new_charge);
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

static void bridge(flight_t *flight, flight_charge_t before, bool law_changed)
{
    const flight_charge_t now = flight->charge;
    const float hover_n = flight->hover_n;
    const bool other = before != now && !(is_est(before) && is_est(now));

    if (other && (before == CHARGE_IDLE || now == CHARGE_IDLE || now == CHARGE_DESCENT || now == CHARGE_LAND)) {
        flight->bridge_n = 0.0F;
    } else if (law_changed) {
        flight->bridge_n = flight->thrust_n - flight->wanted_n;
    } else if (other) {
        flight->bridge_n =
            between(hover_n - BRIDGE_START_N, flight->thrust_n, hover_n + BRIDGE_START_N) - flight->wanted_n;
    } else {
        flight->bridge_n *= BRIDGE_TIME_S / (BRIDGE_TIME_S + seconds(flight->supervisor.step_us, STEP_MAX_S));
    }
}

static void supervise(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const estimator_t *estimator = &flight->est.estimator;
    const estimate_t *now = &estimator->now;

    est_law_listen(&flight->est, parameters, in->frames, in->frame_count, in->now_us);
    const vertical_estimate_t estimate = {
        .known = est_law_ready(&flight->est) && estimator->confirmed,
        .height_mm = now->height_m * 1000.0F,
        .climb_mm_s = (now->speed_mps - now->terrain_mps) * 1000.0F,
    };
    supervisor_step(&flight->supervisor, parameters->value[PARAMETER_LINK], in, &estimate);
}

static void see(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const flight_state_t state = flight->supervisor.state;
    const bool at_rest = state == FLIGHT_GROUND && flight->supervisor.rest.on;

    if (flight->supervisor.height.is_new) {
        est_law_see(&flight->est, &in->altitude, in->height_stamp_ms, in->height_time_us, at_rest);
    }
    if (state == FLIGHT_GROUND) {
        est_law_stand(&flight->est, parameters);
    } else if (state == FLIGHT_FLOATING) {
        est_law_let_go(&flight->est);
    } else if (state == FLIGHT_FLYING && flight->charge == CHARGE_LAW && !flight->est.lifted) {
        est_law_take_over(&flight->est, flight->thrust_n, flight->hover_n);
    }
}

/* The law that is flown. Returns true when it is another than before. */
static bool choose_law(flight_t *flight, const parameters_t *parameters)
{
    const control_law_t before = flight->flown;
    const control_law_t wanted = (control_law_t)(uint16_t)parameters->value[PARAMETER_LAW];

    flight->flown = (wanted == LAW_EST && !est_law_ready(&flight->est)) ? LAW_PIDT : wanted;
    return flight->flown != before;
}

/* Whether the state is flown by the estimate: a law as it was chosen, what the supervisor does by itself whenever there
 * is an estimate that heights, if there are any, do not contradict. */
static bool by_estimate(const flight_t *flight)
{
    switch (flight->supervisor.state) {
    case FLIGHT_TAKEOFF:
    case FLIGHT_FLYING:
        return flight->flown == LAW_EST;
    case FLIGHT_COASTING:
        return flight->flown == LAW_EST || (flight->est.lifted && est_law_ready(&flight->est));
    case FLIGHT_LANDING:
    case FLIGHT_LOWERING:
        return est_law_ready(&flight->est) && supervisor_estimated(&flight->supervisor);
    default:
        return est_law_ready(&flight->est);
    }
}

static void tell(const flight_t *flight, const parameters_t *parameters, flight_outputs_t *out)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const estimator_t *estimator = &flight->est.estimator;
    const bool estimated = flight->flown == LAW_EST || is_est(flight->charge);
    const bool deaf = parameters->value[PARAMETER_LAW] == (float)LAW_EST && !est_law_hears(&flight->est);
    const float measured_mm = (supervisor->height.sequence != 0U) ? supervisor->height.height_mm : NAN;

    out->thrust_n = flight->thrust_n;
    out->pulse_us = thrust_to_pulse_us(flight->thrust_n);
    out->state = supervisor->state;
    out->flags = (uint16_t)(supervisor->flags | (deaf ? FLIGHT_FLAG_ATTITUDE : 0U));
    out->reference_m = supervisor->reference_m;
    out->estimate_mm = estimated ? estimator->now.height_m * 1000.0F : measured_mm;
    out->innovation_mm = estimated ? estimator->innovation_m * 1000.0F : NAN;
    out->frame_releases = is_est(flight->charge);
}

void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in, flight_outputs_t *out)
{
    const flight_charge_t before = flight->charge;

    supervise(flight, parameters, in);
    see(flight, parameters, in);
    const bool other_law = choose_law(flight, parameters);
    flight->charge = by_estimate(flight) ? charges_est[flight->supervisor.state] : charges[flight->supervisor.state];
    if (before != flight->charge) {
        hand_over(flight, before, flight->charge);
    }
    keep_hover(flight, parameters->value[PARAMETER_GRAV]);
    const bool other_action = decide(flight, parameters, before != flight->charge);
    bridge(flight, before, other_law || other_action);
    flight->thrust_n = between(0.0F, flight->wanted_n + flight->bridge_n, THRUST_MAX_N);
    est_law_commanded(&flight->est, flight->thrust_n);
    tell(flight, parameters, out);
}
