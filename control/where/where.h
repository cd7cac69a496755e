/* Where the vehicle is, and who has it: the flight state, contact with the ground, the throttle and the sure
 * hover thrust. Each has a file of its own that alone writes it. */
#ifndef CONTROL_WHERE_WHERE_H
#define CONTROL_WHERE_WHERE_H

#include "control/where/supervisor.h"
#include "control/where/contact.h"
#include "control/where/hover_thrust.h"
#include "control/where/piloting.h"

typedef struct {
    supervisor_t supervisor;
    contact_t contact;
    pilot_state_t pilot;
    hover_thrust_t hover;
} where_t;

/* Time since the previous cycle, at most 0.5 s. */
float where_step_s(const where_t *where);

/* The same before the supervisor's step, in a cycle that begins at now_us; 0 in the first one. */
float where_gap_s(const where_t *where, uint32_t now_us);

bool where_descends(const where_t *where);

/* The same, but for a descent that began in a pilot's hands: its thrust has a rule of its own. */
bool where_lets_down(const where_t *where);

/* Heights or reference were lost before the vehicle left the ground: the thrust ramps down to 0. */
bool where_stops(const where_t *where);

#endif
