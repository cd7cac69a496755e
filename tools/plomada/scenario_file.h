/* A scenario of the user's own, from a file. docs/campaign.md shows one. */
#ifndef PLOMADA_SCENARIO_FILE_H
#define PLOMADA_SCENARIO_FILE_H

#include "sim/scenarios/scenarios.h"

/* Reads the file. It stands until the next call. NULL: the reason is on stderr, with the number of the line.
 */
const scenario_t *scenario_file_read(const char *path);

#endif
