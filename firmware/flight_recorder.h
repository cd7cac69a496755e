/* The flight recorder: a ring of the control cycles in RAM, written by TaskControl, read by TaskReceiveComm.
 *
 * Records while the state is not GROUND or there is thrust, and one cycle more, so that a flight stays there after its
 * landing until the next one needs the room. At most one record in 45 ms, so that the ring holds 72 s or more: 170 s at
 * 108 ms, 160 s at 100 ms. */
#ifndef FIRMWARE_FLIGHT_RECORDER_H
#define FIRMWARE_FLIGHT_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight.h"
#include "drivers/flight_log.h"

#define FLIGHT_RECORDER_RECORDS 1600U   /* 16000 cells */

/* One control cycle. TaskControl. */
void flight_recorder_take(const flight_inputs_t *in, const flight_outputs_t *out);

/* Records are numbered from 0 on since power-up: oldest <= number < next are there. TaskReceiveComm. */
typedef struct {
    uint32_t oldest;
    uint32_t next;
} flight_recorder_span_t;

flight_recorder_span_t flight_recorder_span(void);

/* False when it is overwritten, or not there yet. TaskReceiveComm. */
bool flight_recorder_read(uint32_t number, flight_log_t *record);

/* The oldest of the records of the latest `seconds`, counted back from the newest one. TaskReceiveComm. */
uint32_t flight_recorder_since(uint16_t seconds);

/* Forgets all records. TaskReceiveComm. */
void flight_recorder_clear(void);

#endif
