/* The figures of a flight as people read them: each with what it must be here and what it means; and the
 * verdict. */
#ifndef TOOLS_PLOMADA_FIGURES_H
#define TOOLS_PLOMADA_FIGURES_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/scenarios/metrics.h"
#include "sim/scenarios/scenarios.h"

/* One row for each figure that applies, and for each that the scenario expects although it does not apply.
 * judged: NULL, or which figures are known at all. */
void figures_print(FILE *out, const scenario_t *scenario, const metrics_t *metrics, bool (*judged)(metric_t));

/* Whether the flight was what the scenario expects. When not, all of it that was not is told, and what that
 * means. */
bool figures_judge(FILE *out, const scenario_t *scenario, const metrics_t *metrics);

#endif
