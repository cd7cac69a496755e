/* Is a scan's height below the ground?
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_BEAM_H
#define CONTROL_SENSE_BEAM_H

#include <stdbool.h>

#include "control/altitude.h"

typedef struct {
    bool below_ground; /* heights so low that no noise explains them: the beam is blocked */
} beam_t;

/* One scan, exactly once. Returns true when its height may be used: it is no less than -50 mm. */
bool beam_scan(beam_t *beam, const altitude_t *altitude);

#endif
