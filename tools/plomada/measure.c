#include "measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/costs.h"
#include "sim/timing/instruments.h"
#include "tools/rta/analysis.h"
#include "tools/rta/table.h"

#define PS_PER_NS 1e3

static const char *const release_names[] = {"FREE", "SCAN", "FRAME"};
_Static_assert(sizeof release_names / sizeof release_names[0] == LATENCY_RELEASES,
               "every release has a name");

static struct {
    costs_stretched_t costs;
    rta_table_t scan;  /* TaskControl released by the clock or by scans: for the latency then */
    rta_table_t table; /* released by every height and frame: the most that it may be, so for all else */
    rta_options_t options;
    timing_limits_t limits[RTA_ROWS_MAX];
    int limit_count;
    sim_time_t latency[LATENCY_RELEASES];
} measure;

static sim_time_t ns(rta_ps_t time)
{
    return isfinite(time) ? (sim_time_t)ceil(time / PS_PER_NS) : SIM_NEVER;
}

/* As costs_stretch() does, in whole nanoseconds; a blocking may be half a nanosecond longer by that. */
static void load_table(rta_table_t *table, const char *name, double scale)
{
    rta_error_t error;

    if (!rta_table_read(table, rta_table_builtin(name), &error)) {
        abort();
    }
    for (int i = 0; i < table->rows; i++) {
        rta_row_t *row = &table->row[i];

        row->cost = PS_PER_NS * round(row->cost / PS_PER_NS * scale);
        row->blocking = PS_PER_NS * ceil(row->blocking / PS_PER_NS * scale + 0.5 * row->blockings);
    }
}

static void load_tables(double scale)
{
    measure.options.switches = PS_PER_NS * (double)measure.costs.costs.switches;
    measure.options.access = PS_PER_NS * (double)measure.costs.costs.gate_access;
    load_table(&measure.scan, "plomada", scale);
    load_table(&measure.table, "plomada-est", scale);
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

static int row(const rta_table_t *table, const char *name)
{
    int index = rta_table_find(table, name, (int)strlen(name));

    if (index < 0) {
        abort();
    }
    return index;
}

static rta_ps_t chain(const rta_table_t *table, const char *last)
{
    const int member[] = {row(table, "Laser_SWI"), row(table, "TaskReceiveLaser"), row(table, last)};

    return rta_chain(table, &measure.options, member, 3);
}

/* Free-running, an altitude may have to wait for a whole period, then for the job. */
static void find_latencies(void)
{
    const int control = row(&measure.scan, "TaskControl");
    const int received[] = {row(&measure.scan, "Laser_SWI"), row(&measure.scan, "TaskReceiveLaser")};

    measure.latency[RELEASE_FREE] = ns(rta_chain(&measure.scan, &measure.options, received, 2) +
                                       measure.scan.row[control].period +
                                       rta_response(&measure.scan, &measure.options, control));
    measure.latency[RELEASE_SCAN] = ns(chain(&measure.scan, "TaskControl"));
    measure.latency[LATENCY_FRAME] = ns(chain(&measure.table, "TaskControl_height"));
}

const kernel_costs_t *measure_begin(double cost_scale, FILE *trace)
{
    const kernel_costs_t *costs = costs_stretch(&measure.costs, &costs_annex_iv, cost_scale);

    load_tables(cost_scale);
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
    fprintf(out, "scan's last octet to compare value, release %s: %ld, %.4f to %.4f ms, mean %.4f, bound ",
            release_names[release], figures->answers, (double)figures->shortest / 1e6,
            (double)figures->longest / 1e6, (double)figures->total / (double)figures->answers / 1e6);
    if (measure.latency[release] == SIM_NEVER) {
        fprintf(out, "none: the costs are beyond what can be scheduled\n");
    } else {
        fprintf(out, "%.4f\n", (double)measure.latency[release] / 1e6);
    }
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
    for (int release = 0; release < LATENCY_RELEASES; release++) {
        holds = report_latency(out, release) && holds;
    }
    return timing_print_broken(instruments_timing(), out) == 0 && holds;
}
