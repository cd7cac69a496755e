/* One control cycle in a fixed order: check the sensors, predict, supervise, fuse, choose law and mode,
 * compute the thrust, limit it, write the outputs. The one loop: what was commanded in the previous cycle
 * explains what the sensors show in this one (sense_step).
 * What breaks: the order. The supervisor needs the estimate of this cycle. The estimator needs the command of
 * the previous cycle. */
#include "control/flight.h"

#include <math.h>
#include <string.h>

#include "control/outputs.h"
#include "control/signs.h"

void flight_init(flight_t *flight)
{
    memset(flight, 0, sizeof *flight); /* a compound literal would lie on the stack of main() */
    supervisor_init(&flight->where.supervisor);
    sense_init(&flight->sense);
    imu_axes_init(&flight->axes);
    est_law_init(&flight->est);
}

/* Its pointers stay true while the cycle goes on. */
static situation_t situation_of(const flight_t *flight, const parameters_t *parameters)
{
    return (situation_t){
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
        .risen = situation_is_risen(&flight->where, &flight->est),
        .rocks = situation_is_rocking(&flight->evidence, &flight->est),
    };
}

/* Samples in: what is believed of them, what is doubted, and the estimate of now. */
static void sense(flight_t *flight, const parameters_t *parameters, flight_inputs_t *in)
{
    const situation_t before = situation_of(flight, parameters);
    const float wanted_m = aim_wanted_m(&flight->aim, &flight->where.supervisor, flight->mode);
    const command_t command = signs_of_command(&before, in, wanted_m);
    const est_before_t commanded = signs_of_before(&before);

    imu_axes_step(&flight->axes, in->frames, in->frame_count, command.grounded, command.noise_mps2);
    flight->evidence = sense_step(&flight->sense, &command, in);
    est_law_predict(&flight->est, parameters, &commanded, in->frames, in->frame_count, in->now_us);
}

/* At most one transition of the state, contact with the ground, and who has the throttle. Returns the news of
 * him. */
static pilot_news_t locate(flight_t *flight, const situation_t *now, const flight_inputs_t *in)
{
    where_t *where = &flight->where;
    const flight_state_t before = where->supervisor.state;
    const vertical_estimate_t vertical = signs_of_vertical(now, arming_hands_over(&flight->arming));

    supervisor_step(&where->supervisor, now->parameters->value[PARAMETER_LINK], in, &vertical);
    arming_step(&flight->arming, in, before, &where->supervisor);
    flight->idle_n = arming_idle_n(&flight->arming, now->parameters->value[PARAMETER_IDLE],
                                   where->supervisor.state);
    const situation_t then = situation_of(flight, now->parameters);
    const contact_signs_t contact = signs_of_contact(&then);
    const pilot_signs_t pilot = signs_of_pilot(&then, in->has_throttle);
    contact_step(&where->contact, &contact);
    return pilot_step(&where->pilot, &pilot);
}

/* Law and mode. Returns true when the law has changed. */
static bool choose(flight_t *flight, situation_t *now, bool has_throttle)
{
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
    if (now->mode_before == FLIGHT_MODE_DESCENT) {
        hover_thrust_correct(&flight->where.hover, laws_found_n(&flight->laws));
    }
    laws_change(&flight->laws, now);
    handover_mode(&flight->est, &flight->where, now);
}

/* What is known in this mode: the hover thrust, the height that it holds, and how a take-off or a landing
 * goes. */
static void learn(flight_t *flight, situation_t *now)
{
    const hover_lesson_t lesson = signs_of_hover(now);
    const landing_signs_t landing = signs_of_landing(now);

    hover_thrust_step(&flight->where.hover, &lesson);
    contact_watch(&flight->where.contact, &landing);
    aim_step(&flight->aim, now);
    now->aim_m = aim_height_m(&flight->aim, &flight->where.supervisor);
}

/* Returns the thrust to put out. What a stuck pin adds is no command: while a pilot flies, it moves nothing.
 */
static float command(flight_t *flight, const situation_t *now, bool law_changed)
{
    const float law_n = laws_step(&flight->laws, &flight->est, now, law_changed);

    if (est_law_left_ground(&flight->est)) {
        contact_fly(&flight->where.contact);
    }
    stuck_pin_step(&flight->pin, now);
    const float bounded_n = bounds_apply(&flight->bounds, now, law_n);
    const guard_case_t last = signs_of_guard(now, bounded_n + stuck_pin_added_n(&flight->pin));
    const float driven_n = guard_step(&flight->guard, &last);

    flight->thrust_n = stuck_pin_acts(&flight->pin) ? bounded_n : driven_n;
    return driven_n;
}

/* What was made of the mirrors. A scan without a height was not voted on. */
static void tell_mirrors(const flight_t *flight, const flight_inputs_t *in, flight_outputs_t *out)
{
    const uint16_t left_out = mirrors_tell(&flight->sense.senses.mirrors, out->lies);

    out->left_out = (in->mirrors != NULL && in->height_valid) ? left_out : 0U;
    for (uint16_t m = 0U; m < MIRROR_COUNT && in->mirrors == NULL; ++m) {
        out->lies[m] = NAN;
    }
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
    situation_t now = situation_of(flight, parameters);
    handover_doubts(&flight->handover, &flight->est, &flight->where, &now);
    const pilot_news_t news = locate(flight, &now, &checked);
    now = situation_of(flight, parameters);
    handover_place(&flight->est, &flight->where, &now, &checked, news, bounds_added_n(&flight->bounds));
    const bool law_changed = choose(flight, &now, in->has_throttle);
    change_mode(flight, &now);
    learn(flight, &now);
    const float driven_n = command(flight, &now, law_changed);
    if (flight->where.pilot.given_back) {
        handover_given_back(&flight->est, &now);
    }
    outputs_write(&now, flight->aim.out_of_reach, driven_n, out);
    out->bound = (uint16_t)flight->bounds.holds;
    out->imu_fault = flight->axes.fault;
    mounts_step(&flight->mounts, parameters, in, &flight->sense.senses.mirrors, out);
    out->height_mm = in->height_valid ? checked.altitude.height_mm : NAN;
    tell_mirrors(flight, in, out);
    out->releases = flight_releases(flight, parameters);
}
