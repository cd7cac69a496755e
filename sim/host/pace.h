/* The wall clock as pacer of virtual time, and ports whose input arrives in it. One per process. */
#ifndef SIM_HOST_PACE_H
#define SIM_HOST_PACE_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/host/port.h"
#include "sim/timeline.h"

/* From now on virtual time goes with the wall clock, both being what they are now. SIGINT, SIGTERM and SIGHUP
 * are caught until pace_end(); one that has come is remembered until then, also over another pace_begin(). No
 * port is watched yet. Asks for real-time priority, and does without it where the user has no right to it. */
void pace_begin(void);
void pace_end(void);

/* True after one of them: come to an end. */
bool pace_interrupted(void);

/* Octets that come in at the port are given to `take` by an event of the timeline. At most PACE_PORTS ports.
 * A port that is lost is reported on stderr and no longer watched. */
#define PACE_PORTS 4
typedef void (*pace_take_t)(void *context, const unsigned char *octets, size_t count);
void pace_watch(port_t *port, pace_take_t take, void *context);

/* Watches it no longer. */
void pace_forget(const port_t *port);
/* True when a watched port was lost. */
bool pace_lost(const port_t *port);

/* Returns when the wall clock has reached `next`, when input has been posted (not later than `next`), or at a
 * signal. Shape of kernel_set_pacer(). */
void pace_wait(sim_time_t next);

/* How far virtual time is behind the wall clock: this PC had other things to do. */
sim_time_t pace_lag(void);

/* Without a kernel: runs the events that the wall clock reaches, for at most 50 ms. */
void pace_run(void);

#endif
