/* Law EST: estimator, hover thrust and cascade together. The estimator runs in every cycle, also while
 * another law flies, so EST can take over at any instant.
 *
 * Order in one cycle: est_law_predict() with the thrust that was really commanded in the cycle before,
 * est_law_fuse_height() if there is a new height, est_law_step() if EST flies.
 *
 * Metres, seconds, newtons per motor; positive is upwards. Times named _us are on one wrapping 32-bit
 * clock. Pure; the caller owns the state. */
#ifndef CONTROL_EST_LAW_H
#define CONTROL_EST_LAW_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/actuator.h"
#include "control/est/ahead.h"
#include "control/altitude.h"
#include "control/est/cascade.h"
#include "control/est/deadband.h"
#include "control/est/estimator.h"
#include "control/est/hover.h"
#include "control/est/learning.h"
#include "control/est/let_down.h"
#include "control/est/lift_off.h"
#include "control/est/terrain_keep.h"
#include "control/parameters.h"
#include "control/ray_clock.h"

#define HOVER_BOUND_N 2.0F /* mass 20 % off (1.4 N), gusts; see hover_thrust.c */

/* What is doubted in this cycle. */
typedef struct {
    bool without_authority; /* commands have no effect (doubt THRUST): nothing is learned or predicted from
                             * them, and the hover thrust is the sure one */
    bool no_effect;         /* the same, with 99 % in the latest scan alone: nothing is learned from them */
    bool accelerations; /* the accelerometer is wrong (doubt IMU): accelerations in the frames are ignored */
    bool rocks;         /* the tilt moves as it does in flight, see touchdown.h */
    bool seen;          /* two mirrors agree on the heights: a landing needs no ceiling of the thrust */
} est_doubts_t;

typedef struct {
    estimator_t estimator;
    ray_clock_t ray_clock;
    actuator_t actuator;
    hover_t hover;
    deadband_t deadband; /* used only with PLANT CLIMB */
    bool started;        /* now_us has a value */
    uint32_t now_us;
    float step_s;               /* duration of the latest cycle */
    uint32_t rays_us;           /* when the rays of the latest height were taken */
    float authority_mps2_per_n; /* of the present model, see cascade.h; > 0 */
    lift_off_t lift;
    let_down_t down;
    terrain_keep_t terrain;
    ahead_t ahead;
    float sure_hover_n;    /* hover thrust from before the present doubt */
    float flown_hover_n;   /* sure_hover_n at the end of the flight before; 0: none with this GRAV */
    float flown_gravity_n; /* GRAV of that flight */
    est_doubts_t doubted;
    float heightless_s; /* time since the rays of the latest height */
    float frameless_s;  /* time since the latest frame was measured */
    bool flew;          /* est_law_step() was called in this cycle */
    bool left_ground;   /* in this cycle */
} est_law_t;

void est_law_init(est_law_t *law);

/* What the cycle before has left. */
typedef struct {
    bool airborne;  /* the vehicle has left the ground (contact.h); the same below */
    float thrust_n; /* what was really commanded, also by another law: hover thrust and prediction drift
                     * without it */
    float hover_n;  /* the hover thrust as it is known without any present doubt. A descent limits its thrust
                     * by  the value that it had when the descent began */
    bool descends;  /* the state is a descent */
} est_before_t;

/* Prediction step, once in every cycle. frames: IMU frames, oldest first; borrowed for the call. Frames that
 * were processed before change nothing. now_us: time of the cycle. */
void est_law_predict(est_law_t *law, const parameters_t *parameters, const est_before_t *before,
                     const imu_sample_t *frames, uint16_t count, uint32_t now_us);

/* A valid new height. */
typedef struct {
    terrain_sight_t sight;
    uint32_t stamp_ms;   /* 24-bit sensor time of its scan */
    uint32_t arrival_us; /* of its last octet */
    uint32_t age_us;     /* from its rays to that octet, when nothing delays it */
} est_height_t;

/* Correction step, once per valid new height. at_rest: the vehicle is known to stand on the ground. */
void est_law_fuse_height(est_law_t *law, const est_height_t *height, bool airborne, bool at_rest);

/* True when the latest IMU frame is at most ESTIMATOR_FRESH_US old. */
bool est_law_has_imu(const est_law_t *law);
/* True when the estimator uses accelerations. False: no frame has had them lately, and the thrust model and
 * the heights alone make the estimate. */
bool est_law_has_acceleration(const est_law_t *law);
/* True when est_law_has_imu() is true and the estimator has received at least one height; without
 * accelerations only while heights are fresh. */
bool est_law_ready(const est_law_t *law);

/* Call in every cycle on the ground. airborne: until this cycle the vehicle flew. While no heights come, the
 * estimate stays where it stood. */
void est_law_reset(est_law_t *law, const parameters_t *parameters, bool airborne);
/* Call in the air, when EST takes over. hover_n: best known hover thrust. */
void est_law_engage(est_law_t *law, float hover_n);

/* Call in every cycle, after est_law_predict(). */
void est_law_doubt(est_law_t *law, const est_doubts_t *doubts);

/* Present model of the vehicle, with the estimated hover thrust. */
cascade_vehicle_t est_law_vehicle(const est_law_t *law, const parameters_t *parameters);

/* The pilot has the throttle. Nothing is learned or predicted from the commands until est_law_engage(). */
void est_law_disengage(est_law_t *law);

/* What law EST shall do in this cycle. */
typedef struct {
    est_mode_t mode;
    float reference_m; /* above the terrain, EST_MODE_HOLD only */
    bool airborne;
    float hover_n; /* as in est_before_t */
    bool descends;
} est_order_t;

/* Thrust command in newtons per motor. On the ground the thrust ramps up in EST_MODE_HOLD, until the vehicle
 * has left it. */
float est_law_step(est_law_t *law, const parameters_t *parameters, const est_order_t *order);

/* True when the vehicle has left the ground in this cycle's est_law_step(). */
bool est_law_left_ground(const est_law_t *law);

#endif
