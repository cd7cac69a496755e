#include "tools/rta/analysis.h"

#include <math.h>
#include <string.h>

/* A response is given up beyond so many of the longest periods or deadlines, jobs of a busy window, or steps
 * of one. */
#define SEARCH_PERIODS 16
#define SEARCH_JOBS 10000
#define SEARCH_STEPS 100000
#define GROWTH_STEP 1e-6

int rta_tasks(const rta_table_t *table, int index[RTA_ROWS_MAX])
{
    int count = 0;

    for (int i = 0; i < table->rows; i++) {
        int at = count;

        if (table->row[i].kind != RTA_TASK) {
            continue;
        }
        while (at > 0 && table->row[index[at - 1]].priority < table->row[i].priority) {
            index[at] = index[at - 1];
            at--;
        }
        index[at] = i;
        count++;
    }
    return count;
}

static rta_ps_t job_cost(const rta_row_t *row, const rta_options_t *options)
{
    return row->cost + row->accesses * options->access;
}

static rta_ps_t job_switches(const rta_row_t *row, const rta_options_t *options)
{
    return row->kind == RTA_TASK && !row->whole ? options->switches : 0.0;
}

static bool goes_before(const rta_row_t *row, const rta_row_t *task)
{
    return row != task && (row->kind != RTA_TASK || row->priority >= task->priority);
}

/* ---- demand ---- */

typedef rta_ps_t (*horizon_t)(const rta_table_t *table, int row, rta_ps_t deadline);

static rta_ps_t own_horizon(const rta_table_t *table, int row, rta_ps_t deadline)
{
    (void)table;
    (void)row;
    return deadline;
}

/* Annex IV counts its k-th interrupt up to the k-th task's deadline at most (the first up to the second's,
 * those after the last task's up to the last's). */
static rta_ps_t frozen_horizon(const rta_table_t *table, int row, rta_ps_t deadline)
{
    int task[RTA_ROWS_MAX];
    int last = rta_tasks(table, task) - 1;
    int k = 0;

    if (table->row[row].kind != RTA_HWI) {
        return deadline;
    }
    for (int i = 0; i < row; i++) {
        k += table->row[i].kind == RTA_HWI ? 1 : 0;
    }
    k = k < 1 ? 1 : k;
    return fmin(deadline, table->row[task[k < last ? k : last]].deadline);
}

static rta_ps_t demand(const rta_table_t *table, const rta_options_t *options, int task, horizon_t horizon,
                       bool switching)
{
    const rta_row_t *self = &table->row[task];
    rta_ps_t sum = self->blocking + self->blockings * options->switches;

    for (int i = 0; i < table->rows; i++) {
        const rta_row_t *row = &table->row[i];

        if (row == self || goes_before(row, self)) {
            sum += ceil(horizon(table, i, self->deadline) / row->period) *
                   (job_cost(row, options) + (switching ? job_switches(row, options) : 0.0));
        }
    }
    return sum;
}

rta_ps_t rta_demand_seed(const rta_table_t *table, const rta_options_t *options, int task)
{
    return demand(table, options, task, frozen_horizon, false);
}

rta_ps_t rta_demand(const rta_table_t *table, const rta_options_t *options, int task)
{
    return demand(table, options, task, own_horizon, false);
}

rta_ps_t rta_demand_switching(const rta_table_t *table, const rta_options_t *options, int task)
{
    return demand(table, options, task, own_horizon, true);
}

/* ---- response ---- */

static bool comes_in_frames(const rta_row_t *row, const rta_options_t *options)
{
    return options->bursts && row->burst_period > 0.0;
}

/* Octets of a frame keep their distance on the wire, and wait before they interrupt for the row's jitter at
 * most; whole frames may come late. */
static double arrivals(const rta_row_t *row, const rta_options_t *options, rta_ps_t window)
{
    rta_ps_t waited = window + row->jitter;
    rta_ps_t wide = waited + options->jitter;
    double frames;

    if (!comes_in_frames(row, options)) {
        return ceil(wide / row->period);
    }
    frames = floor(wide / row->burst_period);
    return fmin(ceil(waited / row->period),
                frames * row->burst_n +
                    fmin(row->burst_n, ceil((wide - frames * row->burst_period) / row->period)));
}

/* The same for a stream whose frame ends as the window begins: what waited of it, then nothing until the next
 * frame. */
static double arrivals_after_frame(const rta_row_t *row, const rta_options_t *options, rta_ps_t window)
{
    double last = fmin(row->burst_n, 1.0 + floor(row->jitter / row->period));
    rta_ps_t gap = row->burst_period - row->burst_n * row->period - row->jitter - options->jitter;

    return window <= gap ? last : last + arrivals(row, options, window - gap);
}

static double rate(const rta_row_t *row, const rta_options_t *options)
{
    return comes_in_frames(row, options) ? fmin(1.0 / row->period, row->burst_n / row->burst_period)
                                         : 1.0 / row->period;
}

/* A task's job, or a chain that ends with it. */
typedef struct {
    const rta_row_t *self;
    const rta_row_t *frame; /* stream whose frame ends at the release; NULL: none */
    rta_ps_t blocked;
} job_t;

/* The smallest window with window = own + interference(window); INFINITY beyond the limit. */
static rta_ps_t completion(const rta_table_t *table, const rta_options_t *options, const job_t *job,
                           rta_ps_t own, rta_ps_t limit)
{
    rta_ps_t window = own;

    for (int step = 0; step < SEARCH_STEPS && window <= limit; step++) {
        rta_ps_t sum = own;

        for (int i = 0; i < table->rows; i++) {
            const rta_row_t *row = &table->row[i];

            if (goes_before(row, job->self)) {
                double count = row == job->frame ? arrivals_after_frame(row, options, window)
                                                 : arrivals(row, options, window);

                sum += count * (job_cost(row, options) + job_switches(row, options));
            }
        }
        if (sum <= window) {
            return window;
        }
        window = sum;
    }
    return INFINITY;
}

static rta_ps_t search_limit(const rta_table_t *table)
{
    rta_ps_t longest = 0.0;

    for (int i = 0; i < table->rows; i++) {
        longest = fmax(longest, fmax(table->row[i].period, table->row[i].deadline));
    }
    return SEARCH_PERIODS * longest;
}

/* The response if it is at most `limit`, else INFINITY. */
static rta_ps_t response(const rta_table_t *table, const rta_options_t *options, const job_t *job,
                         rta_ps_t limit)
{
    const rta_row_t *self = job->self;
    rta_ps_t cost = job_cost(self, options) + job_switches(self, options);
    rta_ps_t late = options->jitter + self->jitter;
    rta_ps_t worst = 0.0;

    for (int q = 0; q < SEARCH_JOBS; q++) {
        rta_ps_t release = q * self->period;
        rta_ps_t done = completion(table, options, job, job->blocked + (q + 1) * cost, release + limit);

        worst = fmax(worst, late + done - release);
        if (worst > limit) {
            return INFINITY;
        }
        if (late + done <= release + self->period) {
            return worst;
        }
    }
    return INFINITY;
}

static rta_ps_t blocking(const rta_row_t *task, const rta_options_t *options)
{
    return task->blocking + task->blockings * options->switches;
}

rta_ps_t rta_response(const rta_table_t *table, const rta_options_t *options, int task)
{
    const rta_row_t *self = &table->row[task];
    const job_t job = {self, NULL, blocking(self, options)};

    return response(table, options, &job, search_limit(table));
}

/* Are the first `length` characters one of the names in "A+B+C"? */
static bool names(const char *list, const char *name, size_t length)
{
    while (*list != '\0') {
        size_t next = strcspn(list, "+");

        if (next == length && strncmp(list, name, length) == 0) {
            return true;
        }
        list += next + (list[next] == '+' ? 1U : 0U);
    }
    return false;
}

static bool named_before(const rta_table_t *table, const int *member, int index, const char *name,
                         size_t length)
{
    for (int i = 0; i < index; i++) {
        if (names(table->row[member[i]].blocked_by, name, length)) {
            return true;
        }
    }
    return false;
}

/* Different tasks that may block a member. */
static int blockers(const rta_table_t *table, const int *member, int members)
{
    int count = 0;

    for (int i = 0; i < members; i++) {
        const char *at = table->row[member[i]].blocked_by;

        while (*at != '\0') {
            size_t length = strcspn(at, "+");

            count += named_before(table, member, i, at, length) ? 0 : 1;
            at += length + (at[length] == '+' ? 1U : 0U);
        }
    }
    return count;
}

static rta_ps_t chain_blocking(const rta_table_t *table, const rta_options_t *options, const int *member,
                               int members)
{
    rta_ps_t sum = 0.0, longest = 0.0;
    bool told = true;

    for (int i = 0; i < members; i++) {
        const rta_row_t *row = &table->row[member[i]];

        sum += blocking(row, options);
        if (row->blockings > 0) {
            longest = fmax(longest, row->blocking / row->blockings + options->switches);
        }
        told = told && (row->blocked_by[0] != '\0' || blocking(row, options) == 0.0);
    }
    return told ? fmin(sum, blockers(table, member, members) * longest) : sum;
}

rta_ps_t rta_chain(const rta_table_t *table, const rta_options_t *options, const int *member, int members)
{
    const rta_row_t *first = &table->row[member[0]];
    const job_t job = {
        .self = &table->row[member[members - 1]],
        .frame = first->kind == RTA_HWI && comes_in_frames(first, options) ? first : NULL,
        .blocked = chain_blocking(table, options, member, members),
    };

    return response(table, options, &job, search_limit(table));
}

/* ---- load and growth ---- */

rta_load_t rta_load(const rta_table_t *table, const rta_options_t *options)
{
    rta_load_t load = {.total = 0.0};

    for (int i = 0; i < table->rows; i++) {
        const rta_row_t *row = &table->row[i];

        load.kind[row->kind] += job_cost(row, options) * rate(row, options);
        load.switches += job_switches(row, options) * rate(row, options);
    }
    load.total = load.kind[RTA_HWI] + load.kind[RTA_SWI] + load.kind[RTA_TASK] + load.switches;
    return load;
}

/* Index of the first task that is late, -1 when none is. */
static int late_task(const rta_table_t *table, const rta_options_t *options)
{
    for (int i = 0; i < table->rows; i++) {
        const rta_row_t *row = &table->row[i];
        const job_t job = {row, NULL, blocking(row, options)};

        if (row->kind == RTA_TASK && response(table, options, &job, row->deadline) > row->deadline) {
            return i;
        }
    }
    return -1;
}

bool rta_holds(const rta_table_t *table, const rta_options_t *options)
{
    return late_task(table, options) < 0;
}

static int late_task_scaled(const rta_table_t *table, const rta_options_t *options, double factor,
                            bool switches_too)
{
    rta_table_t grown = *table;
    rta_options_t dearer = *options;

    for (int i = 0; i < grown.rows; i++) {
        grown.row[i].cost = ceil(grown.row[i].cost * factor);
        grown.row[i].blocking = ceil(grown.row[i].blocking * factor);
    }
    dearer.access = ceil(dearer.access * factor);
    if (switches_too) {
        dearer.switches = ceil(dearer.switches * factor);
    }
    return late_task(&grown, &dearer);
}

bool rta_holds_scaled(const rta_table_t *table, const rta_options_t *options, double factor,
                      bool switches_too)
{
    return late_task_scaled(table, options, factor, switches_too) < 0;
}

rta_growth_t rta_growth(const rta_table_t *table, const rta_options_t *options, bool switches_too)
{
    double holds = 0.0, breaks = GROWTH_STEP;

    while (rta_holds_scaled(table, options, breaks, switches_too)) {
        holds = breaks;
        breaks *= 2.0;
    }
    while (holds > 0.0 && breaks - holds > 0.5 * GROWTH_STEP * holds) {
        double middle = 0.5 * (holds + breaks);

        if (rta_holds_scaled(table, options, middle, switches_too)) {
            holds = middle;
        } else {
            breaks = middle;
        }
    }
    return (rta_growth_t){holds, late_task_scaled(table, options, breaks, switches_too)};
}
