/* What breaks: a sign that is taken from the wrong cycle. The command is that of the cycle before; everything
 * else is of this one. */
#include "control/signs.h"

#include "control/between.h"
#include "control/credible.h"

#define HEAVIEST 1.2F   /* hover thrust of the heaviest vehicle, in GRAV */
#define LIGHTEST 0.8F   /* the same of the lightest one */
#define LIGHTEST_N 5.9F /* and of the nominal vehicle: GRAV may be too high */
#define HEAVIEST_N 8.9F /* the same of the nominal vehicle, 7.4 N: the seed flew with GRAV 0 too */

/* FLOATING, and the throttle is certainly the firmware's. */
static bool commands_floating(const situation_t *now)
{
    return now->where->supervisor.state == FLIGHT_FLOATING && now->mode != FLIGHT_MODE_HOVER &&
           !pilot_is_unknown(&now->where->pilot);
}

/* True when the vehicle is in the air by the thrust that is commanded here. */
static bool is_off_ground(const situation_t *now, bool has_throttle)
{
    switch (now->where->supervisor.state) {
    case FLIGHT_GROUND:
    case FLIGHT_CUT:
        return false;
    case FLIGHT_TAKEOFF:
        return now->where->contact.airborne;
    case FLIGHT_FLYING:
        return !now->where->contact.lifting && has_throttle;
    case FLIGHT_FLOATING:
        return commands_floating(now);
    case FLIGHT_LANDING:
        return has_throttle && !(now->where->supervisor.height.height_mm < LOW_MM);
    default:
        return has_throttle;
    }
}

command_t signs_of_command(const situation_t *now, const flight_inputs_t *in, float wanted_m)
{
    const cascade_vehicle_t vehicle = est_law_vehicle(now->est, now->parameters);
    const supervisor_t *supervisor = &now->where->supervisor;
    const float hover_n = now->where->hover.thrust_n;

    return (command_t){
        .step_s = where_gap_s(now->where, in->now_us),
        .grounded = supervisor->state == FLIGHT_GROUND,
        .standing = contact_lifts(&now->where->contact),
        .off_ground = is_off_ground(now, in->has_throttle),
        .ours = in->has_throttle,
        .ordered = in->reference_sequence != supervisor->reference_sequence,
        .thrust_n = deadband_effect(&now->est->deadband, hover_n, now->thrust_n),
        .hover_n = hover_n,
        .authority_mps2_per_n = vehicle.authority_mps2_per_n,
        .damping_per_s = vehicle.damping_per_s,
        .lag_s = now->parameters->value[PARAMETER_DELAY] + now->parameters->value[PARAMETER_LAG],
        .wanted_m = wanted_m,
        .noise_mps2 = now->est->estimator.credit.noise_mps2,
    };
}

est_before_t signs_of_before(const situation_t *now)
{
    const where_t *where = now->where;

    return (est_before_t){
        .airborne = where->contact.airborne,
        .thrust_n = now->thrust_n,
        .hover_n = where->hover.thrust_n,
        .descends = where_lets_down(where),
    };
}

/* A pilot may have the vehicle, and nothing tells: without a pin on the ground, or in a descent that began
 * so. Somebody may hold it too: that is not told apart, and a vehicle that flies must not fall. An
 * IMU that has fallen silent does not say so any longer: the descent then ends by its time. */
static bool may_be_in_hands(const situation_t *now)
{
    if (!est_law_has_imu(now->est)) {
        return false;
    }
    if (now->where->supervisor.state == FLIGHT_GROUND) {
        return now->evidence->in_hands && parameters_choice(now->parameters, PARAMETER_SEL) == SEL_NONE;
    }
    return now->where->pilot.given_back && now->evidence->sways;
}

vertical_estimate_t signs_of_vertical(const situation_t *now, bool hands_over)
{
    const estimator_t *estimator = &now->est->estimator;
    const estimate_t *estimate = &estimator->now;
    const bool without_thrust = now->thrust_n <= now->idle_n &&
                                contact_ends_without_thrust(&now->where->contact);
    return (vertical_estimate_t){
        .known = est_law_ready(now->est) && estimator->confirmed,
        .height_mm = estimate->height_m * 1000.0F,
        .climb_mm_s = (estimate->speed_mps - estimate->terrain_mps) * 1000.0F,
        .felt_mm_s = now->evidence->felt_mps * 1000.0F,
        .tells_falls = now->law == LAW_EST && now->evidence->mirrors.agree && now->evidence->felt_valid,
        .stands = now->evidence->stands || without_thrust,
        .upright = now->evidence->upright,
        .sways = now->evidence->sways,
        .calm = now->evidence->calm,
        .rocks = now->rocks,
        .hands_over = hands_over,
        .in_hands = may_be_in_hands(now),
    };
}

contact_signs_t signs_of_contact(const situation_t *now)
{
    return (contact_signs_t){
        .state = now->where->supervisor.state,
        .risen = now->risen,
        .sways = now->evidence->sways,
    };
}

guard_case_t signs_of_guard(const situation_t *now, float wanted_n)
{
    const flight_state_t state = now->where->supervisor.state;

    return (guard_case_t){
        .wanted_n = wanted_n,
        .idle_n = now->idle_n,
        .heaviest_n = at_least(HEAVIEST * now->parameters->value[PARAMETER_GRAV], HEAVIEST_N),
        .lightest_n = at_most(LIGHTEST * now->parameters->value[PARAMETER_GRAV], LIGHTEST_N),
        .step_s = where_step_s(now->where),
        .ordered = state != FLIGHT_GROUND && state != FLIGHT_CUT,
        .confirmed = !now->evidence->unshown.climb,
    };
}

landing_signs_t signs_of_landing(const situation_t *now)
{
    return (landing_signs_t){
        .state = now->where->supervisor.state,
        .state_us = now->where->supervisor.state_us,
        .height_m = now->where->supervisor.height.height_mm * 0.001F,
        .rocks = now->rocks,
        .powered = now->thrust_n > now->idle_n,
        .sees = !doubts(now->evidence, DOUBT_SIGHT),
        .step_s = where_step_s(now->where),
    };
}

pilot_signs_t signs_of_pilot(const situation_t *now, bool has_throttle)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const est_law_t *est = now->est;

    return (pilot_signs_t){
        .state = supervisor->state,
        .entered = supervisor->state_us == 0U,
        .handed_over = supervisor->handed_over,
        .has_throttle = has_throttle,
        .has_pin = parameters_choice(now->parameters, PARAMETER_SEL) != SEL_NONE,
        .step_s = where_step_s(now->where),
        .height_mm = supervisor->height.height_mm,
        .rise_mps = now->evidence->rise_mps,
        .thrust_n = now->thrust_n,
        .hover_n = now->where->hover.thrust_n,
        .felt = est_law_has_acceleration(est),
        .frame_us = est->estimator.now_us,
        .pushed_mps2 = est->authority_mps2_per_n * est->actuator.thrust_n,
        .felt_mps2 = est->estimator.up_mps2,
    };
}

mode_choice_t signs_of_mode(const situation_t *now, bool has_throttle)
{
    const bool estimated = est_law_ready(now->est);

    return (mode_choice_t){
        .law = modes_law(now->parameters, estimated),
        .estimated = estimated,
        .airborne = now->where->contact.airborne,
        .has_throttle = has_throttle,
    };
}

hover_lesson_t signs_of_hover(const situation_t *now)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const flight_state_t state = supervisor->state;
    const bool lifts = contact_lifts(&now->where->contact);
    const bool floats = commands_floating(now) || pilot_shows_effect(&now->where->pilot);

    return (hover_lesson_t){
        .gravity_n = now->parameters->value[PARAMETER_GRAV],
        .step_s = where_step_s(now->where),
        .grounded = state == FLIGHT_GROUND || lifts,
        .flies = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || floats,
        .sees = (supervisor->flags & FLIGHT_FLAG_HEIGHT) == 0U &&
                !doubts(now->evidence, DOUBT_SIGHT | DOUBT_THRUST),
        .teaches = now->evidence->teaches && !situation_without_effect(now),
        .estimated = est_law_ready(now->est) && now->where->contact.airborne,
        .estimated_n = now->est->hover.thrust_n,
        .holds = state == FLIGHT_FLYING || floats,
        .thrust_n = now->thrust_n,
    };
}
