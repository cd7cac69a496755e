#include "control/flight.h"

#include <math.h>

#include "control/between.h"
#include "control/thrust.h"

#define HOVER_MARGIN_N 1.5F
#define HOVER_TIME_S 2.5F
#define TRANSFER_TIME_S 0.4F
#define TRANSFER_START_N 0.5F
#define STEP_MAX_S 0.5F
#define GAP_MAX_S 0.3F
#define BLIND_MAX_S 60.0F

#define PIDT_WINDOW_N 3.0F

/* Without an estimate, or by a law that needs none. */
static const flight_mode_t modes_without_estimate[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = FLIGHT_MODE_IDLE,
    [FLIGHT_TAKEOFF] = FLIGHT_MODE_LAW,
    [FLIGHT_FLYING] = FLIGHT_MODE_LAW,
    [FLIGHT_FLOATING] = FLIGHT_MODE_HOVER,
    [FLIGHT_COASTING] = FLIGHT_MODE_HOVER,
    [FLIGHT_DESCENDING] = FLIGHT_MODE_BLIND_DESCENT,
    [FLIGHT_LANDING] = FLIGHT_MODE_DESCENT,
    [FLIGHT_LOWERING] = FLIGHT_MODE_DESCENT,
    [FLIGHT_CUT] = FLIGHT_MODE_IDLE,
};
static const flight_mode_t modes_with_estimate[FLIGHT_STATE_COUNT] = {
    [FLIGHT_GROUND] = FLIGHT_MODE_IDLE,
    [FLIGHT_TAKEOFF] = FLIGHT_MODE_EST_HOLD,
    [FLIGHT_FLYING] = FLIGHT_MODE_EST_HOLD,
    [FLIGHT_FLOATING] = FLIGHT_MODE_HOVER,
    [FLIGHT_COASTING] = FLIGHT_MODE_EST_HOLD,
    [FLIGHT_DESCENDING] = FLIGHT_MODE_EST_SINK,
    [FLIGHT_LANDING] = FLIGHT_MODE_EST_LAND,
    [FLIGHT_LOWERING] = FLIGHT_MODE_EST_LAND,
    [FLIGHT_CUT] = FLIGHT_MODE_IDLE,
};

void flight_init(flight_t *flight)
{
    *flight = (flight_t){.hover_n = 0.0F};
    supervisor_init(&flight->supervisor);
    est_law_init(&flight->est);
}

static bool is_est_mode(flight_mode_t mode)
{
    return mode == FLIGHT_MODE_EST_HOLD || mode == FLIGHT_MODE_EST_LAND || mode == FLIGHT_MODE_EST_SINK;
}

static float seconds(uint32_t time_us, float at_most_s)
{
    return fminf((float)time_us * 1.0e-6F, at_most_s);
}

static void update_hover(flight_t *flight, float gravity_n)
{
    const flight_state_t state = flight->supervisor.state;
    const bool grounded = state == FLIGHT_GROUND || state == FLIGHT_TAKEOFF;

    flight->hover_learned = !grounded && (flight->hover_learned || state == FLIGHT_FLYING);
    if (!flight->hover_learned && (grounded || state == FLIGHT_FLOATING)) {
        flight->hover_n = gravity_n;
    } else if (est_law_ready(&flight->est) && flight->est.airborne) {
        flight->hover_n = flight->est.hover.thrust_n;
    } else if (state == FLIGHT_FLYING) {
        const float share = seconds(flight->supervisor.step_us, STEP_MAX_S) / HOVER_TIME_S;
        flight->hover_n += share * (flight->thrust_n - flight->hover_n);
    }
    flight->hover_n = between(gravity_n - HOVER_MARGIN_N, flight->hover_n, gravity_n + HOVER_MARGIN_N);
    flight->hover_n = between(0.0F, flight->hover_n, THRUST_MAX_N);
}

/* The law keeps its integral action through COASTING alone. */
static void change_mode(flight_t *flight, flight_mode_t before, flight_mode_t now)
{
    if (before == FLIGHT_MODE_DESCENT) {
        flight->hover_n += flight->descent.trim_n;
    }
    if (now == FLIGHT_MODE_DESCENT) {
        descent_start(&flight->descent, flight->supervisor.height.rate_mm_s);
    }
    if (now == FLIGHT_MODE_LAW) {
        pid_resume(&flight->pid);
        pidt_resume(&flight->pidt);
    } else if (flight->supervisor.state != FLIGHT_COASTING) {
        pid_reset(&flight->pid);
        pidt_reset(&flight->pidt);
    }
    if (is_est_mode(now) && !is_est_mode(before) && before != FLIGHT_MODE_IDLE) {
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
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
        .ki_n_per_mm = (flight->active_law == LAW_PID) ? value[PARAMETER_KI] : 0.0F,
        .gravity_n = value[PARAMETER_GRAV],
        .ascension_n = value[PARAMETER_USAT],
        .descension_n = value[PARAMETER_DSAT],
    };
    const bool every_release = parameters_choice(parameters, PARAMETER_RELEASE) == RELEASE_FREE;
    const bool had_integral = flight->integral;

    if (!every_release && !height->is_new && flight->pid.primed) {
        return false;
    }
    flight->setpoint_n = pid_step(&flight->pid, &gains, reference_mm(flight) - height->height_mm);
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
        flight->setpoint_n = pidt_step(&flight->pidt, &gains, flight->supervisor.reference_m,
                                     height->height_mm * 0.001F, seconds(rays_us - flight->pidt_rays_us, GAP_MAX_S));
        flight->pidt_rays_us = rays_us;
    }
}

static void step_descent(flight_t *flight, bool started)
{
    const height_track_t *height = &flight->supervisor.height;
    const float gap_s = height->is_new ? seconds(height->gap_us, GAP_MAX_S) : 0.0F;

    if (height->is_new || started) {
        flight->setpoint_n =
            descent_step(&flight->descent, flight->hover_n, height->height_mm, height->rate_mm_s, gap_s);
    }
}

/* The thrust setpoint of the mode. Returns true when the law has gained or lost its integral action. */
static bool run_mode(flight_t *flight, const parameters_t *parameters, bool mode_changed)
{
    const float reference_m = flight->supervisor.reference_m;

    switch (flight->mode) {
    case FLIGHT_MODE_LAW:
        if (flight->active_law != LAW_PIDT) {
            return step_pid(flight, parameters);
        }
        step_pidt(flight, parameters);
        break;
    case FLIGHT_MODE_EST_HOLD:
        flight->setpoint_n = est_law_step(&flight->est, parameters, EST_MODE_HOLD, reference_m);
        break;
    case FLIGHT_MODE_EST_LAND:
        flight->setpoint_n = est_law_step(&flight->est, parameters, EST_MODE_LAND, 0.0F);
        break;
    case FLIGHT_MODE_EST_SINK:
        flight->setpoint_n = est_law_step(&flight->est, parameters, EST_MODE_SINK, 0.0F);
        break;
    case FLIGHT_MODE_HOVER:
        flight->setpoint_n = flight->hover_n;
        break;
    case FLIGHT_MODE_DESCENT:
        step_descent(flight, mode_changed);
        break;
    case FLIGHT_MODE_BLIND_DESCENT:
        flight->setpoint_n = descent_blind(flight->hover_n, seconds(flight->supervisor.state_us, BLIND_MAX_S));
        break;
    case FLIGHT_MODE_IDLE:
    default:
        flight->setpoint_n = 0.0F;
        break;
    }
    return false;
}

static void bumpless_transfer(flight_t *flight, flight_mode_t before, bool law_changed)
{
    const flight_mode_t now = flight->mode;
    const float hover_n = flight->hover_n;
    const bool changed = before != now && !(is_est_mode(before) && is_est_mode(now));
    const bool at_once = now == FLIGHT_MODE_IDLE || now == FLIGHT_MODE_DESCENT || now == FLIGHT_MODE_EST_LAND;

    if (changed && (at_once || before == FLIGHT_MODE_IDLE)) {
        flight->transfer_n = 0.0F;
    } else if (law_changed) {
        flight->transfer_n = flight->thrust_n - flight->setpoint_n;
    } else if (changed) {
        flight->transfer_n =
            between(hover_n - TRANSFER_START_N, flight->thrust_n, hover_n + TRANSFER_START_N) - flight->setpoint_n;
    } else {
        flight->transfer_n *= TRANSFER_TIME_S / (TRANSFER_TIME_S + seconds(flight->supervisor.step_us, STEP_MAX_S));
    }
}

static void supervise(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const estimator_t *estimator = &flight->est.estimator;
    const estimate_t *now = &estimator->now;

    est_law_predict(&flight->est, parameters, in->frames, in->frame_count, in->now_us);
    const vertical_estimate_t estimate = {
        .known = est_law_ready(&flight->est) && estimator->confirmed,
        .height_mm = now->height_m * 1000.0F,
        .climb_mm_s = (now->speed_mps - now->terrain_mps) * 1000.0F,
    };
    supervisor_step(&flight->supervisor, parameters->value[PARAMETER_LINK], in, &estimate);
}

static void update_estimator(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const flight_state_t state = flight->supervisor.state;
    const bool at_rest = state == FLIGHT_GROUND && flight->supervisor.rest.on;

    if (flight->supervisor.height.is_new) {
        est_law_fuse_height(&flight->est, &in->altitude, in->height_stamp_ms, in->height_time_us, at_rest);
    }
    if (state == FLIGHT_GROUND) {
        est_law_reset(&flight->est, parameters);
    } else if (state == FLIGHT_FLOATING) {
        est_law_disengage(&flight->est);
    } else if (state == FLIGHT_FLYING && flight->mode == FLIGHT_MODE_LAW && !flight->est.airborne) {
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
}

/* The law that is flown. Returns true when it is another than before. */
static bool select_law(flight_t *flight, const parameters_t *parameters)
{
    const control_law_t before = flight->active_law;
    const control_law_t wanted = (control_law_t)parameters_choice(parameters, PARAMETER_LAW);

    flight->active_law = (wanted == LAW_EST && !est_law_ready(&flight->est)) ? LAW_PIDT : wanted;
    return flight->active_law != before;
}

/* Whether the state is flown by the estimate: a law as it was chosen, what the supervisor does by itself whenever there
 * is an estimate that heights, if there are any, do not contradict. */
static bool uses_estimate(const flight_t *flight)
{
    switch (flight->supervisor.state) {
    case FLIGHT_TAKEOFF:
    case FLIGHT_FLYING:
        return flight->active_law == LAW_EST;
    case FLIGHT_COASTING:
        return flight->active_law == LAW_EST || (flight->est.airborne && est_law_ready(&flight->est));
    case FLIGHT_LANDING:
    case FLIGHT_LOWERING:
        return est_law_ready(&flight->est) && supervisor_has_estimate(&flight->supervisor);
    default:
        return est_law_ready(&flight->est);
    }
}

/* Judged where the law acts: what the supervisor does by itself goes elsewhere. */
static void judge_reach(flight_t *flight)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const bool acts = supervisor->state == FLIGHT_TAKEOFF || supervisor->state == FLIGHT_FLYING;

    if (!acts || supervisor->reference_m != flight->reach_m) {
        reach_reset(&flight->reach);
    }
    flight->reach_m = supervisor->reference_m;
    flight->out_of_reach =
        acts && reach_step(&flight->reach, supervisor->height.height_mm - reference_mm(flight), supervisor->step_us);
}

uint16_t flight_releases(const flight_t *flight, const parameters_t *parameters)
{
    const uint16_t law = parameters_choice(parameters, PARAMETER_LAW);

    if (law == LAW_EST || is_est_mode(flight->mode)) {
        return FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME;
    }
    if (law == LAW_PIDT || parameters_choice(parameters, PARAMETER_RELEASE) == RELEASE_SCAN) {
        return FLIGHT_RELEASE_HEIGHT;
    }
    return FLIGHT_RELEASE_PERIOD;
}

static void write_outputs(const flight_t *flight, const parameters_t *parameters, flight_outputs_t *out)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const estimator_t *estimator = &flight->est.estimator;
    const bool estimated = flight->active_law == LAW_EST || is_est_mode(flight->mode);
    const bool wants_imu = parameters_choice(parameters, PARAMETER_LAW) == LAW_EST;
    const bool imu_missing = wants_imu && !est_law_has_imu(&flight->est);
    const float measured_mm = (supervisor->height.sequence != 0U) ? supervisor->height.height_mm : NAN;

    out->thrust_n = flight->thrust_n;
    out->pulse_us = thrust_to_pulse_us(flight->thrust_n);
    out->state = supervisor->state;
    out->flags = (uint16_t)(supervisor->flags | (imu_missing ? FLIGHT_FLAG_ATTITUDE : 0U)
                            | (flight->out_of_reach ? FLIGHT_FLAG_REACH : 0U));
    out->reference_m = supervisor->reference_m;
    out->estimate_mm = estimated ? estimator->now.height_m * 1000.0F : measured_mm;
    out->innovation_mm = estimated ? estimator->innovation_m * 1000.0F : NAN;
    out->releases = flight_releases(flight, parameters);
}

void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in, flight_outputs_t *out)
{
    const flight_mode_t before = flight->mode;

    supervise(flight, parameters, in);
    update_estimator(flight, parameters, in);
    const bool law_changed = select_law(flight, parameters);
    flight->mode = (uses_estimate(flight) ? modes_with_estimate : modes_without_estimate)[flight->supervisor.state];
    if (before != flight->mode) {
        change_mode(flight, before, flight->mode);
    }
    update_hover(flight, parameters->value[PARAMETER_GRAV]);
    const bool action_changed = run_mode(flight, parameters, before != flight->mode);
    bumpless_transfer(flight, before, law_changed || action_changed);
    flight->thrust_n = between(0.0F, flight->setpoint_n + flight->transfer_n, THRUST_MAX_N);
    est_law_record_command(&flight->est, flight->thrust_n);
    judge_reach(flight);
    write_outputs(flight, parameters, out);
}
