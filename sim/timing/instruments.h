/* What is connected to the PC board to measure it: response times, latency, trace. One set per process, as
 * there is one board. */
#ifndef SIM_TIMING_INSTRUMENTS_H
#define SIM_TIMING_INSTRUMENTS_H

#include <stdio.h>

#include "sim/timing/latency.h"
#include "sim/timing/timing.h"

/* Before board_power_on(). The limits are kept by reference; trace NULL: none is written, else it stays open
 * until instruments_disconnect(). Takes the kernel's observer and the board's probes. */
void instruments_connect(const timing_limits_t *limits, int limit_count, FILE *trace);

/* After the run, at its end in virtual time. Completes the trace. The figures stay until the next connect. */
void instruments_disconnect(void);

const timing_t *instruments_timing(void);
const latency_t *instruments_latency(void);

#endif
