/* The answer to `#PERF COSTS`, from a saved text, put into a table of the analysis. */
#ifndef TOOLS_PLOMADA_MEASURED_H
#define TOOLS_PLOMADA_MEASURED_H

#include <stdbool.h>

#include "tools/rta/analysis.h"

typedef struct {
    struct {
        char name[RTA_NAME_MAX + 1]; /* "": not received */
        rta_ps_t time;               /* 0: the job never ran, the gate was never held */
        bool hold;                   /* of a gate; otherwise of a job */
    } row[RTA_ROWS_MAX];
    int rows;
    bool ended;
} measured_t;

/* The last answer in the file. False, and said why on stderr, when there is none or lines of it are missing.
 */
bool measured_read(measured_t *measured, const char *path);

/* Of a job, also for its rows NAME_...; 0: not measured. */
rta_ps_t measured_cost(const measured_t *measured, const char *name);
/* The longest of all gates, and whose it is. */
rta_ps_t measured_hold(const measured_t *measured, const char **gate);

/* A row's cost becomes the board's, with everything in it; what waits at gates, the longest hold each time. A
 * row that was not measured stays. */
void measured_apply(const measured_t *measured, rta_table_t *table);

#endif
