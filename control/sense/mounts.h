/* Mirrors and IMU check each other: each new scan of three mirrors goes to zeros.h and plane.h. With other
 * layouts nothing is judged, and nothing is known.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_MOUNTS_H
#define CONTROL_SENSE_MOUNTS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight_io.h"
#include "control/parameters.h"
#include "control/sense/mirrors.h"
#include "control/sense/plane.h"
#include "control/sense/zeros.h"

typedef struct {
    zeros_t zeros;
    plane_t plane;
    uint32_t sequence, time_us; /* of the latest scan */
} mounts_t;

/* Once in each cycle, at its end. in: what the sensors have sent. mirrors, out: of this cycle. Writes what
 * was found: out->mirrors, out->imu_fault, which is what gravity has found before, and the flag. */
void mounts_step(mounts_t *mounts, const parameters_t *parameters, const flight_inputs_t *in,
                 const mirrors_t *mirrors, flight_outputs_t *out);

#endif
