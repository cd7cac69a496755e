/* One flight of one scenario: power-up, start-up of the sensors, the operator's commands, take-off to
 * landing, with the log and the metrics. Or the bench: the vehicle stands still, and at the end the operator
 * asks for #LASER. */
#ifndef SIM_SCENARIOS_FLIGHT_H
#define SIM_SCENARIOS_FLIGHT_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/board.h"
#include "sim/scenarios/metrics.h"
#include "sim/scenarios/place_file.h"
#include "sim/scenarios/scenarios.h"
#include "sim/tape.h"

#define FLIGHT_OVERRIDES_MAX 64
#define FLIGHT_FAULTS_MAX 16

/* A --set of the command line: a telecommand parameter with its text, or a plant figure. */
typedef struct {
    char name[32];
    char value[32];
} flight_override_t;

typedef struct {
    unsigned long seed;
    FILE *csv;    /* NULL: no log */
    FILE *record; /* everything at the firmware's pins, sim/tape.h; NULL: no recording */
    flight_override_t overrides[FLIGHT_OVERRIDES_MAX];
    int override_count;
    bool realtime;                   /* paced by the wall clock; of a flight then: no commands of its own */
    const char *device[BOARD_WIRES]; /* realtime: real devices as for wires_open(); NULL: the model */
    double duration_s; /* realtime and bench: how long; else scenario time of the landing command. 0 =
                        * realtime: until interrupted, else: the scenario's */
    double patience_s; /* above 0: ends when the vehicle is down with its motors off, at the latest so long
                        * after the landing command */
    line_fault_spec_t faults[FLIGHT_FAULTS_MAX]; /* of the scanner's line */
    int fault_count;
    const kernel_costs_t *costs; /* NULL: Annex IV's */
    bool dump;                   /* #LOG RATE FAST before the flight, #LOG after it */
    const char *place; /* the text of a place file that place_file_read() takes, in place of the scenario's;
                        * NULL: the scenario's */
    double height_m;   /* bench: of the landing gear above the floor */
    FILE *telemetry;   /* lines that the operator's terminal receives; NULL: none. Bench: the answer to #LASER
                        * last */
} flight_options_t;

typedef struct {
    metrics_t metrics; /* of a flight in real time those that need no plan, by the references in force */
    const char *halt;  /* why the firmware stopped, or NULL */
    bool started;      /* the scanner came up and the reference was sent */
} flight_result_t;

/* What is wrong with this value of a telecommand parameter, of SETR or of a plant figure; NULL when nothing
 * is. */
const char *flight_check(const char *name, const char *value);

/* Whether it is the name of one of them. */
bool flight_knows(const char *name);

/* Scenario time at which a line that is typed when the scenario begins is complete at the receiver. */
double flight_soonest_s(const scenario_t *scenario, const char *name, const char *value);

/* Checks and stores one NAME=VALUE. NULL when fine, else what is wrong with it. */
const char *flight_override(flight_options_t *options, const char *assignment);

/* Opens the devices and lays the place. NULL when the flight can begin, else what is wrong. Nothing is
 * written yet: its files need not be open. */
const char *flight_prepare(const scenario_t *scenario, const flight_options_t *options);

/* After flight_prepare() of the same. */
void flight_run(const scenario_t *scenario, const flight_options_t *options, flight_result_t *result);

typedef struct {
    size_t rows;
    double end_s;     /* since power-on */
    const char *halt; /* why the firmware stopped, or NULL */
} flight_replay_t;

/* The firmware again, fed with a recording: its log to csv, the lines that it sends by radio to telemetry
 * (NULL: nowhere). The columns that only the world knows come from the recording. open_loop: the operator's
 * lines were changed (tape_retype), and flown_n, what the vehicle answered to, is one more column. NULL when
 * it could begin, else why not. */
const char *flight_replay(const tape_t *tape, bool open_loop, FILE *csv, FILE *telemetry,
                          flight_replay_t *result);

#endif
