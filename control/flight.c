/* One control cycle in a fixed order: check the sensors, predict, supervise, fuse, choose law and mode,
 * compute the thrust, limit it, write the outputs. Two tables choose the mode from the supervisor's state:
 * one with an estimate, one without. The mode computes the thrust. In the air every change of the mode is
 * without a jump of the thrust: bumpless transfer, as in any text on control.
 * What breaks: the order. The supervisor needs the estimate of this cycle. The estimator needs the command of
 * the previous cycle. A state without a row in both tables is IDLE: no thrust, so the vehicle falls. */
#include "control/flight.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"
#include "control/thrust.h"
#include "control/touchdown.h"

#define HOVER_MARGIN_N 1.5F   /* mass 20 % off; below the 2 N of law EST, because no law corrects it here */
#define HOVER_TIME_S 2.5F     /* chosen: a mean over the swings of the seed's law */
#define TRANSFER_TIME_S 0.4F  /* chosen: four scans */
#define TRANSFER_START_N 0.5F /* chosen: 0.7 m/s2 */
#define STEP_MAX_S 0.5F       /* chosen: longer pauses count as this long */
#define BLIND_MAX_S 60.0F     /* above DESCENT_TIMEOUT_US in supervisor.c */

#define BLIND_STILL_TIMES 2.0F /* tried 2 and 3: a calm vehicle that flies touches at 0.8 and 0.95 m/s */

#define PIDT_WINDOW_N 3.0F         /* chosen: 0.4 g to either side */
#define INSTEAD_SHARE 0.65F        /* tried 0.6 to 1: of PIDT's gains, for vehicles that shake with them */
#define SETTLE_S 0.6F              /* chosen: six scans; until then the estimate is copied */
#define LIFTED_MPS 0.25F           /* chosen: above what a bias of 0.2 m/s2 makes on the ground */
#define LOW_MM 80.0F               /* chosen: above REST_BELOW_MM in supervisor.c, 50 mm */
#define NO_AUTHORITY_WINDOW_N 0.6F /* chosen: 0.8 m/s2 */
#define CARRIED_BELOW_N 0.5F       /* chosen: by the vehicle model a sink rate of 0.3 m/s */
#define CARRIED_N_PER_S 0.06F      /* chosen: little, because the pilot may fly on for long */
#define HANDED_OVER_N_PER_S \
    0.15F /* chosen: more, because with a pin it begins when the pilot gives the throttle back */
#define CARRIED_SUNK_N 1.2F       /* chosen: with CARRIED_BELOW_N more than a fifth of GRAV */
#define CARRIED_FELT_N 2.0F       /* chosen: more than GRAV is off */
#define CARRIED_TIME_S 2.0F       /* as IN_HANDS_TIME_S in accelerometer.c */
#define CARRIED_BIAS_TIME_S 10.0F /* chosen: five times that */
#define CARRIED_MOVES_MPS 0.35F   /* chosen: a bias of 0.15 m/s2 makes 0.3 m/s in CARRIED_TIME_S */
#define CARRIED_N_PER_M 2.0F      /* chosen: a climb of 1 m/s lowers it by 1.5 N before that is forgotten */
#define CARRIED_CLIMB_N_PER_MPS 1.0F /* chosen: halves the climb of a vehicle that is lighter by a fifth */
#define CARRIED_FALL_N_PER_MPS 2.0F  /* chosen: twice that */
#define CARRIED_BRAKE_N 1.8F         /* chosen: what the two before may have sunk */
#define HELD_SINK_N_PER_S 0.2F       /* chosen: as SINK_FADE_N_PER_S in est_law.c */
#define UNKNOWN_WINDOW_N 2.0F        /* chosen: as HOVER_BOUND_N in est_law.c */
#define VAIN_LANDING_N 1.5F          /* chosen: by the vehicle model a sink rate of 0.9 m/s */
#define VAIN_LANDING_S 1.0F          /* chosen: twice as long as a landing begins with so little thrust */
#define LANDS_MPS 0.3F               /* chosen: three quarters of the sink rate of a landing */
#define UNKNOWN_REACH_M 0.06F        /* tried 0.05 to 0.09; asks for 0.8 N at the delivered gains */
#define FLOAT_TRIM_N 0.4F            /* chosen: GRAV is trimmed so much too low, or less */
#define FLOAT_TRIM_N_PER_M_S 8.0F    /* tried 4 and 8: half of it after a second 25 mm too low */
#define UNCONFIRMED_MPS 0.35F  /* chosen: CONFIRMED_M in confirmation.c, 0.12 m, takes 0.35 s at this rate */
#define TAKEOFF_MPS 0.6F       /* chosen: above UNCONFIRMED_MPS, because every take-off begins unconfirmed */
#define UNCHECKED_ABOVE_N 0.5F /* chosen: as TRANSFER_START_N */
#define UNCHECKED_BELOW_N 1.0F /* chosen: twice that */
#define CLIMB_MARGIN_MPS 0.4F  /* chosen: room for an overshoot of the climb rate above VUP */
#define STAND_TEST_N_PER_S \
    1.0F /* chosen: in 2 s too low to fly; the accelerometer shows a fall before it is fast */
#define NOT_LIFTED_MAX_US UINT32_C(3000000) /* chosen: the take-off's ramp in est_law.c ends after 1.2 s */
#define HEIGHT_LATE_US UINT32_C(170000)     /* a scan of 0.1 s is missing */
#define UNPOWERED_S 1.0F                    /* chosen: a free fall of 5 m */
#define EFFECT_REACH_M 0.14F                /* chosen: below VAIN_M in verdict.c */
#define PIN_TRUSTED_S 5.0F                  /* chosen: a loose contact is over sooner */
#define PIN_BELOW_N 2.0F                    /* chosen: a load of a newton let go, and a newton to sink */
#define PIN_ABOVE_N 1.0F                    /* chosen: a load of a newton */
#define FLOAT_REACH_M 0.30F /* chosen: three times the distance that counts as reached, reach.c */

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

void flight_init(flight_t *flight)
{
    *flight = (flight_t){.hover_n = 0.0F};
    supervisor_init(&flight->supervisor);
    sense_init(&flight->sense);
    imu_axes_init(&flight->axes);
    est_law_init(&flight->est);
}

static bool is_est_mode(flight_mode_t mode)
{
    return mode == FLIGHT_MODE_EST_HOLD || mode == FLIGHT_MODE_EST_LAND || mode == FLIGHT_MODE_EST_SINK;
}

/* True when the estimate is good enough to fly by. */
static bool has_estimate(const flight_t *flight)
{
    return est_law_ready(&flight->est);
}

/* FLOATING, and the throttle is certainly the firmware's. */
static bool commands_floating(const flight_t *flight)
{
    return flight->supervisor.state == FLIGHT_FLOATING && flight->mode != FLIGHT_MODE_HOVER &&
           !flight->throttle_unknown;
}

/* No pin tells who has the throttle. The vehicle shows that it is the firmware. */
static bool shows_effect(const flight_t *flight)
{
    return flight->throttle_unknown && flight->effect.has_effect;
}

/* FLOATING, and the thrust that is commanded carries the vehicle. */
static bool carries_floating(const flight_t *flight)
{
    return commands_floating(flight) || shows_effect(flight);
}

/* Low-pass of the hover thrust. It is slow, so that a fault is doubted before its error is learned. It is
 * faster at the start of a flight. */
static void follow_hover(flight_t *flight)
{
    const float step_s = seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
    const bool estimated = has_estimate(flight) && flight->est.airborne;
    if (!estimated && flight->supervisor.state != FLIGHT_FLYING && !carries_floating(flight)) {
        return;
    }
    if (flight->learned_s > 0.0F && !flight->evidence.teaches) {
        return;
    }
    const float target_n = estimated ? flight->est.hover.thrust_n : flight->thrust_n;
    const float time_s = !estimated                       ? HOVER_TIME_S
                         : (flight->learned_s < SETTLE_S) ? step_s
                                                          : flight->learned_s;

    flight->hover_n += at_most(step_s / at_least(time_s, 0.001F), 1.0F) * (target_n - flight->hover_n);
    flight->learned_s = at_most(flight->learned_s + step_s, HOVER_TIME_S);
}

static bool descends(flight_state_t state)
{
    return state == FLIGHT_DESCENDING || state == FLIGHT_LANDING || state == FLIGHT_LOWERING;
}

/* True when a take-off is commanded and the vehicle has not left the ground, whatever height is measured. */
static bool lifts(const flight_t *flight)
{
    const flight_state_t state = flight->supervisor.state;
    return (state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING) && flight->lifting;
}

static void update_hover(flight_t *flight, float gravity_n)
{
    const flight_state_t state = flight->supervisor.state;
    const bool grounded = state == FLIGHT_GROUND || lifts(flight);
    const bool flies = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || carries_floating(flight);
    const bool sees = (flight->supervisor.flags & FLIGHT_FLAG_HEIGHT) == 0U;

    flight->hover_learned = !grounded && (flight->hover_learned || flies);
    if (!flight->hover_learned) {
        flight->hover_n = gravity_n;
        flight->learned_s = 0.0F;
    } else if (flies && sees && !doubts(&flight->evidence, DOUBT_SIGHT | DOUBT_THRUST)) {
        follow_hover(flight);
    }
    flight->hover_n = between(gravity_n - HOVER_MARGIN_N, flight->hover_n, gravity_n + HOVER_MARGIN_N);
    flight->hover_n = between(0.0F, flight->hover_n, THRUST_MAX_N);
    est_law_set_sure_hover(&flight->est, flight->hover_n, descends(state) && !flight->carried);
}

/* Law EST takes over. knows: its hover thrust was learned in this flight, and is not learned anew from a
 * vehicle that may still swing. */
static void engage_estimate(flight_t *flight, bool knows)
{
    const hover_t learned = flight->est.hover;

    est_law_engage(&flight->est, flight->thrust_n, knows ? learned.thrust_n : flight->hover_n);
    if (knows) {
        flight->est.hover.variance_n2 = learned.variance_n2;
    }
}

/* Initial values of the new mode. The law keeps its integral action only during COASTING. */
static void change_mode(flight_t *flight, flight_mode_t before, flight_mode_t now, float gravity_n)
{
    const bool handed_over = flight->supervisor.state == FLIGHT_DESCENDING; /* by a pilot, without heights */

    flight->piloted_s = 0.0F;
    flight->stuck_pin_n = 0.0F;
    if (before == FLIGHT_MODE_DESCENT) {
        flight->hover_n += flight->descent.trim_n;
    }
    if (now == FLIGHT_MODE_DESCENT) {
        descent_start(&flight->descent, flight->supervisor.height.rate_mm_s);
    }
    if (now == FLIGHT_MODE_LAW) {
        pid_resume(&flight->pid);
        pidt_resume(&flight->pidt);
        if (is_est_mode(before) && flight->supervisor.state == FLIGHT_FLYING) {
            flight->pidt.integral_n = flight->hover_n - gravity_n; /* as EST has estimated it */
        }
    } else if (now == FLIGHT_MODE_FLOAT) {
        pidt_reset(&flight->pidt);
    } else if (flight->supervisor.state != FLIGHT_COASTING) {
        pid_reset(&flight->pid);
        pidt_reset(&flight->pidt);
    }
    if (is_est_mode(now) && handed_over && before == FLIGHT_MODE_IDLE) {
        estimator_amend(&flight->est.estimator, 0.0F, flight->evidence.felt_mps, flight->evidence.bias_mps2);
    }
    if (is_est_mode(now) && !is_est_mode(before) &&
        (handed_over || (before != FLIGHT_MODE_IDLE && !lifts(flight)))) {
        engage_estimate(flight, before == FLIGHT_MODE_LAW && flight->est.airborne);
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

static void step_pidt(flight_t *flight, const parameters_t *parameters, float reference_m)
{
    const height_track_t *height = &flight->supervisor.height;
    const float *value = parameters->value;
    const bool instead = parameters_choice(parameters, PARAMETER_LAW) == LAW_EST;
    const float share = instead ? INSTEAD_SHARE : 1.0F;
    const pidt_gains_t gains = {
        .kp_n_per_m = share * value[PARAMETER_PKP],
        .ki_n_per_m_s = share * value[PARAMETER_PKI],
        .kd_n_s_per_m = share * value[PARAMETER_PKD],
        .gravity_n = value[PARAMETER_GRAV],
        .most_n = at_most(value[PARAMETER_GRAV] + PIDT_WINDOW_N, THRUST_MAX_N),
        .least_n = at_least(value[PARAMETER_GRAV] - PIDT_WINDOW_N, 0.0F),
    };

    if (height->is_new || !flight->pidt.primed) {
        const uint32_t rays_us = flight->est.rays_us;
        flight->setpoint_n = pidt_step(&flight->pidt, &gains, reference_m, height->height_mm * 0.001F,
                                       seconds_at_most(rays_us - flight->pidt_rays_us, HEIGHT_FRESH_S));
        flight->pidt_rays_us = rays_us;
    } else if (height->age_us > HEIGHT_LATE_US && flight->est.airborne) { /* do not hold a push for long */
        flight->setpoint_n = between(flight->hover_n - TRANSFER_START_N, flight->setpoint_n,
                                     flight->hover_n + TRANSFER_START_N);
    }
}

/* The tilt moves as in flight. An IMU that has fallen silent does not say so any longer. */
static bool rocks(const flight_t *flight)
{
    return flight->evidence.rocks && est_law_has_imu(&flight->est);
}

static void step_descent(flight_t *flight, bool started)
{
    const height_track_t *height = &flight->supervisor.height;
    const float gap_s = height->is_new ? seconds_at_most(height->gap_us, HEIGHT_FRESH_S) : 0.0F;

    flight->descent.rocks = rocks(flight);
    if (height->is_new || started) {
        flight->setpoint_n = descent_step(&flight->descent, flight->hover_n, height->height_mm,
                                          height->rate_mm_s, gap_s);
    }
}

/* While the tilt is still, the vehicle probably stands, and nothing else tells it: time runs faster. */
static void step_blind_descent(flight_t *flight, bool started)
{
    const bool still = flight->evidence.calm && est_law_has_imu(&flight->est);
    const float step_s = still ? seconds_at_most(flight->supervisor.step_us, STEP_MAX_S) : 0.0F;

    flight->blind_ahead_s = started ? 0.0F : flight->blind_ahead_s + BLIND_STILL_TIMES * step_s;
    flight->setpoint_n = descent_blind(
        flight->hover_n,
        at_most(seconds_at_most(flight->supervisor.state_us, BLIND_MAX_S) + flight->blind_ahead_s,
                BLIND_MAX_S));
}

/* Thrust of a descent by heights, or without them; it only holds the height while the pin is trusted. */
static float stuck_pin_descent_n(flight_t *flight)
{
    const height_track_t *height = &flight->supervisor.height;
    const bool holds = flight->piloted_s < PIN_TRUSTED_S && !flight->supervisor.land;

    if (height->age_us > HEIGHT_LOST_US) {
        return holds ? flight->hover_n
                     : descent_blind(flight->hover_n, seconds_at_most(height->age_us, BLIND_MAX_S));
    }
    if (!height->is_new) {
        return flight->hover_n + flight->stuck_pin_n;
    }
    flight->descent.sink_mm_s = holds ? 0.0F : flight->descent.sink_mm_s;
    flight->descent.rocks = rocks(flight);
    return descent_step(&flight->descent, flight->hover_n, height->height_mm, height->rate_mm_s,
                        seconds_at_most(height->gap_us, HEIGHT_FRESH_S));
}

/* While the pin says that the pilot has the throttle, no thrust commanded here moves the vehicle, unless the
 * pin is wrong. For that case the output holds it by its heights, and lands it after a while, or when that is
 * ordered. Only the output contains this: nothing is learned from it, and a hand-back starts without it. */
static void step_stuck_pin(flight_t *flight)
{
    const bool piloted = (flight->supervisor.flags & FLIGHT_FLAG_PILOT) != 0U;

    if (!piloted || flight->piloted_s <= 0.0F) {
        descent_start(&flight->descent, 0.0F);
        flight->piloted_s = 0.0F;
        flight->stuck_pin_n = 0.0F;
    }
    if (piloted) {
        flight->piloted_s += seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
        const float wanted_n = stuck_pin_descent_n(flight) - flight->hover_n;
        const float least_n = (flight->descent.near_ground_s > 0.0F) ? -THRUST_MAX_N : -PIN_BELOW_N;
        flight->stuck_pin_n = at_least(between(least_n, wanted_n, PIN_ABOVE_N),
                                       flight->idle_n - flight->thrust_n);
    }
}

/* Height to hold, above the terrain. */
static float aim_m(const flight_t *flight)
{
    return (flight->supervisor.state == FLIGHT_FLOATING) ? flight->floating_m
                                                         : flight->supervisor.reference_m;
}

/* True when heights or reference were lost before the vehicle left the ground. Then the thrust ramps down to
 * 0. */
static bool stops_on_ground(flight_t *flight)
{
    const flight_state_t state = flight->supervisor.state;
    const bool gives_up = state == FLIGHT_COASTING || state == FLIGHT_DESCENDING || state == FLIGHT_LANDING;
    flight->not_lifted = state == FLIGHT_TAKEOFF
                             ? !flight->est.airborne && flight->supervisor.state_us < NOT_LIFTED_MAX_US
                             : flight->not_lifted && gives_up;
    return flight->not_lifted && gives_up;
}

/* The thrust setpoint of the mode. Returns true when the law has gained or lost its integral action. */
static bool run_mode(flight_t *flight, const parameters_t *parameters, bool mode_changed)
{
    const float reference_m = aim_m(flight);

    switch (flight->mode) {
    case FLIGHT_MODE_LAW:
        if (flight->active_law != LAW_PIDT) {
            return step_pid(flight, parameters);
        }
        step_pidt(flight, parameters, reference_m);
        break;
    case FLIGHT_MODE_FLOAT:
        step_pidt(flight, parameters, reference_m);
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
        step_stuck_pin(flight);
        break;
    case FLIGHT_MODE_DESCENT:
        step_descent(flight, mode_changed);
        break;
    case FLIGHT_MODE_BLIND_DESCENT:
        step_blind_descent(flight, mode_changed);
        break;
    case FLIGHT_MODE_IDLE:
    default:
        flight->setpoint_n = 0.0F;
        break;
    }
    return false;
}

/* Another law goes on without the estimate. The latest command may have been an answer to noise. */
static bool loses_estimate(const flight_t *flight, flight_mode_t before)
{
    return is_est_mode(before) && !has_estimate(flight);
}

static void bumpless_transfer(flight_t *flight, flight_mode_t before, bool law_changed)
{
    const flight_mode_t now = flight->mode;
    const float hover_n = flight->hover_n;
    const bool changed = before != now && !(is_est_mode(before) && is_est_mode(now));
    const bool at_once = now == FLIGHT_MODE_DESCENT || now == FLIGHT_MODE_EST_LAND;

    const bool takes_off = before == FLIGHT_MODE_IDLE || (before == FLIGHT_MODE_HOVER && lifts(flight));

    if (now == FLIGHT_MODE_IDLE || (changed && (at_once || takes_off))) {
        flight->transfer_n = 0.0F;
    } else if (law_changed && !loses_estimate(flight, before)) {
        flight->transfer_n = flight->thrust_n - flight->setpoint_n;
    } else if (changed) {
        flight->transfer_n = between(hover_n - TRANSFER_START_N, flight->thrust_n,
                                     hover_n + TRANSFER_START_N) -
                             flight->setpoint_n;
    } else {
        flight->transfer_n *= TRANSFER_TIME_S /
                              (TRANSFER_TIME_S + seconds_at_most(flight->supervisor.step_us, STEP_MAX_S));
    }
}

/* Reference minus height; NAN when no height is held. */
static float wanted_m(const flight_t *flight)
{
    const flight_state_t state = flight->supervisor.state;
    const bool holds = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_LOWERING ||
                       (state == FLIGHT_FLOATING && flight->mode != FLIGHT_MODE_HOVER);
    return holds ? aim_m(flight) - flight->supervisor.height.height_mm * 0.001F : NAN;
}

/* True when the vehicle is in the air, carried by the thrust that is commanded here. */
static bool is_off_ground(const flight_t *flight, const flight_inputs_t *in)
{
    const flight_state_t state = flight->supervisor.state;
    const bool low = flight->supervisor.height.height_mm < LOW_MM;

    switch (state) {
    case FLIGHT_GROUND:
    case FLIGHT_CUT:
        return false;
    case FLIGHT_TAKEOFF:
        return flight->est.airborne;
    case FLIGHT_FLYING:
        return !flight->lifting && in->has_throttle;
    case FLIGHT_FLOATING:
        return commands_floating(flight);
    case FLIGHT_LANDING:
        return in->has_throttle && !low;
    default:
        return in->has_throttle;
    }
}

static situation_t describe(const flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const cascade_vehicle_t vehicle = est_law_vehicle(&flight->est, parameters);
    const supervisor_t *supervisor = &flight->supervisor;

    return (situation_t){
        .step_s = supervisor->started ? seconds_at_most(in->now_us - supervisor->now_us, STEP_MAX_S) : 0.0F,
        .grounded = supervisor->state == FLIGHT_GROUND,
        .standing = lifts(flight),
        .off_ground = is_off_ground(flight, in),
        .ours = in->has_throttle,
        .ordered = in->reference_sequence != supervisor->reference_sequence,
        .thrust_n = deadband_effect(&flight->est.deadband, flight->hover_n, flight->thrust_n),
        .hover_n = flight->hover_n,
        .authority_mps2_per_n = vehicle.authority_mps2_per_n,
        .damping_per_s = vehicle.damping_per_s,
        .wanted_m = wanted_m(flight),
        .noise_mps2 = flight->est.estimator.noise_mps2,
    };
}

/* Checks the inputs, and removes from *in what must not be used. */
static void check_inputs(flight_t *flight, const parameters_t *parameters, flight_inputs_t *in)
{
    const situation_t situation = describe(flight, parameters, in);

    imu_axes_step(&flight->axes, in->frames, in->frame_count, situation.grounded, situation.noise_mps2);
    flight->evidence = sense_step(&flight->sense, &situation, in);
}

/* Reacts to doubts that were set or cleared in this cycle. */
static void change_doubts(flight_t *flight, float gravity_n)
{
    const evidence_t *evidence = &flight->evidence;
    const uint16_t come = evidence->doubts & (uint16_t)~flight->doubts;
    const uint16_t gone = flight->doubts & (uint16_t)~evidence->doubts;

    if ((come & DOUBT_SIGHT) != 0U) {
        estimator_amend(&flight->est.estimator, flight->est.estimator.now.height_m - evidence->lost_m,
                        evidence->speed_mps, evidence->bias_mps2);
    }
    if ((come & DOUBT_IMU) != 0U && flight->learned_s < HOVER_TIME_S) {
        flight->hover_n = gravity_n; /* it may have been learned from a wrong accelerometer */
        flight->learned_s = 0.0F;
    }
    const bool flies_unseen = (come & DOUBT_SIGHT) != 0U && evidence->sways;
    if (((come & DOUBT_SIGHT) != 0U || (gone & DOUBT_THRUST) != 0U) &&
        (flight->est.airborne || flies_unseen)) {
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
    if ((gone & DOUBT_SIGHT) != 0U && flight->est.airborne) { /* the heights are right after all */
        estimator_amend(&flight->est.estimator, evidence->height_m, evidence->rise_mps, evidence->bias_mps2);
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
    est_law_set_without_authority(&flight->est, doubts(evidence, DOUBT_THRUST) ||
                                                    (flight->throttle_unknown && !shows_effect(flight)));
    est_law_set_accelerations_doubted(&flight->est, doubts(evidence, DOUBT_IMU));
    est_law_set_rocks(&flight->est, rocks(flight));
    if ((come & DOUBT_IMU) != 0U && flight->est.airborne) { /* the estimate used them until now */
        estimator_amend(&flight->est.estimator, evidence->height_m, evidence->rise_mps, 0.0F);
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
    flight->doubts = evidence->doubts;
}

/* A pilot may have the vehicle, and nothing tells: without a pin on the ground, or in a descent that began
 * so. Somebody may carry it by hand too: that is not told apart, and a vehicle that flies must not fall. An
 * IMU that has fallen silent does not say so any longer: the descent then ends by its time. */
static bool may_be_carried(const flight_t *flight, const parameters_t *parameters)
{
    if (flight->supervisor.state == FLIGHT_GROUND) {
        return flight->evidence.in_hands && parameters_choice(parameters, PARAMETER_SEL) == SEL_NONE &&
               est_law_has_imu(&flight->est);
    }
    return flight->carried && flight->evidence.sways && est_law_has_imu(&flight->est);
}

/* Without thrust it stands after a take-off that was given up, and after a landing. */
static bool ends_without_thrust(const flight_t *flight)
{
    return flight->not_lifted || (flight->landed_s > 0.0F && flight->unpowered_s > UNPOWERED_S);
}

static void supervise(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const estimator_t *estimator = &flight->est.estimator;
    const estimate_t *now = &estimator->now;

    est_law_predict(&flight->est, parameters, in->frames, in->frame_count, in->now_us);
    change_doubts(flight, parameters->value[PARAMETER_GRAV]);
    const vertical_estimate_t estimate = {
        .known = has_estimate(flight) && estimator->confirmed,
        .height_mm = now->height_m * 1000.0F,
        .climb_mm_s = (now->speed_mps - now->terrain_mps) * 1000.0F,
        .stands = flight->evidence.stands ||
                  (flight->thrust_n <= flight->idle_n && ends_without_thrust(flight)),
        .upright = flight->evidence.upright,
        .sways = flight->evidence.sways,
        .rocks = rocks(flight),
        .hands_over = flight->arming.hands_over,
        .carried = may_be_carried(flight, parameters),
    };
    supervisor_step(&flight->supervisor, parameters->value[PARAMETER_LINK], in, &estimate);
}

/* True when the height is above the one that was measured on the ground, whatever that was. */
static bool has_risen(const flight_t *flight)
{
    return flight->supervisor.height.height_mm * 0.001F - flight->est.ground_m > LOW_MM * 0.001F;
}

/* True when the vehicle may not have left the ground yet. A pilot who takes the throttle during a take-off
 * makes it FLOATING on the ground. */
static bool may_stand(const flight_t *flight)
{
    const flight_state_t state = flight->supervisor.state;

    return lifts(flight) ? !flight->est.airborne
                         : state == FLIGHT_FLOATING && !has_risen(flight) && !flight->evidence.sways;
}

/* True when the vehicle has left the ground, by the heights or by the accelerometer. For the laws that do not
 * detect their lift-off themselves. */
static bool flies(const flight_t *flight)
{
    return (flight->supervisor.state == FLIGHT_FLYING && (!flight->lifting || has_risen(flight))) ||
           ((flight->supervisor.state == FLIGHT_FLYING || flight->supervisor.state == FLIGHT_TAKEOFF) &&
            flight->evidence.felt_mps > LIFTED_MPS * flight->evidence.shaken);
}

/* First hover thrust after lift-off: the delivered thrust less what acceleration and drag need. */
static float lifting_n(const flight_t *flight, const parameters_t *parameters)
{
    const cascade_vehicle_t vehicle = est_law_vehicle(&flight->est, parameters);
    const float taken_mps2 = flight->est.lift_mps2 + vehicle.damping_per_s * flight->evidence.felt_mps;
    const float gravity_n = parameters->value[PARAMETER_GRAV];
    const float hover_n = flight->est.actuator.thrust_n - taken_mps2 / vehicle.authority_mps2_per_n;

    return has_estimate(flight) && est_law_has_acceleration(&flight->est)
               ? between(gravity_n - HOVER_MARGIN_N, hover_n, gravity_n + HOVER_MARGIN_N)
               : flight->hover_n;
}

/* The IMU is back in flight. The estimate starts again from what thrust and heights tell, not from
 * standstill, and with the bias from before; also where the heights are gone. */
static void restart_estimate(flight_t *flight)
{
    const evidence_t *evidence = &flight->evidence;
    estimator_t *estimator = &flight->est.estimator;
    const float height_m = doubts(evidence, DOUBT_SIGHT) ? estimator->now.height_m
                                                         : evidence->height_m + evidence->moved_m;

    estimator_start(estimator, height_m, evidence->pushed_mps, estimator->felt ? evidence->bias_mps2 : 0.0F);
}

/* The take-off was given up on the ground, and the accelerometer feels that the vehicle has left it after
 * all. */
static void notice_lift(flight_t *flight, const parameters_t *parameters)
{
    if (has_estimate(flight) && felt_mps(&flight->evidence) > LIFTED_MPS) {
        flight->hover_n = lifting_n(flight, parameters);
        flight->hover_learned = true;
        flight->not_lifted = false;
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
}

static void update_estimator(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    const flight_state_t state = flight->supervisor.state;
    const bool at_rest = state == FLIGHT_GROUND && flight->supervisor.rest.on;

    if (!flight->est.estimator.initialised && flight->est.airborne && est_law_has_imu(&flight->est)) {
        restart_estimate(flight);
    }
    if (flight->supervisor.height.is_new) {
        est_law_fuse_height(&flight->est, &in->altitude, in->height_stamp_ms, in->height_time_us,
                            in->height_age_us, at_rest);
    }
    flight->lifting = state == FLIGHT_GROUND || (flight->lifting && may_stand(flight));
    if (state == FLIGHT_GROUND) {
        est_law_reset(&flight->est, parameters);
    } else if (state == FLIGHT_FLOATING && !in->has_throttle) {
        est_law_disengage(&flight->est);
    } else if (flight->not_lifted && state != FLIGHT_TAKEOFF) {
        notice_lift(flight, parameters);
    } else if (flight->mode == FLIGHT_MODE_LAW && !flight->est.airborne && flies(flight)) {
        est_law_engage(&flight->est, flight->thrust_n, lifting_n(flight, parameters));
    }
}

/* Chooses the law in force. Returns true when it has changed. */
static bool select_law(flight_t *flight, const parameters_t *parameters)
{
    const control_law_t before = flight->active_law;
    const control_law_t wanted = (control_law_t)parameters_choice(parameters, PARAMETER_LAW);

    flight->active_law = (wanted == LAW_EST && !has_estimate(flight)) ? LAW_PIDT : wanted;
    return flight->active_law != before;
}

/* True when the present state flies by the estimate. In TAKEOFF and FLYING the chosen law decides. In the
 * other states the estimate is used whenever there is one that the heights do not contradict. */
static bool uses_estimate(const flight_t *flight)
{
    switch (flight->supervisor.state) {
    case FLIGHT_TAKEOFF:
    case FLIGHT_FLYING:
        return flight->active_law == LAW_EST;
    case FLIGHT_COASTING:
        return flight->active_law == LAW_EST || (flight->est.airborne && has_estimate(flight));
    case FLIGHT_LANDING:
    case FLIGHT_LOWERING:
        return has_estimate(flight) && supervisor_has_estimate(&flight->supervisor);
    default:
        return has_estimate(flight);
    }
}

/* While the pilot has the throttle the command is the hover thrust, so that the hand-back does not cut the
 * motors. */
static flight_mode_t select_mode(const flight_t *flight, const flight_inputs_t *in)
{
    if (flight->supervisor.state == FLIGHT_FLOATING && !in->has_throttle) {
        return FLIGHT_MODE_HOVER;
    }
    if (flight->supervisor.state == FLIGHT_COASTING && has_estimate(flight) && flight->est.airborne &&
        doubts(&flight->evidence, DOUBT_SIGHT)) {
        return FLIGHT_MODE_EST_SINK; /* the last heights were wrong: do not hold them */
    }
    return (uses_estimate(flight) ? modes_with_estimate : modes_without_estimate)[flight->supervisor.state];
}

/* True in a descent that began in a pilot's hands, without heights. */
static void watch_carried(flight_t *flight, const parameters_t *parameters)
{
    const supervisor_t *supervisor = &flight->supervisor;

    if (supervisor->state != FLIGHT_DESCENDING) {
        flight->carried = false;
    } else if (supervisor->handed_over && supervisor->state_us == 0U) {
        flight->carried = true;
        flight->carried_felt_n = 0.0F;
        flight->carried_n_per_s = (parameters_choice(parameters, PARAMETER_SEL) == SEL_NONE)
                                      ? CARRIED_N_PER_S
                                      : HANDED_OVER_N_PER_S;
    }
}

/* FLOATING without a pin: does the vehicle do what is commanded? Once it does, its hover thrust is learned.
 */
static void watch_effect(flight_t *flight, bool begins)
{
    const estimator_t *estimator = &flight->est.estimator;
    const uint32_t since_us = estimator->now_us - flight->effect_us;
    const bool had_effect = flight->effect.has_effect;

    flight->effect_us = estimator->now_us;
    if (begins || flight->supervisor.state != FLIGHT_FLOATING || !est_law_has_acceleration(&flight->est) ||
        since_us > FRAME_GAP_US) {
        effect_init(&flight->effect);
    } else if (since_us > 0U) {
        effect_step(&flight->effect, flight->est.authority_mps2_per_n * flight->est.actuator.thrust_n,
                    estimator->up_mps2, (float)since_us * 1.0e-6F);
        if (flight->effect.has_effect && !had_effect) {
            est_law_engage(&flight->est, flight->thrust_n, flight->hover_n + flight->float_trim_n);
        }
    }
}

/* LANDING: how long it has had far too little thrust to fly, and does not sink. */
static void watch_landing(flight_t *flight)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const bool weak = flight->throttle_unknown || flight->thrust_n < flight->hover_n - VAIN_LANDING_N;
    const bool sinks = supervisor->height.height_mm < LOW_MM || flight->evidence.rise_mps < -LANDS_MPS;

    if (!weak || sinks || supervisor->state_us == 0U) {
        flight->vain_landing_s = 0.0F;
    } else {
        flight->vain_landing_s = at_most(
            flight->vain_landing_s + seconds_at_most(supervisor->step_us, STEP_MAX_S), VAIN_LANDING_S);
    }
}

/* True in LANDING of a vehicle that a pilot holds up: nothing tells it. */
static bool lands_in_vain(const flight_t *flight)
{
    return flight->supervisor.state == FLIGHT_LANDING && flight->vain_landing_s >= VAIN_LANDING_S;
}

/* Without a pin nothing tells who has the throttle: FLOATING begins in a pilot's hands, and LANDING may be
 * held up by them. */
static void update_throttle_unknown(flight_t *flight, const parameters_t *parameters, bool has_throttle)
{
    const bool before = flight->throttle_unknown;
    const flight_state_t state = flight->supervisor.state;

    watch_carried(flight, parameters);
    if (state == FLIGHT_LANDING) {
        watch_landing(flight);
    }
    const bool unsure = (state == FLIGHT_FLOATING && has_throttle) || lands_in_vain(flight);
    flight->throttle_unknown = flight->carried ||
                               (unsure && parameters_choice(parameters, PARAMETER_SEL) == SEL_NONE);
    if (flight->throttle_unknown) {
        flight->float_trim_n = before ? flight->float_trim_n : 0.0F;
        watch_effect(flight, !before);
    } else if (before && state != FLIGHT_GROUND) {
        est_law_engage(&flight->est, flight->thrust_n, flight->hover_n);
    }
}

static bool is_hold_mode(flight_mode_t mode)
{
    return mode == FLIGHT_MODE_EST_HOLD || mode == FLIGHT_MODE_FLOAT;
}

/* FLOATING holds the height at its start. When something else moves the vehicle, the held height follows; at
 * once where a pilot may fly. */
static void float_along(flight_t *flight, bool entered)
{
    const float height_m = flight->supervisor.height.height_mm * 0.001F;
    const bool holds = !entered && flight->supervisor.state == FLIGHT_FLOATING &&
                       flight->mode != FLIGHT_MODE_HOVER;
    const float reach_m = shows_effect(flight)       ? EFFECT_REACH_M
                          : flight->throttle_unknown ? UNKNOWN_REACH_M
                                                     : FLOAT_REACH_M;

    flight->floating_m = holds ? between(height_m - reach_m, flight->floating_m, height_m + reach_m)
                               : height_m;
}

/* Limits the thrust, and by it the climb, without use of the estimate: the vehicle's model gives the thrust
 * of a climb rate. The limit is low while no height has confirmed the climb. Two speeds, 0.1 m/s (chosen)
 * below that climb rate, switch the limit on. */
static float within_climb_n(const flight_t *flight, const parameters_t *parameters, float thrust_n)
{
    const bool est = flight->mode == FLIGHT_MODE_EST_HOLD;
    const float unconfirmed_mps = flight->supervisor.state == FLIGHT_TAKEOFF ? TAKEOFF_MPS : UNCONFIRMED_MPS;
    const float fastest_mps = flight->evidence.unconfirmed
                                  ? unconfirmed_mps
                                  : parameters->value[PARAMETER_VUP] + CLIMB_MARGIN_MPS;
    const bool fast = flight->evidence.push_mps > fastest_mps - 0.1F &&
                      (flight->supervisor.state != FLIGHT_TAKEOFF || doubts(&flight->evidence, DOUBT_IMU) ||
                       felt_mps(&flight->evidence) > fastest_mps - 0.1F);

    if (!fast || !(est || (flight->mode == FLIGHT_MODE_LAW && flight->active_law == LAW_PIDT))) {
        return thrust_n;
    }
    const cascade_vehicle_t vehicle = est_law_vehicle(&flight->est, parameters);
    return at_most(thrust_n,
                   flight->hover_n + vehicle.damping_per_s * fastest_mps / vehicle.authority_mps2_per_n);
}

/* The same downwards, after a far step of the terrain that no descent has confirmed. */
static float within_descent_n(const flight_t *flight, const parameters_t *parameters, float thrust_n)
{
    const bool holds = flight->mode == FLIGHT_MODE_EST_HOLD ||
                       (flight->mode == FLIGHT_MODE_LAW && flight->active_law == LAW_PIDT);

    if (!holds || !flight->evidence.terrain_fell) {
        return thrust_n;
    }
    const cascade_vehicle_t vehicle = est_law_vehicle(&flight->est, parameters);
    const float sinking_n = vehicle.damping_per_s * UNCONFIRMED_MPS / vehicle.authority_mps2_per_n;
    return at_least(thrust_n, flight->hover_n - sinking_n);
}

/* A pilot may fly, or has given the throttle back: nothing tells. So the thrust stays just below the best
 * known hover thrust, and sinks slowly, because that may be wrong; faster while a climb is felt. What the
 * accelerometer has felt for long is forgotten, because of its bias. A pilot's climbs and falls cancel. */
static float carried_n(flight_t *flight)
{
    const estimate_t *now = &flight->est.estimator.now;
    const float step_s = seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
    const float share = step_s / CARRIED_TIME_S;
    const float felt_mps = now->speed_mps - between(-CARRIED_MOVES_MPS, now->speed_mps, CARRIED_MOVES_MPS);
    const float sunk_n = flight->carried_n_per_s * seconds_at_most(flight->supervisor.state_us, BLIND_MAX_S);
    const float n_per_mps = (felt_mps > 0.0F) ? CARRIED_CLIMB_N_PER_MPS : CARRIED_FALL_N_PER_MPS;

    estimator_amend(&flight->est.estimator, 0.0F, now->speed_mps * (1.0F - share),
                    now->bias_mps2 + share * now->speed_mps / CARRIED_BIAS_TIME_S);
    flight->carried_felt_n = between(0.0F, flight->carried_felt_n + CARRIED_N_PER_M * felt_mps * step_s,
                                     CARRIED_FELT_N);
    return flight->hover_n - CARRIED_BELOW_N - at_most(sunk_n, CARRIED_SUNK_N) - flight->carried_felt_n -
           at_least(n_per_mps * felt_mps, -CARRIED_BRAKE_N);
}

/* The IMU was silent, and no heights have checked the speed of the estimate since. */
static float within_coasting_n(const flight_t *flight, float thrust_n)
{
    if (flight->supervisor.state != FLIGHT_COASTING || flight->est.estimator.unchecked_count == 0U) {
        return thrust_n;
    }
    return between(flight->hover_n - UNCHECKED_BELOW_N, thrust_n, flight->hover_n + UNCHECKED_ABOVE_N);
}

/* FLOATING in a pilot's hands, or given back by him: nothing tells. GRAV is too low rather than too high, so
 * the vehicle sinks when it is given back, until its effect shows and its hover thrust is learned. Until then
 * more thrust is added while it is too low; never less, and nothing is learned from it. */
static float floating_n(flight_t *flight, float thrust_n)
{
    const float below_m = flight->floating_m - flight->supervisor.height.height_mm * 0.001F;
    const bool trims = flight->mode == FLIGHT_MODE_EST_HOLD && est_law_has_acceleration(&flight->est) &&
                       !shows_effect(flight);
    const float trim_n = flight->float_trim_n + FLOAT_TRIM_N_PER_M_S * below_m *
                                                    seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);

    flight->float_trim_n = trims ? between(0.0F, trim_n, FLOAT_TRIM_N) : 0.0F;
    return between(flight->hover_n - UNKNOWN_WINDOW_N - flight->held_sunk_n, thrust_n + flight->float_trim_n,
                   flight->hover_n + UNKNOWN_WINDOW_N);
}

/* While commands have no effect, and in FLOATING, where a pilot may fly without a pin that reports it, the
 * thrust stays near the hover thrust. So it fits when the commands get their effect back. In a descent the
 * limit falls with time: the thrust that was held may be one that climbs. */
static float within_power_n(flight_t *flight, float thrust_n)
{
    const bool doubted = doubts(&flight->evidence, DOUBT_THRUST);

    if (!doubted && !flight->throttle_unknown) {
        flight->held_sunk_n = 0.0F;
        return thrust_n;
    }
    if (!descends(flight->supervisor.state)) {
        flight->held_sunk_n = 0.0F;
    } else {
        flight->held_sunk_n += HELD_SINK_N_PER_S * seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
    }
    if (flight->throttle_unknown) {
        return flight->carried ? carried_n(flight) : floating_n(flight, thrust_n);
    }
    if (flight->mode == FLIGHT_MODE_IDLE) {
        return thrust_n;
    }
    const float held_n = flight->evidence.held_n - flight->held_sunk_n;
    return flight->evidence.held_down ? at_least(thrust_n, held_n - NO_AUTHORITY_WINDOW_N)
                                      : at_most(thrust_n, held_n + NO_AUTHORITY_WINDOW_N);
}

/* A landing that a height has shown near the ground ends there, also when the next heights are missing or
 * contradict the estimate: a mirror that loses most of its rays shows few. A second without thrust is its
 * end, whatever was measured. */
static float within_landing_n(flight_t *flight, float thrust_n)
{
    const flight_state_t state = flight->supervisor.state;
    const bool lands = state == FLIGHT_LANDING || (state == FLIGHT_DESCENDING && flight->landed_s > 0.0F);

    if (!lands || doubts(&flight->evidence, DOUBT_SIGHT)) {
        flight->landed_s = 0.0F;
        return thrust_n;
    }
    const float step_s = seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
    flight->unpowered_s = (flight->thrust_n > flight->idle_n) ? 0.0F : flight->unpowered_s + step_s;
    flight->landed_s = touchdown_time_s(flight->landed_s, flight->supervisor.height.height_mm * 0.001F,
                                        rocks(flight), step_s);
    return at_most(thrust_n, touchdown_limit_n(flight->landed_s, flight->hover_n));
}

/* Finds the end of a descent. While the vehicle may stand on the ground, the thrust is lowered step by step.
 * If the accelerometer measures a fall, the vehicle is in the air and the thrust returns. If it does not, the
 * vehicle stands. */
static float stand_test_n(flight_t *flight, float thrust_n)
{
    const bool by_estimate = flight->mode == FLIGHT_MODE_EST_SINK || flight->mode == FLIGHT_MODE_EST_LAND;
    const bool acceleration_valid = !doubts(&flight->evidence, DOUBT_IMU);
    const bool descent = by_estimate || (flight->mode == FLIGHT_MODE_BLIND_DESCENT && acceleration_valid);

    if (!descent || !flight->evidence.may_stand) {
        flight->stand_test_n = THRUST_MAX_N;
        return thrust_n;
    }
    const float step_n = STAND_TEST_N_PER_S * seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
    flight->stand_test_n = at_least(at_most(flight->stand_test_n, flight->thrust_n) - step_n, 0.0F);
    return at_most(thrust_n, flight->stand_test_n);
}

/* Detects a reference that is not reached, in the states in which the law acts, and a landing that does not
 * sink. */
static void judge_reach(flight_t *flight)
{
    const supervisor_t *supervisor = &flight->supervisor;
    const bool acts = supervisor->state == FLIGHT_TAKEOFF || supervisor->state == FLIGHT_FLYING;

    if (!acts || supervisor->reference_m != flight->reach_m) {
        reach_reset(&flight->reach);
    }
    flight->reach_m = supervisor->reference_m;
    flight->out_of_reach = acts ? reach_step(&flight->reach,
                                             supervisor->height.height_mm - reference_mm(flight),
                                             supervisor->step_us)
                                : lands_in_vain(flight);
}

uint16_t flight_releases(const flight_t *flight, const parameters_t *parameters)
{
    if (is_est_mode(flight->mode) || flight->piloted_s > 0.0F) {
        return FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME;
    }
    const uint16_t law = parameters_choice(parameters, PARAMETER_LAW);

    if (law == LAW_EST) {
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
    const bool without_acceleration = wants_imu && !imu_missing && !est_law_has_acceleration(&flight->est);
    const float measured_mm = (supervisor->height.sequence != 0U) ? supervisor->height.height_mm : NAN;

    out->thrust_n = at_most(flight->thrust_n + flight->stuck_pin_n, THRUST_MAX_N);
    out->idle_n = flight->idle_n;
    out->pulse_us = thrust_to_pulse_us(out->thrust_n);
    out->state = supervisor->state;
    out->flags = (uint16_t)(supervisor->flags | (imu_missing ? FLIGHT_FLAG_ATTITUDE : 0U) |
                            (flight->out_of_reach ? FLIGHT_FLAG_REACH : 0U) |
                            (without_acceleration ? FLIGHT_FLAG_IMU : 0U) |
                            flight->evidence.doubts * FLIGHT_FLAG_SIGHT);
    out->doubts = flight->evidence.doubts;
    out->imu_fault = flight->axes.fault;
    out->reference_m = supervisor->reference_m;
    out->estimate_mm = estimated ? estimator->now.height_m * 1000.0F : measured_mm;
    out->innovation_mm = estimated ? estimator->innovation_m * 1000.0F : NAN;
    out->releases = flight_releases(flight, parameters);
}

void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in,
                 flight_outputs_t *out)
{
    const flight_mode_t before = flight->mode;
    const flight_state_t state_before = flight->supervisor.state;
    flight_inputs_t checked = *in;

    check_inputs(flight, parameters, &checked);
    supervise(flight, parameters, &checked);
    arming_step(&flight->arming, &checked, state_before, &flight->supervisor);
    flight->idle_n = arming_idle_n(&flight->arming, parameters->value[PARAMETER_IDLE],
                                   flight->supervisor.state);
    update_estimator(flight, parameters, &checked);
    const bool law_changed = select_law(flight, parameters);
    update_throttle_unknown(flight, parameters, in->has_throttle);
    flight->mode = select_mode(flight, in);
    if (before != flight->mode) {
        change_mode(flight, before, flight->mode, parameters->value[PARAMETER_GRAV]);
    }
    update_hover(flight, parameters->value[PARAMETER_GRAV]);
    float_along(flight, !is_hold_mode(before));
    const bool stops = stops_on_ground(flight);
    const bool action_changed = !stops && run_mode(flight, parameters, before != flight->mode);
    if (stops) {
        flight->setpoint_n = flight->thrust_n -
                             LANDED_FADE_N_PER_S * seconds_at_most(flight->supervisor.step_us, STEP_MAX_S);
        flight->transfer_n = 0.0F;
    }
    bumpless_transfer(flight, before, law_changed || action_changed);
    const float climbing_n = within_climb_n(flight, parameters, flight->setpoint_n + flight->transfer_n);
    const float wanted_n = within_coasting_n(flight, within_descent_n(flight, parameters, climbing_n));
    const float landing_n = within_landing_n(flight, within_power_n(flight, wanted_n));
    flight->thrust_n = between(flight->idle_n, stand_test_n(flight, landing_n), THRUST_MAX_N);
    est_law_record_command(&flight->est, flight->thrust_n);
    judge_reach(flight);
    write_outputs(flight, parameters, out);
}
