/* One flight of one scenario: power-up, start-up of the sensors, the operator's commands, take-off to landing, with the
 * log and the metrics. */
#ifndef SIM_SCENARIOS_FLIGHT_H
#define SIM_SCENARIOS_FLIGHT_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/board.h"
#include "sim/scenarios/metrics.h"
#include "sim/scenarios/scenarios.h"

#define FLIGHT_OVERRIDES_MAX 64

/* A --set of the command line: a telecommand parameter with its text, or a plant figure. */
typedef struct {
    char name[32];
    char value[32];
} flight_override_t;

typedef struct {
    unsigned long seed;
    FILE *csv;                  /* NULL: no log */
    flight_override_t overrides[FLIGHT_OVERRIDES_MAX];
    int override_count;
    bool realtime;              /* paced by the wall clock, no commands of its own */
    const char *radio;          /* realtime: "pty" or a device */
    double duration_s;          /* realtime: 0 = until interrupted */
} flight_options_t;

typedef struct {
    metrics_t metrics;
    const char *halt;           /* why the firmware stopped, or NULL */
    bool started;               /* the scanner came up and the reference was sent */
} flight_result_t;

/* Checks and stores one NAME=VALUE. NULL when fine, else what is wrong with it. */
const char *flight_override(flight_options_t *options, const char *assignment);

/* Names, units and meanings of the plant figures for --help. */
void flight_print_plant_figures(FILE *out);

/* False: the flight could not begin (terminal device); *error says why. */
bool flight_run(const scenario_t *scenario, const flight_options_t *options, flight_result_t *result,
                const char **error);

#endif
