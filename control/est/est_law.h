/* Law EST: estimator, hover thrust and cascade put together. It listens all the time, whichever law flies, so that it
 * can take over at any instant. Pure; the caller owns the state. */
#ifndef CONTROL_EST_LAW_H
#define CONTROL_EST_LAW_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/actuator.h"
#include "control/altitude.h"
#include "control/est/cascade.h"
#include "control/est/deadband.h"
#include "control/est/estimator.h"
#include "control/est/hover.h"
#include "control/parameters.h"
#include "control/ray_clock.h"

typedef enum {
    EST_MODE_HOLD,               /* keep reference_m */
    EST_MODE_LAND,               /* sink towards the ground, gently at its end */
    EST_MODE_SINK                /* the same without a height */
} est_mode_t;

typedef struct {
    estimator_t estimator;
    ray_clock_t ray_clock;
    actuator_t actuator;
    hover_t hover;
    deadband_t deadband;    /* none with PLANT THRUST */
    cascade_t cascade;
    bool started;         /* now_us holds */
    uint32_t now_us;
    float step_s;           /* of the latest est_law_predict() */
    uint32_t rays_us;       /* of the latest height */
    bool airborne;            /* it is off the ground */
    bool ramping;           /* it shall leave the ground */
    float ramp_n;           /* take-off thrust until then */
    float lift_mps2;        /* low-passed upward acceleration */
    float reference_m;
    float reference_terrain_m;      /* estimator.terrain_height_m where reference_m was given */
    float sure_hover_n;     /* hover thrust as it has been known for some seconds */
    float entry_hover_n;    /* the same when the present descent began */
    float ceiling_n;        /* most thrust of a descent */
    bool powerless;         /* commands have no effect */
    float heightless_s;     /* since the rays of the latest height */
    float frameless_s;      /* since the content of the latest frame */
    float near_ground_s;            /* for how long it has been at the ground while landing */
} est_law_t;

void est_law_init(est_law_t *law);

/* The frames of one cycle, oldest first; those that were seen before change nothing. Every cycle, at now_us. */
void est_law_predict(est_law_t *law, const parameters_t *parameters, const imu_sample_t *frames, uint16_t count,
                     uint32_t now_us);

/* A new height: its scan's 24-bit stamp and arrival. at_rest: the vehicle is known to stand on the ground. */
void est_law_fuse_height(est_law_t *law, const altitude_t *altitude, uint32_t stamp_ms, uint32_t arrival_us,
                         uint32_t age_us, bool at_rest);

/* Frames with accelerations are fresh. */
bool est_law_has_imu(const est_law_t *law);
/* They are, and a height has been seen. */
bool est_law_ready(const est_law_t *law);

/* On the ground, each cycle: the next est_law_step() begins a take-off. */
void est_law_reset(est_law_t *law, const parameters_t *parameters);
/* In the air, taking over: hover_n is the best known hover thrust, thrust_n the previous command. */
void est_law_engage(est_law_t *law, float thrust_n, float hover_n);

/* The hover thrust that is known from before what may now be in doubt, each cycle. A descent is bounded by the one that
 * it began with. */
void est_law_set_sure_hover(est_law_t *law, float hover_n, bool descending);

/* Commands have no effect: nothing is learned or expected from them, and the hover thrust is the sure one. */
void est_law_set_powerless(est_law_t *law, bool powerless);

/* What thrust does to the vehicle, as it is known now. */
cascade_vehicle_t est_law_vehicle(const est_law_t *law, const parameters_t *parameters);

/* Somebody else's thrust moves the vehicle: nothing is learned or expected from the commands until
 * est_law_engage(). */
void est_law_disengage(est_law_t *law);

/* Newtons per motor. reference_m: for EST_MODE_HOLD. */
float est_law_step(est_law_t *law, const parameters_t *parameters, est_mode_t mode, float reference_m);

/* What was commanded in the end. */
void est_law_record_command(est_law_t *law, float thrust_n);

#endif
