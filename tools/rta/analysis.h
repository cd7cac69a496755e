/* Response-time analysis of one processor under fixed priorities: any interrupt before any Swi before any
 * task, tasks by priority, all preemptive. Pure functions of their arguments.
 *
 * For task i, with S two context switches (per job and per blocking), B_i and n_i time and number of
 * blockings, the q-th job of a busy window (q = 0, 1, ...) ends at the least w with
 *
 *     w = (q + 1) (C_i + S) + B_i + n_i S + sum over interrupts and Swis N(w) C
 *       + sum over tasks before i N_j(w) (C_j + S)
 *
 * and R_i is the largest J + w - q P_i, up to the first job that ends before the next is released (Joseph and
 * Pandya 1986; Lehoczky 1990 for q > 0). N(w), the releases in a window, is ceil((w + J) / P), J the jitter
 * of all rows and the row's own j. For a stream in frames of n, one per F, with f = floor((w + J) / F):
 * min(ceil((w + j) / P), f n + min(n, ceil((w + J - f F) / P))).
 *
 * A chain, each member releasing the next, ends with its last task, with the blockings of all; each lower
 * task blocks the whole chain once at most where the table says by whom; after the last octet of a frame
 * nothing comes of that stream before the next frame. Growth is found by bisection.
 *
 * Times are whole picoseconds in a double: exact up to 2^53 ps (2.5 h), and without overflow above. */
#ifndef TOOLS_RTA_ANALYSIS_H
#define TOOLS_RTA_ANALYSIS_H

#include <stdbool.h>

#define RTA_ROWS_MAX 64
#define RTA_NAME_MAX 31
#define RTA_NAMES_MAX 47
#define RTA_PS_PER_MS 1e9

typedef double rta_ps_t;

typedef enum { RTA_HWI, RTA_SWI, RTA_TASK, RTA_KINDS } rta_kind_t;

typedef struct {
    char name[RTA_NAME_MAX + 1];
    rta_kind_t kind;
    int priority;      /* tasks: the larger goes first; equals count against each other */
    rta_ps_t period;   /* > 0, least time between releases */
    rta_ps_t deadline; /* tasks: > 0, from the release; may exceed the period */
    rta_ps_t cost;     /* > 0, worst execution time */
    rta_ps_t blocking; /* tasks: sum of the lower tasks' critical sections that may come first */
    int blockings;     /* tasks: their number, each worth two context switches */
    char blocked_by[RTA_NAMES_MAX + 1]; /* tasks: names of the lower tasks, with + between; "": not told */
    int accesses;                       /* server accesses per job that cost does not contain */
    bool whole;                         /* tasks: cost contains the job's context switches */
    rta_ps_t jitter;                    /* every release may come this late, beside that of the options */
    int burst_n;           /* a stream that comes in frames: releases per frame (without frames: any), */
    rta_ps_t burst_period; /* one frame per so long; 0 = endless */
} rta_row_t;

/* At least one row is a task. */
typedef struct {
    rta_row_t row[RTA_ROWS_MAX];
    int rows;
} rta_table_t;

typedef struct {
    rta_ps_t switches; /* two context switches: to a job and back */
    rta_ps_t access;   /* one server access */
    rta_ps_t jitter;   /* every release may come this late */
    bool bursts;       /* streams come in their frames; otherwise each is endless, at its period */
} rta_options_t;

/* Writes the indexes of the tasks, highest priority first, and returns their number. */
int rta_tasks(const rta_table_t *table, int index[RTA_ROWS_MAX]);

/* Demand W(D): what the task (an index) and everything before it may ask for in [0, its deadline], with its
 * blocking. Jitter and bursts are not looked at. */
rta_ps_t rta_demand_seed(const rta_table_t *table, const rta_options_t *options,
                         int task); /* as Annex IV computed it */
rta_ps_t rta_demand(const rta_table_t *table, const rta_options_t *options,
                    int task); /* horizons corrected */
rta_ps_t rta_demand_switching(const rta_table_t *table, const rta_options_t *options,
                              int task); /* and switches per job */

/* Worst response time of the task, jitter included, over all jobs of its longest busy window. INFINITY: no
 * bound found. */
rta_ps_t rta_response(const rta_table_t *table, const rta_options_t *options, int task);

/* Worst time from the event that releases member[0] to the end of the last member, a task, each member
 * releasing the next. All members before the last go before it. A lower task blocks the chain once at most,
 * where the members say by whom they are blocked. If member[0] is an interrupt of a stream in frames, it is
 * the last one of a frame. */
rta_ps_t rta_chain(const rta_table_t *table, const rta_options_t *options, const int *member, int members);

/* Share of the processor. */
typedef struct {
    double kind[RTA_KINDS];
    double switches;
    double total;
} rta_load_t;
rta_load_t rta_load(const rta_table_t *table, const rta_options_t *options);

/* Every task's response is within its deadline. */
bool rta_holds(const rta_table_t *table, const rta_options_t *options);

/* The same with every cost, critical section and server access times `factor`; switches as well if
 * switches_too. */
bool rta_holds_scaled(const rta_table_t *table, const rta_options_t *options, double factor,
                      bool switches_too);

typedef struct {
    double
        factor; /* rta_holds_scaled() up to here; not at 1.000001 times it. 0: not even with costs near 0 */
    int first_missed; /* index of a task that is late just above */
} rta_growth_t;
rta_growth_t rta_growth(const rta_table_t *table, const rta_options_t *options, bool switches_too);

#endif
