/* The case that a part of the control room is shown: the published situation, and beside it the modules that
 * the part may change. A test says what is the case in the words below, calls one part by its header, and
 * asks what that has done. Nothing here repeats flight_step(): how the parts act together is flown, in
 * test_flight.c.
 *
 * This file, and est/est_case.h, are all that knows how the modules remember. */
#ifndef TESTS_CONTROL_FLIGHT_CASE_H
#define TESTS_CONTROL_FLIGHT_CASE_H

#include "control/flight.h"
#include "control/outputs.h"
#include "control/signs.h"
#include "control/thrust.h"
#include "est/est_case.h"

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)

static evidence_t evidence;
static where_t where;
static situation_t now;
static flight_inputs_t in;
static flight_outputs_t out;

/* ---- state and heights, as the supervisor has found them */

static inline void in_state(flight_state_t state)
{
    where.supervisor.state = state;
}

static inline void in_state_for_us(flight_state_t state, uint32_t state_us)
{
    in_state(state);
    where.supervisor.state_us = state_us;
}

static inline void cycle_takes_us(uint32_t step_us)
{
    where.supervisor.step_us = step_us;
}

static inline void at_mm(float height_mm)
{
    where.supervisor.height.height_mm = height_mm;
}

/* The latest height, gap_us after the one before. */
static inline void height_is(float height_mm, float rate_mm_s, uint32_t gap_us, bool is_new)
{
    where.supervisor.height = (height_track_t){
        .height_mm = height_mm, .rate_mm_s = rate_mm_s, .gap_us = gap_us, .sequence = 5U, .is_new = is_new};
}

static inline void no_height_has_come(void)
{
    where.supervisor.height.sequence = 0U;
}

static inline void height_is_new(bool is_new, uint32_t age_us)
{
    where.supervisor.height.is_new = is_new;
    where.supervisor.height.age_us = age_us;
}

static inline void flagged(uint16_t flags)
{
    where.supervisor.flags = flags;
}

static inline void ordered_m(float reference_m)
{
    where.supervisor.reference_m = reference_m;
    where.supervisor.land = reference_m <= 0.0F;
}

static inline void cycle_was_at_us(bool started, uint32_t then_us)
{
    where.supervisor.started = started;
    where.supervisor.now_us = then_us;
}

static inline void order_was(uint32_t sequence)
{
    where.supervisor.reference_sequence = sequence;
}

static inline void estimate_contradicts(bool contradicts)
{
    where.supervisor.climb.estimate_age_us = contradicts ? 60000000U : 0U;
}

static inline void given_back_unseen(bool handed_over)
{
    where.supervisor.handed_over = handed_over;
}

/* ---- contact, pilot, hover thrust */

/* The vehicle stands and takes off; whether it has left the ground is told by contact_step(). */
static inline void lifting(bool is_lifting)
{
    const contact_signs_t ground = {.state = FLIGHT_GROUND};
    const contact_signs_t off = {.state = FLIGHT_FLYING};
    const bool was_airborne = where.contact.airborne;

    contact_step(&where.contact, &ground);
    where.contact.airborne = !is_lifting;
    contact_step(&where.contact, &off);
    where.contact.airborne = was_airborne;
}

static inline void airborne(bool is_airborne)
{
    where.contact.airborne = is_airborne;
}

static inline void took_off_in_vain(void)
{
    contact_t *contact = &where.contact;
    const bool was_airborne = contact->airborne;

    contact_end_flight(contact);
    contact_watch(contact, &(landing_signs_t){.state = FLIGHT_TAKEOFF});
    contact->airborne = was_airborne;
}

static inline void unknown(bool is_unknown)
{
    where.pilot.throttle = is_unknown ? THROTTLE_UNKNOWN : THROTTLE_OURS;
}

static inline void commands_show(bool has_effect)
{
    where.pilot.effect.has_effect = has_effect;
}

/* A descent that began in a pilot's hands. */
static inline void given_back(float sink_n_per_s)
{
    where.pilot.given_back = true;
    where.pilot.sink_n_per_s = sink_n_per_s;
    unknown(true);
}

static inline void nothing_learned(void)
{
    hover_thrust_step(&where.hover, &(hover_lesson_t){.gravity_n = GRAV_N, .grounded = true});
}

static inline void hovers_at_n(float thrust_n)
{
    hover_thrust_lift_off(&where.hover, thrust_n);
}

/* ---- the sensors */

static inline void sway(bool sways)
{
    evidence.sways = evidence.rocks = now.rocks = sways;
    evidence.calm = !sways;
}

static inline void feel(float felt_mps)
{
    evidence.felt_mps = felt_mps;
    evidence.felt_valid = true;
}

/* The mode changes. */
static inline void mode_changes(flight_mode_t before, flight_mode_t mode)
{
    now.mode_before = before;
    now.mode = mode;
}

static inline void mode_is(flight_mode_t mode)
{
    mode_changes(mode, mode);
}

/* FLYING with law EST at 0.5 m towards 0.6 m, all sensors fresh, cycles of 100 ms; hover thrust 7 N. */
static inline void begin(void)
{
    est_begin(FRAME_AGE_US);
    memset(&where, 0, sizeof where);
    supervisor_init(&where.supervisor);
    in_state_for_us(FLIGHT_FLYING, 0U);
    cycle_was_at_us(true, 0U);
    cycle_takes_us(100000U);
    ordered_m(0.6F);
    estimate_contradicts(false);
    height_is(500.0F, 0.0F, 100000U, false);
    contact_fly(&where.contact);
    contact_step(&where.contact, &(contact_signs_t){.state = FLIGHT_FLYING});
    hovers_at_n(GRAV_N);
    evidence = (evidence_t){.teaches = true, .calm = true, .upright = 1.0F, .shaken = 1.0F};
    now = (situation_t){.parameters = &parameters,
                        .evidence = &evidence,
                        .where = &where,
                        .est = &est,
                        .law = LAW_EST,
                        .aim_m = 0.6F,
                        .thrust_n = GRAV_N,
                        .risen = true};
    mode_is(FLIGHT_MODE_EST_HOLD);
    in = (flight_inputs_t){.attitude_ready = true, .has_throttle = true};
    out = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
}

#endif
