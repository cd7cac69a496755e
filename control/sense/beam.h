/* Is a scan a new one, and can its height be one? Identical scans are copies and are rejected: with a sensor
 * noise of 3 mm, chance makes two scans with the same digits once in some thousands.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_BEAM_H
#define CONTROL_SENSE_BEAM_H

#include <stdbool.h>

#include "control/altitude.h"

typedef struct {
    float slant_mm, spread_mm; /* of the latest scan */
    bool below_ground;         /* heights so low that no noise explains them: the beam is blocked */
} beam_t;

/* One scan, exactly once. Returns true when the scan's height may be used: it is within -50 .. 5000 mm, and
 * the scan is no copy of the one before. */
bool beam_scan(beam_t *beam, const altitude_t *altitude);

#endif
