/* What computes the thrust: a mode, by the supervisor's state and by whether there is an estimate.
 *
 * Pure. */
#ifndef CONTROL_MODES_H
#define CONTROL_MODES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/facts.h"
#include "control/parameters.h"
#include "control/where/supervisor.h"

typedef enum {
    FLIGHT_MODE_IDLE, /* no thrust */
    FLIGHT_MODE_LAW,  /* PD, PID, PIDT */
    FLIGHT_MODE_HOVER,
    FLIGHT_MODE_FLOAT, /* holds the present height, from the heights alone */
    FLIGHT_MODE_DESCENT,
    FLIGHT_MODE_BLIND_DESCENT,
    FLIGHT_MODE_EST_HOLD, /* law EST, also in COASTING */
    FLIGHT_MODE_EST_LAND, /* landing by the estimate */
    FLIGHT_MODE_EST_SINK,
    FLIGHT_MODE_COUNT
} flight_mode_t;

/* What there is to choose by. */
typedef struct {
    control_law_t law; /* in force */
    bool estimated;    /* the estimate is good enough to fly by */
    bool airborne;     /* its take-off has left the ground */
    bool has_throttle; /* the pilot does not have the throttle */
} mode_choice_t;

/* The law in force: the chosen one, but PIDT replaces EST without an estimate. */
control_law_t modes_law(const parameters_t *parameters, bool estimated);

/* The mode of the present state. */
flight_mode_t modes_select(const supervisor_t *supervisor, const evidence_t *evidence,
                           const mode_choice_t *choice);

/* True for the modes that fly by the estimate. */
bool modes_use_estimate(flight_mode_t mode);

/* True for the modes that hold a height of their own. */
bool modes_hold(flight_mode_t mode);

/* Law EST or PIDT holds the reference. */
bool modes_hold_reference(flight_mode_t mode, control_law_t law);

#endif
