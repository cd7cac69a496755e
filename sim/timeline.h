/* Virtual time: one queue of things to happen, ordered by time, then by order of posting. Single thread, one
 * timeline per process. Nothing here is paced by the wall clock. */
#ifndef SIM_TIMELINE_H
#define SIM_TIMELINE_H

#include <stdbool.h>
#include <stdint.h>

typedef int64_t sim_time_t; /* nanoseconds since the board got power */

#define SIM_US ((sim_time_t)1000)
#define SIM_MS ((sim_time_t)1000000)
#define SIM_S ((sim_time_t)1000000000)
#define SIM_NEVER INT64_MAX

typedef void (*timeline_action_t)(void *context);
typedef uint64_t timeline_id_t; /* 0 is no event */

/* Empties the queue, time 0. */
void timeline_reset(void);
sim_time_t timeline_now(void);
/* when < now is an error of the caller and aborts. The action runs with timeline_now() == when. */
timeline_id_t timeline_at(sim_time_t when, timeline_action_t action, void *context);
timeline_id_t timeline_after(sim_time_t delay, timeline_action_t action, void *context);
/* True when the event was still waiting. */
bool timeline_cancel(timeline_id_t id);
/* Time of the earliest waiting event, SIM_NEVER when there is none. */
sim_time_t timeline_next(void);
/* Moves the clock to `when` (not beyond timeline_next()) without running anything. */
void timeline_move_to(sim_time_t when);
/* Runs every event that is due now, including those posted meanwhile for now. */
void timeline_run_due(void);

#endif
