/* Another law on what a log holds of a flight: heights, accelerations, tilt and references. */
#ifndef PLOMADA_REPLAY_LOG_H
#define PLOMADA_REPLAY_LOG_H

#include <stdio.h>

#include "sim/scenarios/flight.h"

/* Whether it is a flight's CSV (of `plomada log` or `fly --csv`) or telemetry as a terminal saved it.
 * Rewinds. */
bool replay_log_reads(FILE *in);

/* Runs control/ open loop, with the overrides of sets: rows with the thrust that it would command, and with
 * the flown one, to csv. What the log holds and lacks is told on stderr. NULL, or what is wrong. */
const char *replay_log(FILE *in, const flight_options_t *sets, FILE *csv);

#endif
