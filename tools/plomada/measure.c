#include "measure.h"

#include <errno.h>
#include <string.h>

#include "input.h"
#include "sim/costs.h"
#include "sim/timing/instruments.h"

static const char *const release_names[] = {"FREE", "SCAN", "FRAME"};
_Static_assert(sizeof release_names / sizeof release_names[0] == LATENCY_RELEASES,
               "every release has a name");

static struct {
    costs_stretched_t costs;
    timing_limits_t limits[TIMING_JOBS_MAX]; /* of tasks, and of releases by their names */
    int limit_count;
} measure;

bool measure_read_limits(const char *path)
{
    FILE *in = path == NULL ? NULL : input_open(path);

    measure.limit_count = 0;
    if (in != NULL) {
        measure.limit_count = timing_read_limits(in, measure.limits);
        fclose(in);
    }
    if (path != NULL && (in == NULL || measure.limit_count < 0)) {
        fprintf(stderr, "plomada fly: %s: %s\n", path,
                in == NULL ? strerror(errno) : "not the limits that tools/rta/limits.py prints");
        return false;
    }
    return true;
}

const kernel_costs_t *measure_begin(double cost_scale, FILE *trace)
{
    instruments_connect(measure.limits, measure.limit_count, trace);
    return costs_stretch(&measure.costs, &costs_annex_iv, cost_scale);
}

void measure_end(void)
{
    instruments_disconnect();
}

static bool report_latency(FILE *out, int release)
{
    const latency_figures_t *figures = &instruments_latency()->by_release[release];
    const sim_time_t bound =
        timing_limits_of(measure.limits, measure.limit_count, release_names[release])->response;

    if (figures->answers == 0) {
        return true;
    }
    fprintf(out, "scan's last octet to compare value, release %s: %ld, %.4f to %.4f ms, mean %.4f, bound ",
            release_names[release], figures->answers, (double)figures->shortest / 1e6,
            (double)figures->longest / 1e6, (double)figures->total / (double)figures->answers / 1e6);
    if (measure.limit_count == 0) {
        fprintf(out, "not given\n");
    } else if (bound == SIM_NEVER) {
        fprintf(out, "none: the costs are beyond what can be scheduled\n");
    } else {
        fprintf(out, "%.4f\n", (double)bound / 1e6);
    }
    if (figures->longest > bound) {
        fprintf(out, "BROKEN: latency of %.4f ms, at most %.4f\n", (double)figures->longest / 1e6,
                (double)bound / 1e6);
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
