/* A scenario of the user's own, from a file. docs/campaign.md shows one. */
#ifndef PLOMADA_SCENARIO_FILE_H
#define PLOMADA_SCENARIO_FILE_H

#include "sim/scenarios/scenarios.h"

/* Whether a word of the command line names a file, and no delivered scenario: it has a dot or a slash. */
bool scenario_file_named(const char *name);

/* Reads the file for that subcommand. It stands until the next call. NULL: the reason is on stderr, with the
 * number of the line. */
const scenario_t *scenario_file_read(const char *command, const char *path);

#endif
