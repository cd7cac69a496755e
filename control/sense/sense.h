/* Samples in, evidence out: which tilt, which frames and which height are believed in this cycle, and what
 * all sensors together show.
 *
 * Metres, seconds, newtons per motor, radians; positive is upwards. Times named _us are on one wrapping
 * 32-bit clock. Pure: no clock and no static state; the caller owns the state. Context: one Task. No function
 * waits or reports an error; inputs that are not finite are rejected. */
#ifndef CONTROL_SENSE_SENSE_H
#define CONTROL_SENSE_SENSE_H

#include <stdbool.h>
#include <stdint.h>

#include "control/facts.h"
#include "control/flight_io.h"
#include "control/ray_clock.h"
#include "control/sense/senses.h"
#include "control/sense/verdict.h"

typedef struct {
    senses_t senses;
    verdict_t verdict;
    ray_clock_t ray_clock;
    uint32_t rays_us;        /* when the rays of the latest scan were taken */
    uint32_t scan_sequence;  /* latest scan that was checked */
    uint32_t height_time_us; /* latest height that was compared with the witnesses */
    bool scan_fit;           /* the latest scan's height may be used */
} sense_t;

/* Begins a state that is all zero: no doubt, nothing known. Call once before the first cycle. */
void sense_init(sense_t *sense);

/* Once in each cycle. command: of the previous cycle. Removes from *in what must not be used: heights in
 * doubt, rejected tilts, frames with such a tilt. Returns what the sensors show. */
evidence_t sense_step(sense_t *sense, const command_t *command, flight_inputs_t *in);

#endif
