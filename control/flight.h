/* One control cycle: supervisor (who decides), control law or descent (how much thrust), actuator map (which pulse).
 * Pure: time is an argument; the caller owns the state. Task context, TaskControl only. */
#ifndef CONTROL_FLIGHT_H
#define CONTROL_FLIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/arming.h"
#include "control/descent.h"
#include "control/est/est_law.h"
#include "control/flight_io.h"
#include "control/integrity.h"
#include "control/parameters.h"
#include "control/pid.h"
#include "control/pidt.h"
#include "control/reach.h"
#include "control/supervisor.h"

/* What the thrust is computed by. */
typedef enum {
    FLIGHT_MODE_IDLE,                    /* nobody: none */
    FLIGHT_MODE_LAW,                     /* PD, PID, PIDT */
    FLIGHT_MODE_HOVER,
    FLIGHT_MODE_FLOAT,                   /* the height of the moment, by the heights */
    FLIGHT_MODE_DESCENT,
    FLIGHT_MODE_BLIND_DESCENT,
    FLIGHT_MODE_EST_HOLD,                    /* law EST, also while it coasts */
    FLIGHT_MODE_EST_LAND,                    /* by the estimate, as all that follows */
    FLIGHT_MODE_EST_SINK
} flight_mode_t;

typedef struct {
    supervisor_t supervisor;
    integrity_t integrity;
    uint32_t scan_sequence;         /* of the latest scan that was judged */
    uint32_t scan_time_us;          /* of the latest height that was compared */
    bool scan_fit;
    uint16_t doubts;                /* of the cycle before */
    bool hopping;                   /* TAKEOFF was left without leaving the ground */
    float floating_m;               /* the height that FLOATING holds */
    flight_mode_t mode;
    pid_state_t pid;
    bool integral;                  /* the law had an integral action in the previous cycle */
    pidt_state_t pidt;
    uint32_t pidt_rays_us;          /* of its previous height */
    est_law_t est;
    control_law_t active_law;           /* PIDT in place of EST without a fresh estimate */
    descent_t descent;
    arming_t arming;
    float idle_n;                   /* least thrust: the armed idle, or 0 */
    reach_t reach;
    float reach_m;                  /* the reference that it is about */
    bool out_of_reach;              /* the reference in force, as it seems */
    float hover_n;                  /* hover thrust that is sure: the estimator's, or else the mean of the thrust, followed
                                     * with 2.5 s in flight while nothing is doubted; GRAV +-1.5 N */
    bool hover_learned;                  /* in the present flight: hover_n outlasts a pilot's turn */
    float learned_s;                /* for how long it has been learned, at most 2.5 s */
    float setpoint_n;                /* thrust that the mode asks for */
    float transfer_n;                /* added to it, fades out: bumpless transfer between modes */
    float thrust_n;                 /* the previous command */
} flight_t;

void flight_init(flight_t *flight);

/* One release of the control task. With RELEASE FREE the law takes a sample in each call, as the seed's did, be the
 * height new or not; with SCAN only when a new height has come, and holds its thrust otherwise. What takes over in the
 * air starts from the thrust of before, at most 0.5 N from hover, and the difference fades with 0.4 s; but a descent
 * with a height acts at once, and so does the law on the ground. Descents fly by law EST's estimate whenever it is
 * fresh, whatever the law; without it by the heights alone, or by none. A change of law alone starts exactly from the thrust
 * of before. parameters: a set kept by parameters_set(). */
void flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in, flight_outputs_t *out);

/* What the next cycle waits for, FLIGHT_RELEASE_*: PD and PID follow the parameter RELEASE, PIDT each height; EST, and every
 * other law while the estimator flies, each height and each IMU frame. flight_step() tells the same in its outputs. */
uint16_t flight_releases(const flight_t *flight, const parameters_t *parameters);

#endif
