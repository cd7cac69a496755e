/* One control cycle: supervisor (which state), control law or descent (how much thrust), actuator map
 * (which pulse).
 *
 * Pure: time is an argument; the caller owns the state. Context: Task, TaskControl only. */
#ifndef CONTROL_FLIGHT_H
#define CONTROL_FLIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/aim.h"
#include "control/arming.h"
#include "control/est/est_law.h"
#include "control/facts.h"
#include "control/flight_io.h"
#include "control/guard.h"
#include "control/handover.h"
#include "control/imu_axes.h"
#include "control/laws/laws.h"
#include "control/laws/stuck_pin.h"
#include "control/bounds.h"
#include "control/modes.h"
#include "control/parameters.h"
#include "control/sense/mounts.h"
#include "control/sense/sense.h"
#include "control/where/where.h"

typedef struct {
    where_t where; /* state, contact, throttle, sure hover thrust */
    sense_t sense;
    evidence_t evidence; /* of the present cycle, by `sense` */
    imu_axes_t axes;
    mounts_t mounts;
    handover_t handover;
    est_law_t est;
    control_law_t law; /* in force; PIDT replaces EST while no estimate is fresh */
    flight_mode_t mode;
    laws_t laws;
    stuck_pin_t pin;
    bounds_t bounds;
    aim_t aim; /* height that is held */
    arming_t arming;
    float idle_n; /* minimum thrust: the idle while armed, else 0 */
    guard_t guard;
    float thrust_n; /* previous command, without what is added against a wrong pin */
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
