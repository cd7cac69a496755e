/* Runs a piece of a test in a child process and brings its result back: one power-on of the board per
 * process. */
#ifndef TESTS_INTEGRATION_CHILD_H
#define TESTS_INTEGRATION_CHILD_H

#include <stddef.h>

#include "sim/scenarios/flight.h"

typedef void (*child_work_t)(void *argument, void *result);

/* Runs work(argument, result) in a child; its result (size octets) replaces *result. Fails the test when the
 * child crashes. */
void child_run(child_work_t work, void *argument, void *result, size_t size);

/* One flight; assignments are --set texts, NULL ends. */
void child_fly(const char *scenario, unsigned long seed, const char *const *assignments,
               flight_result_t *result);
/* The landing command at land_s of the scenario's time, in place of its own. */
void child_fly_until(const char *scenario, unsigned long seed, const char *const *assignments, double land_s,
                     flight_result_t *result);

/* Flights of seeds 1 to `seeds`; prints the means that a tuner reads. Fails the test when one did not start
 * or halted. */
typedef struct {
    double mean[METRIC_COUNT], worst[METRIC_COUNT];
} child_flights_t;
child_flights_t child_fly_seeds(const char *scenario, unsigned long seeds, const char *const *assignments);

/* The program as its users call it, in the directory SCRATCH: `plomada ARGUMENTS`, which a shell reads. What
 * it prints is put into output, cut at size - 1 characters and terminated. Returns its exit status. */
int child_plomada(const char *arguments, char *output, size_t size);

/* The file SCRATCH/name, cut at size - 1 octets and terminated. Returns how many there are; fails the test
 * without it. */
size_t child_read_file(const char *name, char *text, size_t size);

/* Everything that the operator's terminal received. */
#define CHILD_TERMINAL_MAX 100000
typedef struct {
    char text[CHILD_TERMINAL_MAX];
    size_t length;
} child_terminal_t;

void child_terminal_take(void *terminal, unsigned octet); /* board_terminal_t shape */

#endif
