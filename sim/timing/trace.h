/* Writes the schedule as Chrome trace JSON, which Perfetto and chrome://tracing open.
 *
 * Four groups of tracks. "Processor": who has it. "Jobs", a track per Hwi, Swi and task: each job from
 * release to finish, in it the stretches for which it ran and those for which it waited at a gate; changes of
 * a task's priority as instants. "Gates": who held each. "Wires": frames from the scanner, instants of the
 * compare value, throttle pulses. */
#ifndef SIM_TIMING_TRACE_H
#define SIM_TIMING_TRACE_H

#include <stdio.h>

#include "sim/json.h"
#include "sim/ti/sysbios/kernel.h"

#define TRACE_JOBS_MAX 64
#define TRACE_GATES_MAX 32

typedef struct {
    kernel_job_t id;
    sim_time_t begun; /* of the job's span: its release, or the end of the job before it */
    sim_time_t blocked_at;
    sim_time_t finished; /* the job before */
} trace_job_t;

typedef struct {
    sim_time_t entered;
    int inherited; /* highest priority that the owner got while inside; 0: none */
    int owner;     /* number of the task; -1: free */
} trace_gate_t;

typedef struct {
    json_t json;
    trace_job_t job[TRACE_JOBS_MAX];
    int jobs;
    trace_gate_t gate[TRACE_GATES_MAX];
    int gates;
    sim_time_t running_since;
    sim_time_t frame_begin;
    int frame_octets;
    unsigned previous_octet;
    sim_time_t pulse; /* the latest, its length */
} trace_t;

/* `out` must be open until trace_close(), which does not close it. */
void trace_open(trace_t *trace, FILE *out);
void trace_close(trace_t *trace);

/* A kernel_observer_t; context is the trace_t. From kernel_boot() on, one boot. */
void trace_observe(void *trace, sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail);

/* All at the present virtual time. An octet's stop bit ends; a pulse ends; an altitude is answered by a
 * compare value. */
void trace_laser_octet(trace_t *trace, unsigned octet, double bit_ns);
void trace_pulse(trace_t *trace, sim_time_t high_ns);
void trace_answer(trace_t *trace, sim_time_t scan_end, unsigned compare);

#endif
