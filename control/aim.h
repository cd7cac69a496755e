/* Which height is held, and whether the vehicle gets there.
 *
 * Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_AIM_H
#define CONTROL_AIM_H

#include <stdbool.h>

#include "control/modes.h"
#include "control/reach.h"
#include "control/situation.h"
#include "control/where/where.h"

typedef struct {
    float floating_m; /* height that FLOATING holds */
    reach_t reach;
    float ignored_m;   /* terrain that the law ignores; 0: it follows */
    float reach_m;     /* reference that `reach` watches */
    bool out_of_reach; /* the vehicle does not get to the reference in force */
} aim_t;

/* Height to hold, above the terrain. */
float aim_height_m(const aim_t *aim, const supervisor_t *supervisor);

/* What is held minus height; NAN when no height is held. */
float aim_wanted_m(const aim_t *aim, const supervisor_t *supervisor, flight_mode_t mode);

/* One cycle. FLOATING holds the height at its start. When something else moves the vehicle, the held height
 * follows; at once where a pilot may fly. Detects a reference that is not reached, in the states in which the
 * law acts, and a landing that does not sink. */
void aim_step(aim_t *aim, const situation_t *now);

#endif
