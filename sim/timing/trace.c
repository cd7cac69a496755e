#include "sim/timing/trace.h"

#include <stdlib.h>
#include <string.h>

#define BITS_PER_OCTET 10.0
#define NOT_BLOCKED (-1)
#define FREE (-1)

enum { PROCESSOR = 1, JOBS, GATES, WIRES }; /* process ids of the groups */
enum { FRAMES = 1, COMPARES, PULSES };      /* thread ids of the wires */
enum { TRACKS_PER_KIND = 1000 };

/* ---- events ---- */

static void begin(trace_t *trace, const char *phase, int group, int track, const char *name)
{
    json_object(&trace->json, NULL);
    json_text(&trace->json, "ph", phase);
    json_whole(&trace->json, "pid", group);
    json_whole(&trace->json, "tid", track);
    json_text(&trace->json, "name", name);
}

static void time_field(trace_t *trace, const char *field, sim_time_t time)
{
    json_fixed(&trace->json, field, (double)time / (double)SIM_US, 3);
}

/* With its arguments, which the caller writes until end(). */
static void span(trace_t *trace, int group, int track, const char *name, sim_time_t from, sim_time_t to)
{
    begin(trace, "X", group, track, name);
    time_field(trace, "ts", from);
    time_field(trace, "dur", to - from);
    json_object(&trace->json, "args");
}

static void instant(trace_t *trace, int group, int track, const char *name, sim_time_t when)
{
    begin(trace, "i", group, track, name);
    time_field(trace, "ts", when);
    json_text(&trace->json, "s", "t");
    json_object(&trace->json, "args");
}

static void end(trace_t *trace)
{
    json_close(&trace->json);
    json_close(&trace->json);
}

static void label(trace_t *trace, const char *what, int group, int track, const char *name)
{
    begin(trace, "M", group, track, what);
    json_object(&trace->json, "args");
    json_text(&trace->json, "name", name);
    end(trace);
}

static void order(trace_t *trace, const char *what, int group, int track, int index)
{
    begin(trace, "M", group, track, what);
    json_object(&trace->json, "args");
    json_whole(&trace->json, "sort_index", index);
    end(trace);
}

static void group_header(trace_t *trace, int group, const char *name)
{
    label(trace, "process_name", group, 0, name);
    order(trace, "process_sort_index", group, 0, group);
}

void trace_open(trace_t *trace, FILE *out)
{
    memset(trace, 0, sizeof *trace);
    json_begin(&trace->json, out);
    json_text(&trace->json, "displayTimeUnit", "ms");
    json_array(&trace->json, "traceEvents");
    group_header(trace, PROCESSOR, "Processor");
    group_header(trace, JOBS, "Jobs");
    group_header(trace, GATES, "Gates");
    group_header(trace, WIRES, "Wires");
    label(trace, "thread_name", PROCESSOR, 1, "runs");
    label(trace, "thread_name", WIRES, FRAMES, "frames from the scanner");
    label(trace, "thread_name", WIRES, COMPARES, "compare value");
    label(trace, "thread_name", WIRES, PULSES, "throttle pulse");
}

void trace_close(trace_t *trace)
{
    json_close(&trace->json);
    json_end(&trace->json);
}

/* ---- tracks ---- */

static int track_of(const kernel_job_t *id)
{
    return (int)id->kind * TRACKS_PER_KIND + id->number;
}

static int place_of(const kernel_job_t *id)
{
    return (int)id->kind * TRACKS_PER_KIND + (id->kind == KERNEL_HWI ? id->number : -id->priority);
}

static trace_job_t *new_job(trace_t *trace, const kernel_job_t *id)
{
    static const char *const kinds[] = {"Hwi", "Swi", "Task"};
    char name[80];

    if (trace->jobs == TRACE_JOBS_MAX) {
        (void)fprintf(stderr, "trace: too many jobs\n");
        abort();
    }
    trace_job_t *job = &trace->job[trace->jobs++];

    *job = (trace_job_t){.id = *id, .blocked_at = NOT_BLOCKED};
    (void)snprintf(name, sizeof name, "%s %d %s", kinds[id->kind], id->priority, id->name);
    label(trace, "thread_name", JOBS, track_of(id), name);
    order(trace, "thread_sort_index", JOBS, track_of(id), place_of(id));
    return job;
}

static trace_job_t *job_of(trace_t *trace, const kernel_job_t *id)
{
    for (int i = 0; i < trace->jobs; i++) {
        if (trace->job[i].id.kind == id->kind && trace->job[i].id.number == id->number) {
            return &trace->job[i];
        }
    }
    return new_job(trace, id);
}

static const char *gate_name(int number)
{
    const char *name = kernel_gate_name(number);

    return name[0] != '\0' ? name : "gate without a name";
}

static trace_gate_t *gate_of(trace_t *trace, int number)
{
    if (number >= TRACE_GATES_MAX) {
        (void)fprintf(stderr, "trace: too many gates\n");
        abort();
    }
    for (; trace->gates <= number; trace->gates++) {
        trace->gate[trace->gates].owner = FREE;
        label(trace, "thread_name", GATES, trace->gates + 1, gate_name(trace->gates));
    }
    return &trace->gate[number];
}

/* ---- the schedule ---- */

static void stop(trace_t *trace, const trace_job_t *job, sim_time_t when)
{
    span(trace, PROCESSOR, 1, job->id.name, trace->running_since, when);
    json_whole(&trace->json, "priority", job->id.priority);
    end(trace);
    span(trace, JOBS, track_of(&job->id), "runs", trace->running_since, when);
    end(trace);
}

static void finish(trace_t *trace, trace_job_t *job, const kernel_job_t *id, sim_time_t when)
{
    sim_time_t begun = id->released > job->finished ? id->released : job->finished;

    stop(trace, job, when);
    span(trace, JOBS, track_of(id), id->name, begun, when);
    time_field(trace, "response_us", when - id->released);
    json_whole(&trace->json, "priority", id->priority);
    end(trace);
    job->finished = when;
}

static void enter(trace_t *trace, trace_job_t *job, int number, sim_time_t when)
{
    char name[80];

    if (job->blocked_at != NOT_BLOCKED) {
        (void)snprintf(name, sizeof name, "waits for %s", gate_name(number));
        span(trace, JOBS, track_of(&job->id), name, job->blocked_at, when);
        end(trace);
        job->blocked_at = NOT_BLOCKED;
    }
    *gate_of(trace, number) = (trace_gate_t){.entered = when, .owner = job->id.number};
}

static void leave(trace_t *trace, const trace_job_t *job, int number, sim_time_t when)
{
    trace_gate_t *gate = gate_of(trace, number);

    span(trace, GATES, number + 1, job->id.name, gate->entered, when);
    json_whole(&trace->json, "inherited_priority", gate->inherited);
    end(trace);
    gate->owner = FREE;
}

static void change_priority(trace_t *trace, const kernel_job_t *id, int priority, sim_time_t when)
{
    char name[40];

    (void)snprintf(name, sizeof name, "priority %d", priority);
    instant(trace, JOBS, track_of(id), name, when);
    end(trace);
    for (int i = 0; i < trace->gates; i++) {
        trace_gate_t *gate = &trace->gate[i];

        if (gate->owner == id->number && priority > id->priority && priority > gate->inherited) {
            gate->inherited = priority;
        }
    }
}

void trace_observe(void *context, sim_time_t when, kernel_event_t event_kind, const kernel_job_t *id,
                   int detail)
{
    trace_t *trace = context;
    trace_job_t *job = job_of(trace, id);

    switch (event_kind) {
    case KERNEL_RELEASED:
        break;
    case KERNEL_DISPATCHED:
        trace->running_since = when;
        break;
    case KERNEL_PREEMPTED:
        stop(trace, job, when);
        break;
    case KERNEL_FINISHED:
        finish(trace, job, id, when);
        break;
    case KERNEL_GATE_BLOCKED:
        stop(trace, job, when);
        job->blocked_at = when;
        break;
    case KERNEL_GATE_ENTERED:
        enter(trace, job, detail, when);
        break;
    case KERNEL_GATE_LEFT:
        leave(trace, job, detail, when);
        break;
    case KERNEL_PRIORITY:
        change_priority(trace, id, detail, when);
        break;
    }
}

/* ---- the wires ---- */

void trace_laser_octet(trace_t *trace, unsigned octet, double bit_ns)
{
    if (trace->frame_octets == 0) {
        trace->frame_begin = timeline_now() - (sim_time_t)(BITS_PER_OCTET * bit_ns);
    }
    trace->frame_octets++;
    if (octet == '\n' && trace->previous_octet == '\n') {
        span(trace, WIRES, FRAMES, "frame", trace->frame_begin, timeline_now());
        json_whole(&trace->json, "octets", trace->frame_octets);
        end(trace);
        trace->frame_octets = 0;
    }
    trace->previous_octet = octet;
}

void trace_pulse(trace_t *trace, sim_time_t high_ns)
{
    char name[40];

    (void)snprintf(name, sizeof name, "%.1f us", (double)high_ns / 1e3);
    span(trace, WIRES, PULSES, name, timeline_now() - high_ns, timeline_now());
    json_flag(&trace->json, "changed", high_ns != trace->pulse);
    end(trace);
    trace->pulse = high_ns;
}

void trace_answer(trace_t *trace, sim_time_t scan_end, unsigned compare)
{
    char name[40];

    (void)snprintf(name, sizeof name, "compare %u", compare);
    instant(trace, WIRES, COMPARES, name, timeline_now());
    time_field(trace, "after_scan_us", timeline_now() - scan_end);
    end(trace);
}
