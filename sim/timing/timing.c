#include "sim/timing/timing.h"

#include <stdlib.h>
#include <string.h>

static const timing_limits_t unlimited = {"", SIM_NEVER, SIM_NEVER, SIM_NEVER, -1};

void timing_init(timing_t *timing, const timing_limits_t *limits, int limit_count)
{
    memset(timing, 0, sizeof *timing);
    timing->limits = limits;
    timing->limit_count = limit_count;
}

const timing_limits_t *timing_limits_of(const timing_limits_t *limits, int limit_count, const char *name)
{
    for (int i = 0; i < limit_count; i++) {
        if (strcmp(limits[i].name, name) == 0) {
            return &limits[i];
        }
    }
    return &unlimited;
}

static sim_time_t time_limit(long long ns)
{
    return ns < 0 ? SIM_NEVER : (sim_time_t)ns;
}

int timing_read_limits(FILE *in, timing_limits_t limits[TIMING_JOBS_MAX])
{
    char line[256];
    int count = 0;

    while (fgets(line, sizeof line, in) != NULL) {
        long long response, deadline, inversion;
        timing_limits_t limit;
        int end = 0;

        if (count == TIMING_JOBS_MAX ||
            sscanf(line, "%31[^,\n],%lld,%lld,%lld,%d\n%n", limit.name, &response, &deadline, &inversion,
                   &limit.blockings, &end) != 5 ||
            line[end] != '\0') {
            return -1;
        }
        limit.response = time_limit(response);
        limit.deadline = time_limit(deadline);
        limit.inversion = time_limit(inversion);
        limits[count++] = limit;
    }
    return count > 0 ? count : -1;
}

static timing_job_t *job_of(timing_t *timing, const kernel_job_t *id)
{
    for (int i = 0; i < timing->jobs; i++) {
        timing_job_t *job = &timing->job[i];

        if (job->id.kind == id->kind && job->id.number == id->number) {
            return job;
        }
    }
    if (timing->jobs == TIMING_JOBS_MAX) {
        (void)fprintf(stderr, "timing: too many jobs\n");
        abort();
    }
    timing_job_t *job = &timing->job[timing->jobs++];

    job->id = *id;
    job->limits = *timing_limits_of(timing->limits, timing->limit_count, id->name);
    return job;
}

const timing_job_t *timing_find(const timing_t *timing, const char *name)
{
    for (int i = 0; i < timing->jobs; i++) {
        if (strcmp(timing->job[i].id.name, name) == 0) {
            return &timing->job[i];
        }
    }
    return NULL;
}

/* ---- the processor ---- */

static void charge_inversion(timing_t *timing, const timing_job_t *lower, sim_time_t time)
{
    for (int i = 0; i < timing->jobs; i++) {
        timing_job_t *job = &timing->job[i];

        if (job->pending && job->id.priority > lower->id.priority) {
            job->inversion += time;
        }
    }
}

/* Before anything else changes. */
static void account(timing_t *timing, sim_time_t when)
{
    timing_job_t *job = timing->running;

    if (job != NULL) {
        job->used += when - timing->running_since;
        if (job->id.kind == KERNEL_TASK) {
            charge_inversion(timing, job, when - timing->running_since);
        }
    }
    timing->running_since = when;
}

/* ---- one job ---- */

static void begin(timing_job_t *job, const kernel_job_t *id)
{
    job->id = *id;
    job->pending = true;
    job->blocked = false;
    job->released = id->released;
    job->inversion = 0;
    job->blockings = 0;
}

static void finish(timing_job_t *job, const kernel_job_t *id, sim_time_t when)
{
    sim_time_t response = when - id->released;

    job->jobs++;
    job->late += response > job->limits.deadline;
    job->pending = false;
    if (response > job->longest_response) {
        job->longest_response = response;
        job->longest_since = id->released;
    }
    if (job->inversion > job->longest_inversion) {
        job->longest_inversion = job->inversion;
    }
    if (job->blockings > job->most_blockings) {
        job->most_blockings = job->blockings;
    }
}

static void block(timing_job_t *job, sim_time_t when)
{
    job->blockings++;
    job->blocked = true;
    job->blocked_at = when;
}

static void enter(timing_job_t *job, sim_time_t when)
{
    if (job->blocked && when - job->blocked_at > job->longest_wait) {
        job->longest_wait = when - job->blocked_at;
    }
    job->blocked = false;
}

void timing_observe(void *context, sim_time_t when, kernel_event_t event, const kernel_job_t *id, int detail)
{
    timing_t *timing = context;
    timing_job_t *job = job_of(timing, id);

    (void)detail;
    account(timing, when);
    switch (event) {
    case KERNEL_RELEASED:
        if (id->kind == KERNEL_TASK) {
            begin(job, id);
        }
        break;
    case KERNEL_DISPATCHED:
        timing->running = job;
        break;
    case KERNEL_PREEMPTED:
        timing->running = NULL;
        break;
    case KERNEL_FINISHED:
        timing->running = NULL;
        finish(job, id, when);
        break;
    case KERNEL_GATE_BLOCKED:
        timing->running = NULL;
        block(job, when);
        break;
    case KERNEL_GATE_ENTERED:
        enter(job, when);
        break;
    case KERNEL_GATE_LEFT:
    case KERNEL_PRIORITY:
        break;
    }
}

void timing_conclude(timing_t *timing)
{
    timing->end = timeline_now();
    account(timing, timing->end);
    for (int i = 0; i < timing->jobs; i++) {
        timing_job_t *job = &timing->job[i];

        job->late += job->pending && timing->end - job->released > job->limits.deadline;
    }
}

/* ---- report ---- */

static const char *const kind_names[] = {"Hwi", "Swi", "Task"};
_Static_assert(sizeof kind_names / sizeof kind_names[0] == KERNEL_TASK + 1, "every kind has a name");

/* Hwis by number, Swis and tasks by falling priority. */
static int by_precedence(const void *left, const void *right)
{
    const kernel_job_t *a = &(*(const timing_job_t *const *)left)->id;
    const kernel_job_t *b = &(*(const timing_job_t *const *)right)->id;

    if (a->kind != b->kind) {
        return (int)a->kind - (int)b->kind;
    }
    if (a->priority != b->priority) {
        return a->kind == KERNEL_HWI ? a->priority - b->priority : b->priority - a->priority;
    }
    return a->number - b->number;
}

static const char *ms(char text[24], sim_time_t time)
{
    if (time == SIM_NEVER) {
        return "-";
    }
    (void)snprintf(text, 24, "%.4f", (double)time / 1e6);
    return text;
}

static const char *number(char text[24], int count)
{
    if (count < 0) {
        return "-";
    }
    (void)snprintf(text, 24, "%d", count);
    return text;
}

static double share(const timing_t *timing, sim_time_t used)
{
    return timing->end > 0 ? (double)used / (double)timing->end : 0.0;
}

static void print_job(const timing_t *timing, const timing_job_t *job, FILE *out)
{
    char text[6][24];
    bool task = job->id.kind == KERNEL_TASK;

    (void)fprintf(out, "%-4s %-16s %8ld %9s %9s %9s %5ld", kind_names[job->id.kind], job->id.name, job->jobs,
                  ms(text[0], job->longest_response), ms(text[1], job->limits.response),
                  ms(text[2], job->limits.deadline), job->late);
    if (task) {
        (void)fprintf(out, " %9s %9s %9s %5d %3s", ms(text[3], job->longest_wait),
                      ms(text[4], job->longest_inversion), ms(text[5], job->limits.inversion),
                      job->most_blockings, number(text[0], job->limits.blockings));
    } else {
        (void)fprintf(out, " %9s %9s %9s %5s %3s", "-", "-", "-", "-", "-");
    }
    (void)fprintf(out, " %7.4f\n", share(timing, job->used));
}

static void print_totals(const timing_t *timing, FILE *out)
{
    double load[3] = {0.0, 0.0, 0.0};
    double interrupts = 0.0;

    for (int i = 0; i < timing->jobs; i++) {
        const timing_job_t *job = &timing->job[i];

        load[job->id.kind] += share(timing, job->used);
        interrupts += job->id.kind == KERNEL_HWI ? (double)job->jobs : 0.0;
    }
    (void)fprintf(out, "processor load: Hwis %.4f, Swis %.4f, tasks with their switches %.4f, total %.4f\n",
                  load[KERNEL_HWI], load[KERNEL_SWI], load[KERNEL_TASK], load[0] + load[1] + load[2]);
    (void)fprintf(out, "interrupts per second: %.1f\n",
                  timing->end > 0 ? interrupts * 1e9 / (double)timing->end : 0.0);
}

void timing_print(const timing_t *timing, FILE *out)
{
    const timing_job_t *sorted[TIMING_JOBS_MAX];

    for (int i = 0; i < timing->jobs; i++) {
        sorted[i] = &timing->job[i];
    }
    qsort(sorted, (size_t)timing->jobs, sizeof sorted[0], by_precedence);
    (void)fprintf(out, "%-4s %-16s %8s %9s %9s %9s %5s %9s %9s %9s %5s %3s %7s\n", "kind", "name", "jobs",
                  "response", "bound", "deadline", "late", "gate wait", "inversion", "allowed", "waits",
                  "max", "load");
    for (int i = 0; i < timing->jobs; i++) {
        print_job(timing, sorted[i], out);
    }
    print_totals(timing, out);
}

static int print_time_over(FILE *out, const timing_job_t *job, const char *what, sim_time_t seen,
                           sim_time_t limit)
{
    if (seen <= limit) {
        return 0;
    }
    (void)fprintf(out, "BROKEN: %s: %s of %.4f ms, at most %.4f\n", job->id.name, what, (double)seen / 1e6,
                  (double)limit / 1e6);
    return 1;
}

static int print_count_over(FILE *out, const timing_job_t *job, const char *what, long seen, long limit)
{
    if (limit < 0 || seen <= limit) {
        return 0;
    }
    (void)fprintf(out, "BROKEN: %s: %ld %s, at most %ld\n", job->id.name, seen, what, limit);
    return 1;
}

int timing_print_broken(const timing_t *timing, FILE *out)
{
    int broken = 0;

    for (int i = 0; i < timing->jobs; i++) {
        const timing_job_t *job = &timing->job[i];

        broken += print_time_over(out, job, "response", job->longest_response, job->limits.response);
        broken += print_time_over(out, job, "priority inversion", job->longest_inversion,
                                  job->limits.inversion);
        broken += print_count_over(out, job, "waits at gates in one job", job->most_blockings,
                                   job->limits.blockings);
        broken += print_count_over(out, job, "missed deadlines", job->late, 0);
    }
    return broken;
}
