/* What a law, a bound and a hand-over may look at in one cycle. Everything is const: who reads it decides
 * nothing for others. */
#ifndef CONTROL_SITUATION_H
#define CONTROL_SITUATION_H

#include <stdbool.h>

#include "control/est/est_law.h"
#include "control/facts.h"
#include "control/modes.h"
#include "control/parameters.h"
#include "control/where/where.h"

typedef struct {
    const parameters_t *parameters;
    const evidence_t *evidence;
    const where_t *where;
    const est_law_t *est;
    control_law_t law; /* in force; PIDT replaces EST while no estimate is fresh */
    flight_mode_t mode, mode_before;
    float aim_m;    /* height to hold, above the terrain */
    float thrust_n; /* previous command */
    float idle_n;   /* minimum thrust: the idle while armed, else 0 */
    bool risen;     /* above the height that was measured on the ground, whatever that was */
    bool rocks; /* the tilt moves as in flight; an IMU that has fallen silent does not say so any longer */
} situation_t;

/* The answers to `risen` and `rocks`. */
bool situation_is_risen(const where_t *where, const est_law_t *est);
bool situation_is_rocking(const evidence_t *evidence, const est_law_t *est);

/* The thrust has no effect, with 99 %. With PLANT CLIMB it is not asked: there the throttle orders a climb
 * rate, and that no acceleration follows is what it asks for. */
bool situation_without_effect(const situation_t *now);

#endif
