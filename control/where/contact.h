/* Does the vehicle touch the ground? One answer for everybody, from the state, the heights and the end of the
 * take-off.
 *
 * Seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_WHERE_CONTACT_H
#define CONTROL_WHERE_CONTACT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/credible.h"
#include "control/where/flight_state.h"

#define UNPOWERED_S \
    REST_HELD_S /* so long without enough thrust, and it does not sink: a free fall of 5 m \
                 */

typedef enum {
    CONTACT_GROUND,  /* on the ground, without a take-off */
    CONTACT_LIFTING, /* a take-off is commanded, and the vehicle has not left the ground, as far as is known
                      */
    CONTACT_AIR,
    CONTACT_TOUCHING /* a landing has come near the ground, and the thrust fades out */
} contact_kind_t;

typedef struct {
    contact_kind_t kind;
    bool airborne;     /* the firmware's thrust carries the vehicle */
    bool lifting;      /* since the ground the vehicle has not left it yet, as far as known */
    bool gave_up;      /* TAKEOFF ended, and the vehicle had not left the ground */
    float touching_s;  /* time near the ground since a height of LANDING showed it, see touchdown.h */
    float unpowered_s; /* time without thrust in a landing, at a height that may be the ground's */
} contact_t;

/* What one cycle shows, after the supervisor's step. */
typedef struct {
    flight_state_t state;
    bool risen; /* the height is above the one that was measured on the ground, whatever that was */
    bool sways; /* the tilt moves as in flight */
} contact_signs_t;

/* One cycle, after the supervisor's step and the height of the cycle. */
void contact_step(contact_t *contact, const contact_signs_t *signs);

/* The firmware's thrust carries the vehicle, from now on; and no longer: it stands, or a pilot flies it. */
void contact_fly(contact_t *contact);
void contact_end_flight(contact_t *contact);

/* The vehicle has left the ground after all. */
void contact_lift_off(contact_t *contact);

/* What a cycle shows later, when it is known who has the throttle. */
typedef struct {
    flight_state_t state;
    uint32_t state_us; /* time in it */
    float height_m;    /* latest height, of the supervisor */
    bool rocks;        /* the tilt moves as in flight */
    bool powered;      /* there was more thrust than the idle */
    bool sees;         /* the heights are not doubted */
    float step_s;
} landing_signs_t;

/* Later in the cycle: did the take-off end on the ground, and how near is the end of a landing? */
void contact_watch(contact_t *contact, const landing_signs_t *signs);

/* A take-off is commanded and the vehicle has not left the ground, whatever height is measured. */
bool contact_lifts(const contact_t *contact);

/* Heights or reference were lost before the vehicle left the ground: the thrust ramps down to 0. */
bool contact_stops(const contact_t *contact, flight_state_t state);

/* Without thrust it stands after a take-off that was given up, and after a landing: also on one foot, or on a
 * slope, where it shows more than level ground does. */
bool contact_ends_without_thrust(const contact_t *contact);

#endif
