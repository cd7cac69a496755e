/* The CSV text of a table of tasks, Swis and interrupts.
 *
 * First line: name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings and then any of
 * accesses,burst_n,burst_period_ms,jitter_ms,blocked_by. kind is hwi, swi or task. Times in ms, 0..100000,
 * plain decimals. Priority, deadline, blocking, blockings and blocked_by concern tasks and are not looked at
 * in other rows; blocking, blockings and the further columns may be empty or "-"; burst_n and burst_period_ms
 * go together; blocked_by is names of rows with + between. Blank lines and lines that begin with '#' are
 * skipped. */
#ifndef TOOLS_RTA_TABLE_H
#define TOOLS_RTA_TABLE_H

#include <stdbool.h>

#include "tools/rta/analysis.h"

#define RTA_TEXT_MAX 65536 /* characters of a table, terminator included */

typedef struct {
    int line; /* 1.. */
    char reason[128];
} rta_error_t;

/* False and *error when the text is not a table. */
bool rta_table_read(rta_table_t *table, const char *text, rta_error_t *error);

/* Index of the row of that name, -1 when there is none. */
int rta_table_find(const rta_table_t *table, const char *name, int length);

/* Assignments such as "TaskControl.period_ms=25", each one number of one row, in this order. False and
 * error->reason (line 0) when one is not possible. */
bool rta_table_set(rta_table_t *table, const char *const *assignment, int assignments, rta_error_t *error);

/* The text of a table that the program carries, "seed", "plomada" or "plomada-est"; NULL for another name. */
const char *rta_table_builtin(const char *name);

#endif
