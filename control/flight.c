/* One control cycle in a fixed order: check the sensors, predict, supervise, fuse, choose law and mode,
 * compute the thrust, limit it, write the outputs. The one loop: what was commanded in the previous cycle
 * explains what the sensors show in this one (sense_step).
 * What breaks: the order. The supervisor needs the estimate of this cycle. The estimator needs the command of
 * the previous cycle. */
#include "control/flight.h"

#include "control/outputs.h"
#include "control/signs.h"

void flight_init(flight_t *flight)
{
    *flight = (flight_t){.thrust_n = 0.0F};
    supervisor_init(&flight->where.supervisor);
    sense_init(&flight->sense);
    imu_axes_init(&flight->axes);
    est_law_init(&flight->est);
}

/* Its pointers stay true while the cycle goes on. */
static situation_t situation_of(const flight_t *flight, const parameters_t *parameters)
{
    situation_t now = {
        .parameters = parameters,
        .evidence = &flight->evidence,
        .where = &flight->where,
        .est = &flight->est,
        .law = flight->law,
        .mode = flight->mode,
        .mode_before = flight->mode,
        .aim_m = aim_height_m(&flight->aim, &flight->where.supervisor),
        .thrust_n = flight->thrust_n,
        .idle_n = flight->idle_n,
    };

    situation_derive(&now);
    return now;
}

/* Samples in: what is believed of them, and what is doubted. */
static void sense(flight_t *flight, const parameters_t *parameters, flight_inputs_t *in)
{
    const situation_t before = situation_of(flight, parameters);
    const float wanted_m = aim_wanted_m(&flight->aim, &flight->where.supervisor, flight->mode);
    const command_t command = signs_of_command(&before, in, wanted_m);

    imu_axes_step(&flight->axes, in->frames, in->frame_count, command.grounded, command.noise_mps2);
    flight->evidence = sense_step(&flight->sense, &command, in);
    handover_frames(&flight->est, &before, in);
}

/* One transition of the state at most, and the idle thrust that it allows. */
static void supervise(flight_t *flight, const situation_t *now, const flight_inputs_t *in)
{
    supervisor_t *supervisor = &flight->where.supervisor;
    const flight_state_t before = supervisor->state;
    const vertical_estimate_t vertical = signs_of_vertical(now, arming_hands_over(&flight->arming));

    supervisor_step(supervisor, now->parameters->value[PARAMETER_LINK], in, &vertical);
    arming_step(&flight->arming, in, before, supervisor);
    flight->idle_n = arming_idle_n(&flight->arming, now->parameters->value[PARAMETER_IDLE],
                                   supervisor->state);
}

/* State and contact of this cycle; the estimate is told what has changed, and gets the height. */
static void locate(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in)
{
    where_t *where = &flight->where;
    situation_t now = situation_of(flight, parameters);

    handover_doubts(&flight->handover, &flight->est, where, &now);
    supervise(flight, &now, in);
    handover_imu(&flight->est, &now);
    handover_height(&flight->est, &now, in);
    now = situation_of(flight, parameters);
    const contact_signs_t signs = signs_of_contact(&now);
    contact_step(&where->contact, &signs);
    handover_contact(&flight->est, where, &now, in->has_throttle);
}

/* Who has the throttle, then law and mode. Returns true when the law has changed. */
static bool choose(flight_t *flight, situation_t *now, bool has_throttle)
{
    const pilot_signs_t signs = signs_of_pilot(now, has_throttle);

    handover_pilot(&flight->est, &flight->where, now, pilot_step(&flight->where.pilot, &signs),
                   bounds_added_n(&flight->bounds));
    const mode_choice_t choice = signs_of_mode(now, has_throttle);
    const bool law_changed = choice.law != flight->law;
    now->law = flight->law = choice.law;
    now->mode = flight->mode = modes_select(&flight->where.supervisor, &flight->evidence, &choice);
    return law_changed;
}

static void change_mode(flight_t *flight, const situation_t *now)
{
    if (now->mode == now->mode_before) {
        return;
    }
    stuck_pin_reset(&flight->pin);
    if (now->mode_before == FLIGHT_MODE_DESCENT) {
        hover_thrust_correct(&flight->where.hover, laws_found_n(&flight->laws));
    }
    laws_change(&flight->laws, now);
    handover_mode(&flight->est, &flight->where, now);
}

/* What is known in this mode: the hover thrust, and the height that it holds. */
static void learn(flight_t *flight, situation_t *now)
{
    const hover_lesson_t lesson = signs_of_hover(now);

    hover_thrust_step(&flight->where.hover, &lesson);
    handover_hover(&flight->est, now);
    aim_float(&flight->aim, &flight->where, now->mode, now->mode_before);
    now->aim_m = aim_height_m(&flight->aim, &flight->where.supervisor);
}

/* The thrust of the law, not yet bounded. */
static float wanted_n(flight_t *flight, const situation_t *now, bool law_changed)
{
    bool changed = law_changed;

    where_watch_take_off(&flight->where);
    if (where_stops(&flight->where)) {
        laws_stop(&flight->laws, now);
    } else {
        handover_take_off(&flight->est, &flight->where, now);
        changed = laws_step(&flight->laws, &flight->est, now) || law_changed;
        stuck_pin_step(&flight->pin, now);
    }
    laws_transfer(&flight->laws, now, changed);
    return laws_thrust_n(&flight->laws);
}

/* Returns the thrust to put out. The estimate is told of it without what a stuck pin adds: while a pilot
 * flies, that moves nothing. */
static float command(flight_t *flight, const situation_t *now, bool law_changed)
{
    const float law_n = wanted_n(flight, now, law_changed);
    const float trim_n = bounds_trim_n(&flight->bounds, now);
    const landing_signs_t signs = signs_of_landing(now);

    contact_land(&flight->where.contact, &signs);
    const float bounded_n = bounds_apply(&flight->bounds, now, law_n + trim_n);
    const guard_case_t last = signs_of_guard(now, bounded_n + stuck_pin_added_n(&flight->pin));
    const float driven_n = guard_step(&flight->guard, &last);

    flight->thrust_n = stuck_pin_acts(&flight->pin) ? bounded_n : driven_n;
    handover_given_back(&flight->est, now);
    est_law_record_command(&flight->est, flight->thrust_n);
    return driven_n;
}

uint16_t flight_releases(const flight_t *flight, const parameters_t *parameters)
{
    return stuck_pin_acts(&flight->pin) ? FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME
                                        : laws_releases(parameters, flight->mode);
}

void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in,
                 flight_outputs_t *out)
{
    flight_inputs_t checked = *in;

    sense(flight, parameters, &checked);
    locate(flight, parameters, &checked);
    situation_t now = situation_of(flight, parameters);
    const bool law_changed = choose(flight, &now, in->has_throttle);
    change_mode(flight, &now);
    learn(flight, &now);
    const float driven_n = command(flight, &now, law_changed);
    aim_judge(&flight->aim, &flight->where);
    outputs_tell(&now, flight->aim.out_of_reach, out);
    outputs_drive(driven_n, out);
    out->bound = (uint16_t)flight->bounds.holds;
    out->imu_fault = flight->axes.fault;
    out->releases = flight_releases(flight, parameters);
}
