/* What the PC board asks of the kernel that stands in for SYS/BIOS: start it, run it in virtual time, raise
 * interrupts, and say what each job costs. The firmware never includes this.
 *
 * One processor. Runnable, highest first: pending Hwi (lowest PIE number first; it interrupts a Hwi of
 * another PIE group, as TI's dispatcher lets it), posted Swi by priority, ready Task by priority, FIFO among
 * equals, idle. Every job has a cost that it consumes, preemptibly, before its code runs: a Hwi or Swi before
 * its function, a Task after the wait (pend, sleep) that released it returns; a gate entry consumes its cost
 * while the gate is held. Code itself takes no virtual time. A task's first run, up to its first wait, costs
 * its gate entries alone. */
#ifndef SIM_TI_SYSBIOS_KERNEL_H
#define SIM_TI_SYSBIOS_KERNEL_H

#include <stdbool.h>

#include "sim/timeline.h"

/* Costs in ns; names are those of Task_Params.instance->name and Swi_Params.instance->name, Hwi by interrupt
 * number. A job without an entry costs nothing. The tick is Hwi 38, the Clock Swi "Clock_swi". */
typedef struct {
    const char *name; /* task or Swi. Of a Hwi: what to call it when it has no name of its own, or NULL */
    int interrupt;    /* Hwi number; -1 otherwise */
    sim_time_t job;
} kernel_cost_t;

typedef struct {
    const kernel_cost_t *jobs;
    int job_count;
    sim_time_t gate_access; /* per GateMutexPri_enter, held; on top of the job's cost */
    sim_time_t switches;    /* two context switches: once per task job and once per blocking on a gate */
} kernel_costs_t;

/* Runs entry (the firmware's main) on its own stack until it calls BIOS_start(). Resets any earlier state but
 * observer, pacer and hooks. `costs` and what it points to must outlive the run; NULL = nothing costs
 * anything. */
void kernel_boot(int (*entry)(void), const kernel_costs_t *costs);

/* Runs tasks, Swis, Hwis and timeline events up to and including virtual time `until`. Returns false when the
 * system has halted (System_abort, System_exit, a broken rule): virtual time then still advances and devices
 * live on. */
bool kernel_run_until(sim_time_t until);

/* An interrupt line of the chip rises (latched until taken). Ignored, but remembered, while not enabled. */
void kernel_raise(int interrupt);

/* NULL while running; afterwards what stopped it. */
const char *kernel_halt_reason(void);

/* The application's hook on a halt (what Error.raiseHook and System.abortFxn are on the chip). Called once,
 * at the first halt, where it happened (main(), Hwi, Swi or Task); must return, and not wait. No job runs any
 * more. NULL = none. */
void kernel_set_fault_hook(void (*hook)(void));

/* The application's hooks, what addHookSet() in its configuration names. Called as on the chip: around the
 * function of a Hwi and of a Swi, and when another task gets the processor (the first time from NULL). They
 * must not wait. NULL = none. Any of them may be NULL. */
struct Hwi_Object;
struct Swi_Object;
struct Task_Object;
typedef struct {
    void (*hwi_begin)(struct Hwi_Object *hwi);
    void (*hwi_end)(struct Hwi_Object *hwi);
    void (*swi_begin)(struct Swi_Object *swi);
    void (*swi_end)(struct Swi_Object *swi);
    void (*task_switch)(struct Task_Object *before, struct Task_Object *now);
} kernel_hooks_t;
void kernel_set_hooks(const kernel_hooks_t *hooks);

/* Called before virtual time moves to `next`; may wait for the wall clock and may post timeline events
 * earlier than `next` (the kernel then looks again). NULL = as fast as possible. */
void kernel_set_pacer(void (*pacer)(sim_time_t next));

/* Observation, for traces and timing reports. Never called after a halt. */
typedef enum {
    KERNEL_RELEASED,   /* job became ready: task released from its wait, Swi posted, Hwi raised */
    KERNEL_DISPATCHED, /* gets the processor */
    KERNEL_PREEMPTED,  /* loses it before its job is done */
    KERNEL_FINISHED,   /* job done: task waits again or has ended, Swi or Hwi returned */
    KERNEL_GATE_BLOCKED,
    KERNEL_GATE_ENTERED,
    KERNEL_GATE_LEFT, /* outermost enter and leave alone */
    KERNEL_PRIORITY   /* task's priority changed: inherited, given back, set */
} kernel_event_t;

typedef enum { KERNEL_HWI, KERNEL_SWI, KERNEL_TASK } kernel_kind_t;

typedef struct {
    kernel_kind_t kind;
    const char *name; /* "" when it has none; the tick's Hwi is "Clock", the Clock Swi "Clock_swi" */
    int number;   /* with the kind: which one. Hwi: its interrupt; Swi, task: in order of creation, from 0 */
    int priority; /* Swi, task: without what is inherited; Hwi: its number, the lowest goes first */
    sim_time_t released; /* of the job in hand, from KERNEL_DISPATCHED to KERNEL_FINISHED; tasks: from
                            KERNEL_RELEASED */
} kernel_job_t;

/* A wait that returns at once begins a job that was released when it was posted: but not before the job of
 * the post ahead of it began; and now, when that was before the release of the job before (a flag that this
 * task had not waited for).
 *
 * detail of a gate event: the gate's number in order of creation, from 0; of the others: the priority in
 * force, inherited or not (Hwi: its number). */
typedef void (*kernel_observer_t)(void *context, sim_time_t when, kernel_event_t event,
                                  const kernel_job_t *job, int detail);
void kernel_observe(kernel_observer_t observer, void *context); /* NULL = none */

/* Its name, "" when it has none. */
const char *kernel_gate_name(int number);

#endif
