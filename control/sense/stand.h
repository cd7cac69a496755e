/* Does the vehicle stand on the ground? The thrust predicts a fall, and the accelerometer does not measure
 * one, while the tilt is calm.
 *
 * Metres and seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_STAND_H
#define CONTROL_SENSE_STAND_H

#include <stdbool.h>

#include "control/sense/witness.h"

typedef struct {
    float stands_s; /* how long the vehicle has shown the signs of stand_is_sure() */
    float calm_s;   /* how long the tilt has swayed less than in the air, without a felt fall */
    float calm_mps; /* low-passed felt speed since then */
} stand_t;

/* One frame in the air, as far as the state says. calm: the tilt sways less than in the air. */
void stand_frame(stand_t *stand, const witness_t *felt, const witness_t *pushed, bool calm, float dt_s);

/* True when the tilt has been calm for 1 s: the vehicle may stand on the ground. Lower the thrust to find
 * out. */
bool stand_is_possible(const stand_t *stand);

/* True when the vehicle stands: for 0.6 s the thrust has been too low to fly, the accelerometer has felt no
 * fall, and the tilt has been calm. */
bool stand_is_sure(const stand_t *stand);

#endif
