/* Watches the kernel run: response times, waits at gates, priority inversions and use of the processor, per
 * job, held against limits.
 *
 * A response goes from release to finish. A priority inversion is time for which a task is ready or waits at
 * a gate while a task of lower priority, inherited priority aside, has the processor; it is summed over one
 * job. Times in ns. */
#ifndef SIM_TIMING_TIMING_H
#define SIM_TIMING_TIMING_H

#include <stdio.h>

#include "sim/ti/sysbios/kernel.h"

#define TIMING_JOBS_MAX 64

#define TIMING_NAME_SIZE 32

/* Of the task, Swi or Hwi of that name. */
typedef struct {
    char name[TIMING_NAME_SIZE];
    sim_time_t response;  /* bound of the analysis; SIM_NEVER: none */
    sim_time_t deadline;  /* from the release; SIM_NEVER: none */
    sim_time_t inversion; /* of one job; SIM_NEVER: not limited */
    int blockings;        /* waits at gates of one job; -1: not limited */
} timing_limits_t;

typedef struct {
    kernel_job_t id; /* as it was at its last release */
    timing_limits_t limits;
    long jobs;       /* finished */
    long late;       /* past the deadline */
    sim_time_t used; /* of the processor */
    sim_time_t longest_response;
    sim_time_t longest_since; /* release of the job that took it */
    sim_time_t longest_wait;  /* at a gate, once, everything that came between included */
    sim_time_t longest_inversion;
    int most_blockings;
    bool pending, blocked; /* task: a job is released and not finished; and waits at a gate */
    sim_time_t released, blocked_at, inversion; /* of that job */
    int blockings;
} timing_job_t;

typedef struct {
    const timing_limits_t *limits;
    int limit_count;
    timing_job_t job[TIMING_JOBS_MAX]; /* in order of appearance */
    int jobs;
    timing_job_t *running;
    sim_time_t running_since;
    sim_time_t end;
} timing_t;

/* Reads lines name,response_ns,deadline_ns,inversion_ns,blockings, -1 for what is not limited, as
 * tools/rta/limits.py writes them. Returns their number, -1 when there is none, when a line is another, or
 * when there are more than TIMING_JOBS_MAX. */
int timing_read_limits(FILE *in, timing_limits_t limits[TIMING_JOBS_MAX]);

/* Of that name; where there is none, an entry without limits. */
const timing_limits_t *timing_limits_of(const timing_limits_t *limits, int limit_count, const char *name);

/* The run begins at virtual time 0. The limits are kept by reference. */
void timing_init(timing_t *timing, const timing_limits_t *limits, int limit_count);

/* A kernel_observer_t; context is the timing_t. From kernel_boot() on. */
void timing_observe(void *timing, sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail);

/* Ends the observation at the present virtual time: a job that is past its deadline and not finished is late.
 */
void timing_conclude(timing_t *timing);

/* NULL when no such job was seen. */
const timing_job_t *timing_find(const timing_t *timing, const char *name);

/* Table of all jobs, processor load, interrupts per second. After timing_conclude(). */
void timing_print(const timing_t *timing, FILE *out);

/* Prints a line for each limit that was broken and returns their number. */
int timing_print_broken(const timing_t *timing, FILE *out);

#endif
