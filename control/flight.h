/* One control cycle: supervisor (which state), control law or descent (how much thrust), actuator map
 * (which pulse).
 *
 * Pure: time is an argument; the caller owns the state. Context: Task, TaskControl only. */
#ifndef CONTROL_FLIGHT_H
#define CONTROL_FLIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/arming.h"
#include "control/descent.h"
#include "control/est/effect.h"
#include "control/est/est_law.h"
#include "control/facts.h"
#include "control/flight_io.h"
#include "control/imu_axes.h"
#include "control/parameters.h"
#include "control/pid.h"
#include "control/pidt.h"
#include "control/reach.h"
#include "control/sense/sense.h"
#include "control/supervisor.h"

/* What computes the thrust. */
typedef enum {
    FLIGHT_MODE_IDLE, /* no thrust */
    FLIGHT_MODE_LAW,  /* PD, PID, PIDT */
    FLIGHT_MODE_HOVER,
    FLIGHT_MODE_FLOAT, /* holds the present height, from the heights alone */
    FLIGHT_MODE_DESCENT,
    FLIGHT_MODE_BLIND_DESCENT,
    FLIGHT_MODE_EST_HOLD, /* law EST, also in COASTING */
    FLIGHT_MODE_EST_LAND, /* landing by the estimate */
    FLIGHT_MODE_EST_SINK
} flight_mode_t;

typedef struct {
    supervisor_t supervisor;
    sense_t sense;
    evidence_t evidence; /* of the present cycle, by `sense` */
    imu_axes_t axes;
    uint16_t doubts;       /* DOUBT_* of the previous cycle */
    bool lifting;          /* since the ground the vehicle has not left it yet, as far as known */
    float landed_s;        /* time near the ground since a height of LANDING showed it, see touchdown.h */
    float unpowered_s;     /* how long it has had no thrust; valid while landed_s > 0 */
    bool not_lifted;       /* TAKEOFF ended and the vehicle had not left the ground */
    float held_sunk_n;     /* how far the window of its thrust has sunk in the present descent */
    float stand_test_n;    /* upper limit while a descent tests whether the vehicle stands */
    float floating_m;      /* height that FLOATING holds */
    float carried_n_per_s; /* rate at which its thrust sinks */
    float carried_felt_n;  /* how far felt climbs have lowered it */
    bool carried;          /* DESCENDING that began in a pilot's hands */
    bool throttle_unknown; /* FLOATING, carried or landing in vain; no pin tells who has the throttle */
    float vain_landing_s;  /* how long a landing has had too little thrust to fly, and it does not sink */
    float float_trim_n;    /* added while throttle_unknown, see floating_n() */
    effect_t effect;       /* valid while throttle_unknown; judged in FLOATING */
    uint32_t effect_us;    /* latest frame in it */
    flight_mode_t mode;
    pid_state_t pid;
    bool integral; /* the law had an integral action in the previous cycle */
    pidt_state_t pidt;
    uint32_t pidt_rays_us; /* rays of the height before, law PIDT */
    est_law_t est;
    control_law_t active_law; /* law in force; PIDT replaces EST while no estimate is fresh */
    descent_t descent;
    arming_t arming;
    float idle_n; /* minimum thrust: the idle while armed, else 0 */
    reach_t reach;
    float reach_m;       /* reference that `reach` watches */
    bool out_of_reach;   /* the vehicle does not get to the reference in force */
    float hover_n;       /* sure hover thrust: from the estimator, or else the mean of the
                          * thrust with a time constant of 2.5 s, in flight and while nothing is
                          * doubted. Limits: GRAV +-1.5 N */
    bool hover_learned;  /* hover_n was learned in this flight; it stays valid while the
                          * pilot has the throttle */
    float learned_s;     /* how long hover_n has been learned, at most 2.5 s */
    float setpoint_n;    /* thrust that the mode computes */
    float transfer_n;    /* added to setpoint_n; fades to 0: bumpless transfer between modes */
    float thrust_n;      /* previous command, without stuck_pin_n */
    float stuck_pin_n;   /* added to the output while the pin says that the pilot has the throttle */
    float piloted_s;     /* for how long it has said so */
    float blind_ahead_s; /* by which a blind descent is ahead of its time */
} flight_t;

void flight_init(flight_t *flight);

/* One cycle of the control task. parameters: a set that parameters_set() keeps within its limits. in:
 * borrowed for the call. out: always written.
 *
 * Sampling. With RELEASE FREE the law takes one sample in each call, with or without a new height, as the
 * seed's law did. With RELEASE SCAN it takes one sample per new height; between them it holds its thrust.
 *
 * Bumpless transfer. A mode that takes over in the air starts from the previous thrust, limited to 0.5 N
 * from hover. The difference then fades with a time constant of 0.4 s. Two exceptions start at once: a
 * descent with a height, and the law on the ground. A change of the law alone starts exactly from the
 * previous thrust.
 *
 * Descents use law EST's estimate while it is fresh, whichever law is chosen. Without it they use the
 * heights alone; without heights they are open loop. */
void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in,
                 flight_outputs_t *out);

/* Events that release the next cycle, FLIGHT_RELEASE_*. PD and PID: as the parameter RELEASE says. PIDT:
 * each height. EST, and every law while the estimator or a pilot flies: each height and each IMU frame.
 * flight_step() writes the same value to its outputs. */
uint16_t flight_releases(const flight_t *flight, const parameters_t *parameters);

#endif
