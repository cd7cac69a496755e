/* A flight whose state is written down, for the tests of the parts that flight_step() is made of. Each
 * function below calls one part, as flight_step() does, with what the state says. How it flies:
 * test_flight.c, est/test_est_law.c. */
#ifndef TESTS_CONTROL_FLIGHT_CASE_H
#define TESTS_CONTROL_FLIGHT_CASE_H

#include "control/between.h"
#include "control/flight.h"
#include "control/outputs.h"
#include "control/signs.h"
#include "control/thrust.h"
#include "control/touchdown.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define GRAV_N 7.0F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)

static flight_t f;
static parameters_t parameters;
static flight_inputs_t in;
static flight_outputs_t out;

static inline void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

/* FLYING with law EST at 0.5 m, all sensors fresh, cycles of 100 ms; hover thrust 7 N. */
static inline void begin(void)
{
    parameters_init(&parameters);
    flight_init(&f);
    est_law_predict(&f.est, &parameters, NULL, 0U, 0U);
    est_law_reset(&f.est, &parameters);
    f.est.estimator.initialised = f.est.estimator.has_frames = f.est.estimator.felt = true;
    f.est.estimator.confirmed = true;
    f.est.estimator.now.height_m = f.est.estimator.filter.estimate.height_m = 0.5F;
    f.est.airborne = true;
    f.where.supervisor.state = FLIGHT_FLYING;
    f.where.supervisor.started = true;
    f.where.supervisor.step_us = 100000U;
    f.where.supervisor.height.height_mm = 500.0F;
    f.where.supervisor.height.sequence = 5U;
    f.where.supervisor.reference_m = 0.6F;
    f.mode = FLIGHT_MODE_EST_HOLD;
    f.law = LAW_EST;
    f.where.hover.thrust_n = f.thrust_n = f.laws.setpoint_n = GRAV_N;
    f.where.hover.learned = true;
    f.where.hover.learned_s = 2.5F;
    f.est.actuator.thrust_n = GRAV_N;
    in = (flight_inputs_t){.attitude_ready = true, .has_throttle = true};
    memset(&out, 0, sizeof out);
    f.evidence = (evidence_t){.teaches = true, .calm = true, .upright = 1.0F, .shaken = 1.0F};
}

static inline void sway(bool sways)
{
    f.evidence.sways = f.evidence.rocks = sways;
    f.evidence.calm = !sways;
}

static inline void feel(float felt_mps)
{
    f.evidence.felt_mps = felt_mps;
    f.evidence.felt_valid = true;
}

static inline void lose_the_estimate(void)
{
    f.est.estimator.initialised = false;
}

static inline void unknown(bool is_unknown)
{
    f.where.pilot.throttle = is_unknown ? THROTTLE_UNKNOWN : THROTTLE_OURS;
}

static inline bool has_imu_and_rocks(void)
{
    return f.evidence.rocks && est_law_has_imu(&f.est);
}

/* What contact follows from state and lift-off, for states that a test has written down. */
static inline void touch(void)
{
    const flight_state_t state = f.where.supervisor.state;
    contact_t *contact = &f.where.contact;

    contact->kind = state == FLIGHT_GROUND ? CONTACT_GROUND
                    : (state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING) && contact->lifting
                        ? CONTACT_LIFTING
                        : CONTACT_AIR;
}

static inline situation_t situation_after(flight_mode_t before)
{
    touch();
    return (situation_t){
        .parameters = &parameters,
        .evidence = &f.evidence,
        .where = &f.where,
        .est = &f.est,
        .law = f.law,
        .mode = f.mode,
        .mode_before = before,
        .aim_m = aim_height_m(&f.aim, &f.where.supervisor),
        .thrust_n = f.thrust_n,
        .idle_n = f.idle_n,
        .risen = f.where.supervisor.height.height_mm * 0.001F - f.est.ground_m > 0.08F,
        .rocks = has_imu_and_rocks(),
    };
}

static inline situation_t situation(void)
{
    return situation_after(f.mode);
}

static inline void update_hover(void)
{
    const situation_t now = situation();
    const hover_lesson_t lesson = signs_of_hover(&now);

    hover_thrust_step(&f.where.hover, &lesson);
    handover_hover(&f.est, &now);
}

static inline void change_mode(flight_mode_t before, flight_mode_t mode)
{
    f.mode = mode;
    const situation_t now = situation_after(before);

    stuck_pin_reset(&f.pin);
    if (before == FLIGHT_MODE_DESCENT) {
        hover_thrust_correct(&f.where.hover, f.laws.descent.trim_n);
    }
    laws_change(&f.laws, &now);
    handover_mode(&f.est, &now);
}

static inline void transfer(flight_mode_t before, bool law_changed)
{
    const situation_t now = situation_after(before);

    laws_transfer(&f.laws, &now, law_changed);
}

static inline bool run_mode(bool mode_changed)
{
    const situation_t now = situation_after(mode_changed ? FLIGHT_MODE_COUNT : f.mode);
    const bool changed = laws_step(&f.laws, &f.est, &now);

    stuck_pin_step(&f.pin, &now);
    return changed;
}

static inline bool step_pid(void)
{
    const situation_t now = situation();
    const bool had_integral = f.laws.integral;

    f.laws.setpoint_n = law_pid_step(&f.laws, &f.est, &now);
    return f.laws.integral != had_integral;
}

static inline void step_pidt(float reference_m)
{
    situation_t now = situation();

    now.aim_m = reference_m;
    f.laws.setpoint_n = law_pidt_step(&f.laws, &f.est, &now);
}

static inline void step_descent(bool started)
{
    const situation_t now = situation_after(started ? FLIGHT_MODE_COUNT : f.mode);

    f.laws.setpoint_n = law_descent_step(&f.laws, &f.est, &now);
}

static inline void step_stuck_pin(void)
{
    f.mode = FLIGHT_MODE_HOVER;
    const situation_t now = situation();

    stuck_pin_step(&f.pin, &now);
}

/* All limits, and what floating adds. */
static inline float bounded_n(float thrust_n)
{
    const situation_t now = situation();
    const float trim_n = bounds_trim_n(&f.bounds, &now);
    const float bounded = bounds_apply(&f.bounds, &now, thrust_n + trim_n);

    handover_given_back(&f.est, &now);
    return bounded;
}

static inline float landing_n(float thrust_n)
{
    const situation_t now = situation();
    const landing_signs_t signs = signs_of_landing(&now);

    contact_land(&f.where.contact, &signs);
    return bounded_n(thrust_n);
}

static inline void change_doubts(void)
{
    const situation_t now = situation();

    handover_doubts(&f.handover, &f.est, &f.where.hover, &now);
}

/* The estimator's part of a cycle: the IMU, the height, contact. */
static inline void update_estimator(void)
{
    situation_t now = situation();

    handover_imu(&f.est, &now);
    if (f.where.supervisor.height.is_new) {
        est_law_fuse_height(&f.est, &in.altitude, in.height_stamp_ms, in.height_time_us, in.height_age_us,
                            supervisor_is_at_rest(&f.where.supervisor));
    }
    const contact_signs_t signs = signs_of_contact(&now);
    contact_step(&f.where.contact, &signs);
    handover_contact(&f.est, &f.where, &now, in.has_throttle);
}

static inline bool select_law(void)
{
    const control_law_t before = f.law;

    f.law = modes_law(&parameters, est_law_ready(&f.est));
    return f.law != before;
}

static inline flight_mode_t select_mode(void)
{
    return modes_select(&f.where.supervisor, &f.evidence,
                        &(mode_choice_t){.law = f.law,
                                         .estimated = est_law_ready(&f.est),
                                         .airborne = f.est.airborne,
                                         .has_throttle = in.has_throttle});
}

static inline void update_throttle(bool has_throttle)
{
    const situation_t now = situation();
    const pilot_signs_t signs = signs_of_pilot(&now, has_throttle);

    handover_pilot(&f.est, &now, pilot_step(&f.where.pilot, &signs), f.bounds.trim_n);
}

static inline void float_along(bool entered)
{
    aim_float(&f.aim, &f.where, f.mode, entered ? FLIGHT_MODE_IDLE : FLIGHT_MODE_EST_HOLD);
}

static inline bool stops_on_ground(void)
{
    const supervisor_t *supervisor = &f.where.supervisor;

    contact_watch_take_off(&f.where.contact, supervisor->state, supervisor->state_us, f.est.airborne);
    return contact_stops(&f.where.contact, supervisor->state);
}

static inline void write_outputs(void)
{
    const situation_t now = situation();

    outputs_tell(&now, f.aim.out_of_reach, &out);
    outputs_drive(f.thrust_n + f.pin.more_n, &out);
    out.imu_fault = f.axes.fault;
    out.releases = flight_releases(&f, &parameters);
}

static inline command_t described(void)
{
    const situation_t now = situation();

    return signs_of_command(&now, &in, aim_wanted_m(&f.aim, &f.where.supervisor, f.mode));
}

static inline bool may_be_in_hands(void)
{
    const situation_t now = situation();

    return signs_of_vertical(&now, false).carried;
}

#endif
