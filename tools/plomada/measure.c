#include "measure.h"

#include <math.h>
#include <stdlib.h>

#include "sim/costs.h"
#include "sim/timing/instruments.h"
#include "tools/rta/analysis.h"
#include "tools/rta/table.h"

#define PS_PER_NS 1e3

static const char *const release_names[RELEASE_COUNT] = {"FREE", "SCAN"};

static struct {
    costs_stretched_t costs;
    rta_table_t table;
    rta_options_t options;
    timing_limits_t limits[RTA_ROWS_MAX];
    int limit_count;
    sim_time_t latency[RELEASE_COUNT];
} measure;

static sim_time_t ns(rta_ps_t time)
{
    return isinf(time) ? SIM_NEVER : (sim_time_t)ceil(time / PS_PER_NS);
}

/* As costs_stretch() does, in whole nanoseconds; a blocking may be half a nanosecond longer by that. */
static void stretch_table(double scale)
{
    measure.options.switches = PS_PER_NS * (double)measure.costs.costs.switches;
    measure.options.access = PS_PER_NS * (double)measure.costs.costs.gate_access;
    for (int i = 0; i < measure.table.rows; i++) {
        rta_row_t *row = &measure.table.row[i];

        row->cost = PS_PER_NS * round(row->cost / PS_PER_NS * scale);
        row->blocking = PS_PER_NS * ceil(row->blocking / PS_PER_NS * scale + 0.5 * row->blockings);
    }
}

static void load_table(double scale)
{
    rta_error_t error;

    if (!rta_table_read(&measure.table, rta_table_builtin("plomada"), &error)) {
        abort();
    }
    stretch_table(scale);
}

static void find_limits(void)
{
    int task[RTA_ROWS_MAX];

    measure.limit_count = rta_tasks(&measure.table, task);
    for (int i = 0; i < measure.limit_count; i++) {
        const rta_row_t *row = &measure.table.row[task[i]];

        measure.limits[i] = (timing_limits_t){
            .name = row->name,
            .response = ns(rta_response(&measure.table, &measure.options, task[i])),
            .deadline = ns(row->deadline),
            .inversion = ns(row->blocking),
            .blockings = row->blockings,
        };
    }
}

static int row(const char *name, int length)
{
    int index = rta_table_find(&measure.table, name, length);

    if (index < 0) {
        abort();
    }
    return index;
}

/* Free-running, an altitude may have to wait for a whole period, then for the job. */
static void find_latencies(void)
{
    const int chain[] = {row("Laser_SWI", 9), row("TaskReceiveLaser", 16), row("TaskControl", 11)};
    const rta_row_t *control = &measure.table.row[chain[2]];

    measure.latency[RELEASE_SCAN] = ns(rta_chain(&measure.table, &measure.options, chain, 3));
    measure.latency[RELEASE_FREE] = ns(rta_chain(&measure.table, &measure.options, chain, 2) + control->period +
                                       rta_response(&measure.table, &measure.options, chain[2]));
}

const kernel_costs_t *measure_begin(double cost_scale, FILE *trace)
{
    const kernel_costs_t *costs = costs_stretch(&measure.costs, &costs_annex_iv, cost_scale);

    load_table(cost_scale);
    find_limits();
    find_latencies();
    instruments_connect(measure.limits, measure.limit_count, trace);
    return costs;
}

void measure_end(void)
{
    instruments_disconnect();
}

static bool report_latency(FILE *out, int release)
{
    const latency_figures_t *figures = &instruments_latency()->by_release[release];

    if (figures->answers == 0) {
        return true;
    }
    fprintf(out, "scan's last octet to compare value, release %s: %ld, %.4f to %.4f ms, mean %.4f, bound %.4f\n",
            release_names[release], figures->answers, (double)figures->shortest / 1e6, (double)figures->longest / 1e6,
            (double)figures->total / (double)figures->answers / 1e6, (double)measure.latency[release] / 1e6);
    if (figures->longest > measure.latency[release]) {
        fprintf(out, "BROKEN: latency of %.4f ms, at most %.4f\n", (double)figures->longest / 1e6,
                (double)measure.latency[release] / 1e6);
        return false;
    }
    return true;
}

bool measure_report(FILE *out)
{
    bool holds = true;

    timing_print(instruments_timing(), out);
    for (int release = 0; release < RELEASE_COUNT; release++) {
        holds = report_latency(out, release) && holds;
    }
    return timing_print_broken(instruments_timing(), out) == 0 && holds;
}
