/* The airframe with its autopilot, motors, attitude motion, turbulence, rope tugs and the ground under it.
 * Integrated with a fixed step of 0.5 ms, lazily: every query first brings the state up to timeline_now().
 *
 * The throttle commands thrust; or, with climb_rate_mps_per_n above 0, a climb rate, as in an autopilot's
 * altitude hold: none within climb_deadband_n of climb_neutral_n, beyond it in proportion, up to
 * climb_ceiling_mps. A PI controller of the vertical speed, whose closed loop lags by climb_lag_s, then gives
 * the thrust; its integral carries weight, drag and battery. On the ground the motors idle until the throttle
 * asks for a climb. Signals lost count as the lowest throttle: a descent.
 *
 * The same throttle lifts less when the battery's voltage falls, by volts_power. ArduPilot reckons with the
 * share s(v) = (1 - e) v + e v^2 of the thrust at the share v of the voltage
 * (update_lift_max_from_batt_voltage), with e = MOT_THST_EXPO, 0.65, of about 100 propellers; 0.5 for 5 inch,
 * 0.8 for 30. Near v = 1 that is the power 1 + e. An autopilot may compensate as ArduPilot does: power 0.
 *
 * Two airframes: one whose thrust is in proportion to the throttle, with one lag and a damping that is always
 * the same (what a simple estimator assumes); and that of rotors.h.
 *
 * SI units; thrust in the seed's newtons per motor. The seed's angles: roll > 0 raises the mirror's side
 * (right), pitch > 0 raises the nose. Heights: `height` of the landing gear above the terrain below the
 * centre, or, while it stands, above what carries it: 0; `altitude` above the floor. */
#ifndef SIM_DEVICES_QUADROTOR_H
#define SIM_DEVICES_QUADROTOR_H

#include <stdbool.h>

#include "sim/devices/course.h"
#include "sim/devices/naza.h"
#include "sim/devices/place.h"
#include "sim/devices/rotors.h"
#include "sim/devices/span.h"
#include "sim/devices/travel.h"
#include "sim/timeline.h"

typedef struct {
    double gain;                  /* 1 */
    double tau_s;                 /* 0.12, motor lag */
    double damping_per_s;         /* D 2.4 */
    double hover_thrust_n;        /* TH0 7.4 */
    double sag_per_s;             /* 0.001 */
    double volts_power;           /* 0: the battery's voltage does not change the thrust */
    double hover_jump_n;          /* 0: more hover thrust from hover_jump_start_s on: a load, a lost blade */
    double hover_jump_start_s;    /* 10 */
    double turbulence_mps2;       /* 0.2 rms */
    double turbulence_tau_s;      /* 0.5 */
    double attitude_rms_rad;      /* 2 deg */
    double attitude_hz;           /* 0.6: natural frequency of that motion */
    double roll_sway, pitch_sway; /* 1: share of it about each axis */
    double ground_sway;           /* 0.15: share of it on the ground; 1: somebody holds it, or a boat */
    double actuator_delay_s;      /* 0.010 behind the end of the pulse */
    double climb_rate_mps_per_n;  /* 0: the throttle commands thrust */
    double climb_neutral_n;       /* 5.88, the middle of the stick, 1.5 ms */
    double climb_deadband_n;      /* 0.47 to either side: 40 us, the default of Cleanflight; the NAZA's is not
                                     known */
    double climb_lag_s;           /* 0.25, assumed */
    double climb_ceiling_mps;     /* 6, up and down, assumed */
    double neutral_drift_n_per_s; /* 0: the middle of the stick goes up so fast with a low battery */
    double neutral_drift_max_n;   /* 3.5, 30 % of the stick */
    double
        barometer_mps;  /* 0: rms of the climb that the barometer makes up at the ground, none from 1 m up */
    naza_config_t naza; /* always armed */
    double tug_rate_per_s; /* 0; 0.4 in tug runs */
    double tug_mps2;       /* -1.5 */
    double rope_m;         /* 0: none; else the height above the floor at which a rope is taut */
    double rope_per_s2;    /* 60: Hooke's law, 180 N/m on 3 kg (chosen: a cord and the hand that holds it) */
    double hang_m; /* 0: none; else the height above the floor at which a hand, a rope from above or a branch
                      holds it, as stiff as the other rope; from below that it is lifted, at 0.2 m/s */
    span_t hang;   /* from 10 s, for good */
    double airframe; /* 0: the simple one; 1: rotors.h, which does without gain, tau and damping */
    rotors_config_t rotors;
    double lag2_s;        /* 0: of the autopilot, before the motors */
    double ground_effect; /* 1, times that of Cheeseman and Bennett */
    double gust_mps2;     /* 0 */
    span_t gust;          /* from 10 s, for 1 s */
    double
        tumble_radps; /* 0: roll rate that the autopilot does not stop before the vehicle lies on its back */
    double tumble_start_s; /* 10 */
    bool anchored;         /* bench: stands still at bench_height_m, whatever the thrust */
    double bench_height_m;
    double bench_roll_rad;  /* 0; held so, about the gear's lowest level under the centre, right side up, */
    double bench_pitch_rad; /* 0; nose up, */
    double bench_roll_start_s; /* since power-on from which on; level before, for the IMU's zero */
} quadrotor_config_t;

extern const quadrotor_config_t quadrotor_default;

typedef struct {
    double altitude_m, height_m, terrain_m, speed_mps,
        acceleration_mps2; /* acceleration of the body, upwards, without g */
    double clearance_m; /* of the gear's lowest foot: 0 on rough ground or an edge, where height_m is not */
    double thrust_n;    /* what the motors deliver now */
    double roll_rad, pitch_rad, yaw_rad; /* yaw as a compass counts, clockwise */
    double x_m, y_m, heading_rad;        /* axes of place.h; heading of the nose, counter-clockwise */
    bool collided;                       /* has flown into something */
    bool on_ground;
    bool motors;          /* running, by the autopilot's rules */
    unsigned motor_stops; /* times that they stopped over 0.1 m above the ground */
    unsigned contacts;    /* touches after the first 30 mm */
} quadrotor_state_t;

typedef struct quadrotor quadrotor_t;

/* place and course: where it flies, and how; both borrowed. NULL: an endless even floor; it stays where it
 * is. It stands on what there is at the origin. */
quadrotor_t *quadrotor_create(const quadrotor_config_t *config, const place_t *place, const course_t *course,
                              unsigned long seed);
void quadrotor_destroy(quadrotor_t *quadrotor);
/* The vehicle and its air become others while it flies; motion, noise and the autopilot's stop type go on. */
void quadrotor_change(quadrotor_t *quadrotor, const quadrotor_config_t *config);
/* Another course, begun from where it is. */
void quadrotor_follow(quadrotor_t *quadrotor, const course_t *course);
const place_t *quadrotor_place(const quadrotor_t *quadrotor);
/* Virtual time of scenario time t = 0: place, course and sag follow t. May be set later. */
void quadrotor_set_origin(quadrotor_t *quadrotor, sim_time_t origin);
/* The throttle pulse that reached the autopilot, at its falling edge. No pulse yet: no thrust. */
void quadrotor_pulse(quadrotor_t *quadrotor, sim_time_t high_ns);
const quadrotor_state_t *quadrotor_state(quadrotor_t *quadrotor);
/* Scenario time now; far below 0 before its origin is known. */
double quadrotor_scenario_s(const quadrotor_t *quadrotor);
/* The battery's voltage, as a share of that for which hover_thrust_n holds; 1 until it is told. */
void quadrotor_set_volts(quadrotor_t *quadrotor, double share);
/* The autopilot's mode: Manual, or Attitude as it is at first. */
void quadrotor_set_manual(quadrotor_t *quadrotor, bool manual);
/* Both sticks of the remote control in the lower corners, or not any more. */
void quadrotor_hold_corners(quadrotor_t *quadrotor, bool held);
/* Resets the contact counter's "was above 30 mm" memory and stops counting, as at the landing command. */
void quadrotor_stop_counting_contacts(quadrotor_t *quadrotor);

#endif
