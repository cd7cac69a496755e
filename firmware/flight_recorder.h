/* Flight recorder: a ring buffer of control cycles in RAM. TaskControl writes it; TaskReceiveComm reads
 * it.
 *
 * It records while the state is not GROUND or the thrust is not 0, and one cycle more. So a flight stays
 * in the buffer after the landing, until the next flight needs the room.
 *
 * SLOW, as at power-up: one record per control cycle, at most one in 45 ms. The ring holds at least 56 s; at
 * a period of 108 ms it holds 135 s. FAST: every cycle and every IMU frame, so records are 25 ms apart or
 * less, whatever the law. The ring holds at least 25 s. */
#ifndef FIRMWARE_FLIGHT_RECORDER_H
#define FIRMWARE_FLIGHT_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight_io.h"
#include "firmware/published.h"

/* The linker has room for so many cells (ccs_project/plomada.cmd): wider records are fewer. */
#define FLIGHT_RECORDER_RECORDS (26250U / PUBLISHED_CELLS)

typedef enum { FLIGHT_RECORDER_SLOW, FLIGHT_RECORDER_FAST } flight_recorder_rate_t;

/* From the next cycle on; what is recorded stays. TaskReceiveComm. */
void flight_recorder_set_rate(flight_recorder_rate_t rate);

/* Records one control cycle if it is due, and with FAST the frames since the cycle before. The arguments are
 * borrowed for the call. TaskControl. */
void flight_recorder_take(const flight_inputs_t *in, const flight_outputs_t *out);

/* Records are numbered from 0 since power-up. Those with oldest <= number < next are available.
 * TaskReceiveComm. */
typedef struct {
    uint32_t oldest;
    uint32_t next;
} flight_recorder_span_t;

flight_recorder_span_t flight_recorder_span(void);

/* Copies what is recorded of one instant. Returns false when it was overwritten or does not exist yet.
 * TaskReceiveComm. */
bool flight_recorder_read(uint32_t number, published_t *record);

/* Number of the oldest record within the last `seconds` before the newest record. TaskReceiveComm. */
uint32_t flight_recorder_since(uint16_t seconds);

/* Deletes all records. TaskReceiveComm. */
void flight_recorder_clear(void);

#endif
