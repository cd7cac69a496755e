/* What the rays between the mirrors meet, as a line for the operator. From the mailbox of Laser_SWI, so that
 * no height waits for it. */
#ifndef FIRMWARE_SURROUNDINGS_H
#define FIRMWARE_SURROUNDINGS_H

#include <stdbool.h>

#include "control/flight_io.h"
#include "drivers/telemetry.h"

/* Builds the line of the latest scan. Returns false when there is none: with WALLS OFF, or without a scan
 * since the call before. flight: the latest outputs. TaskSendComm only. */
bool surroundings_line(telemetry_line_t *line, const flight_outputs_t *flight);

/* Whether that line warns of something that comes near. TaskSendComm only. */
bool surroundings_warn(void);

/* Builds the line of the walls' speeds, as the latest scan leaves them. Returns false as surroundings_line()
 * did last. TaskSendComm only. */
bool surroundings_drift(telemetry_line_t *line);

#endif
