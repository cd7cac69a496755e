/* Measures a flight, and holds it against the bounds of the response-time analysis where they are given. */
#ifndef TOOLS_PLOMADA_MEASURE_H
#define TOOLS_PLOMADA_MEASURE_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/ti/sysbios/kernel.h"

/* path: NULL, or a file that tools/rta/limits.py wrote for the costs of the flight. False when it cannot be
 * read; the reason is on stderr. */
bool measure_read_limits(const char *path);

/* After measure_read_limits(), before the flight, which is to run with the costs returned: Annex IV's,
 * cost_scale times. trace: NULL, or where the schedule goes. */
const kernel_costs_t *measure_begin(double cost_scale, FILE *trace);

/* After the flight. The trace is complete. */
void measure_end(void);

/* After measure_end(): prints what was observed, next to its bounds. False: a response, an inversion, a
 * number of blockings or a latency is beyond its bound, or a deadline was missed. */
bool measure_report(FILE *out);

#endif
