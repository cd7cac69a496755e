#define _GNU_SOURCE
#include "sim/host/pace.h"

#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define RUN_MAX (50 * SIM_MS)

typedef struct {
    port_t *port;
    pace_take_t take;
    void *context;
} watched_t;

/* Input on its way through the timeline. */
typedef struct {
    const watched_t *from;
    size_t count;
    unsigned char octets[4096];
} input_t;

static watched_t ports[PACE_PORTS];
static struct pollfd polled[PACE_PORTS]; /* fd -1: lost */
static nfds_t port_count;
static struct timespec wall_start;
static sim_time_t virtual_start;
static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

static void on_signals(void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler};

    sigaction(SIGHUP, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* Ahead of the PC's other programs, where its user may ask for that; else as fast as they let us. */
static void ask_for_priority(int policy, int priority)
{
    const struct sched_param wanted = {.sched_priority = priority};

    (void)sched_setscheduler(0, policy, &wanted);
}

void pace_begin(void)
{
    ask_for_priority(SCHED_RR, 1);
    port_count = 0;
    virtual_start = timeline_now();
    clock_gettime(CLOCK_MONOTONIC, &wall_start);
    on_signals(interrupt);
}

void pace_end(void)
{
    ask_for_priority(SCHED_OTHER, 0);
    on_signals(SIG_DFL);
    interrupted = 0;
}

bool pace_interrupted(void)
{
    return interrupted != 0;
}

void pace_watch(port_t *port, pace_take_t take, void *context)
{
    if (port_count == PACE_PORTS) {
        abort();
    }
    ports[port_count] = (watched_t){port, take, context};
    polled[port_count] = (struct pollfd){.fd = port->fd, .events = POLLIN};
    port_count++;
}

void pace_forget(const port_t *port)
{
    for (nfds_t i = 0; i < port_count; i++) {
        if (ports[i].port == port) {
            polled[i].fd = -1;
        }
    }
}

bool pace_lost(const port_t *port)
{
    for (nfds_t i = 0; i < port_count; i++) {
        if (ports[i].port == port) {
            return polled[i].fd < 0;
        }
    }
    return false;
}

static sim_time_t wall_now(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return virtual_start + (sim_time_t)(now.tv_sec - wall_start.tv_sec) * SIM_S +
           (sim_time_t)(now.tv_nsec - wall_start.tv_nsec);
}

sim_time_t pace_lag(void)
{
    const sim_time_t lag = wall_now() - timeline_now();

    return lag > 0 ? lag : 0;
}

static void input_event(void *context)
{
    input_t *input = context;

    input->from->take(input->from->context, input->octets, input->count);
    free(input);
}

static void read_port(nfds_t index, sim_time_t next)
{
    input_t *input = malloc(sizeof *input);
    sim_time_t when = wall_now();
    bool lost;

    if (input == NULL) {
        abort();
    }
    input->from = &ports[index];
    input->count = port_read(ports[index].port, input->octets, sizeof input->octets, &lost);
    if (lost) {
        fprintf(stderr, "%s: the port is gone\n", ports[index].port->name);
        polled[index].fd = -1;
    }
    if (input->count == 0) {
        free(input);
        return;
    }
    when = when < timeline_now() ? timeline_now() : when;
    timeline_at(when > next ? next : when, input_event, input);
}

void pace_wait(sim_time_t next)
{
    sim_time_t ahead = next - wall_now();
    struct timespec patience = {0, 0};

    if (ahead > 0) {
        patience.tv_sec = (time_t)(ahead / SIM_S);
        patience.tv_nsec = (long)(ahead % SIM_S);
    }
    if (ppoll(polled, port_count, &patience, NULL) <= 0) {
        return;
    }
    for (nfds_t i = 0; i < port_count; i++) {
        if (polled[i].revents != 0) {
            read_port(i, next);
        }
    }
}

void pace_run(void)
{
    sim_time_t end = timeline_now() + RUN_MAX;
    sim_time_t next = timeline_next() < end ? timeline_next() : end;

    pace_wait(next);
    timeline_move_to(timeline_next() < next ? timeline_next() : next);
    timeline_run_due();
}
