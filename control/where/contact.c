/* What breaks: a vehicle that is taken to stand while it flies gets no thrust. So the ground is left by any
 * sign, and reached by the supervisor's state alone. */
#include "control/where/contact.h"

#include "control/reach.h"
#include "control/touchdown.h"

static bool takes_off(flight_state_t state)
{
    return state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING;
}

static bool gives_up(flight_state_t state)
{
    return state == FLIGHT_COASTING || state == FLIGHT_DESCENDING || state == FLIGHT_LANDING;
}

/* True when the vehicle may not have left the ground yet. A pilot who takes the throttle during a take-off
 * makes it FLOATING on the ground. */
static bool may_stand(const contact_t *contact, const contact_signs_t *signs)
{
    return takes_off(signs->state) && contact->lifting
               ? !contact->airborne
               : signs->state == FLIGHT_FLOATING && !signs->risen && !signs->sways;
}

static contact_kind_t kind_of(const contact_t *contact, flight_state_t state)
{
    if (state == FLIGHT_GROUND) {
        return CONTACT_GROUND;
    }
    if (takes_off(state) && contact->lifting) {
        return CONTACT_LIFTING;
    }
    return (contact->touching_s > 0.0F) ? CONTACT_TOUCHING : CONTACT_AIR;
}

void contact_step(contact_t *contact, const contact_signs_t *signs)
{
    const flight_state_t state = signs->state;

    contact->lifting = state == FLIGHT_GROUND || (contact->lifting && may_stand(contact, signs));
    contact->kind = kind_of(contact, state);
}

void contact_fly(contact_t *contact)
{
    contact->airborne = true;
}

void contact_end_flight(contact_t *contact)
{
    contact->airborne = false;
}

void contact_lift_off(contact_t *contact)
{
    contact->gave_up = false;
}

static void watch_take_off(contact_t *contact, const landing_signs_t *signs)
{
    contact->gave_up = signs->state == FLIGHT_TAKEOFF ? !contact->airborne && signs->state_us < REACH_RISES_US
                                                      : contact->gave_up && gives_up(signs->state);
}

static void watch_landing(contact_t *contact, const landing_signs_t *signs)
{
    const flight_state_t state = signs->state;
    const bool lands = state == FLIGHT_LANDING || (state == FLIGHT_DESCENDING && contact->touching_s > 0.0F);
    const bool sees = lands && signs->sees;
    const bool unpowered = sees && signs->height_m < LOW_M && !signs->powered;

    contact->unpowered_s = unpowered ? contact->unpowered_s + signs->step_s : 0.0F;
    contact->touching_s = sees ? touchdown_time_s(contact->touching_s, signs->height_m, signs->rocks,
                                                  signs->step_s)
                               : 0.0F;
}

void contact_watch(contact_t *contact, const landing_signs_t *signs)
{
    watch_take_off(contact, signs);
    watch_landing(contact, signs);
    contact->kind = kind_of(contact, signs->state);
}

bool contact_lifts(const contact_t *contact)
{
    return contact->kind == CONTACT_LIFTING;
}

bool contact_stops(const contact_t *contact, flight_state_t state)
{
    return contact->gave_up && gives_up(state);
}

bool contact_ends_without_thrust(const contact_t *contact)
{
    return contact->gave_up || contact->unpowered_s > UNPOWERED_S;
}
