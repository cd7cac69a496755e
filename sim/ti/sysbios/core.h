/* What the files of the kernel share; nobody else includes this.
 *
 * A job is what competes for the processor: a Hwi, a Swi or a Task. Hwi functions run on the scheduler's
 * stack; Swis and Tasks are threads, each on a fiber. Between two kernel calls a thread's code is one step
 * that takes no virtual time: an interrupt raised meanwhile is taken at the next kernel call that lets it in.
 */
#ifndef SIM_TI_SYSBIOS_CORE_H
#define SIM_TI_SYSBIOS_CORE_H

#include <stdbool.h>

#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>

#include "sim/ti/sysbios/fiber.h"
#include "sim/ti/sysbios/kernel.h"
#include "sim/ti/sysbios/link.h"

#define PRIORITIES 16
#define TICK_INTERRUPT 38
#define HWI_GROUPS 16 /* bits of the C28x's IER: 12 groups of the PIE, and 4 lines of the core */
#define TICK_PERIOD (1 * SIM_MS)
#define TIMEOUT_LIMIT 65535U /* BIOS_WAIT_FOREVER on a C28x */
#define WORD_MAX 65535U      /* UInt of a C28x */
#define INT_MAX_C28 32767

typedef struct {
    kernel_job_t id;
    int rank;             /* Hwi: its number; Swi, Task: its priority now */
    sim_time_t cost;      /* of every run */
    sim_time_t remaining; /* to be consumed before its code goes on */
    bool interrupts_off;  /* Hwi_disable() by this thread */
    fiber_t fiber;        /* threads only */
} job_t;

struct Clock_Object {
    link_t link; /* in the list of all, in the order that equal ticks are served */
    bool active;
    UInt32 due, timeout, period;
    Clock_FuncPtr function;
    UArg argument;
};

struct Task_Object {
    job_t job;
    Task_FuncPtr function;
    UArg arguments[2];
    bool ended;
    link_t ready;
    link_t wait; /* in the queue of a semaphore or gate */
    struct Clock_Object timeout;
    UInt outcome;                   /* of the wait */
    link_t held;                    /* gates */
    GateMutexPri_Handle blocked_on; /* NULL: on no gate */
};

/* kernel.c */

typedef enum { CONTEXT_MAIN, CONTEXT_HWI, CONTEXT_SWI, CONTEXT_TASK } context_t;
context_t kernel_context(void); /* CONTEXT_HWI also for the world outside the chip */
job_t *kernel_thread(void);     /* the calling thread; NULL in main() and in a Hwi */
bool kernel_started(void);
/* Lets in whatever goes before the calling thread, and consumes the thread's remaining cost. Threads only; no
 * effect in main() and in a Hwi. */
void kernel_reschedule(void);
/* Consumes `cost` before the calling thread goes on. */
void kernel_consume(sim_time_t cost);
/* Tells the observer. detail: the job's rank; for gate events the number of the gate in order of creation. */
void kernel_observed(kernel_event_t event, const job_t *job, int detail);
/* The same, and the job in hand gives up the processor: it is over or waits. */
void kernel_yield_processor(kernel_event_t event, const job_t *job, int detail);
const kernel_costs_t *kernel_costs(void);
const kernel_hooks_t *kernel_hooks(void); /* every one is there */
sim_time_t kernel_cost_of_name(const char *name);
const kernel_cost_t *kernel_cost_of_interrupt(int number); /* NULL: none */
void kernel_halt(const char *format, ...) __attribute__((noreturn, format(printf, 1, 2)));
/* Halts when the condition is false. */
void kernel_require(bool condition, const char *message);
/* A create that fails: NULL for the caller, or the end when it gave no Error_Block. */
void *kernel_create_failed(Error_Block *eb, const char *message);
/* Halts unless objects may be created here. */
void kernel_require_create_context(const char *function);
const char *kernel_name(const xdc_runtime_IInstance_Params *instance);

/* task.c */

void task_module_reset(void);
job_t *task_first(void);      /* the one that may run, NULL when none is ready */
void task_switch(job_t *job); /* it has the processor from now on, NULL: the idle task; tells the hook */
Task_Handle task_self(void);  /* the calling task, NULL elsewhere */
/* Halts unless the calling context may wait; `function` for the message. */
void task_require_timeout(const char *function, UInt32 timeout);
void task_require_wait(const char *function);
/* Takes the calling task off the processor, its job finished, until task_wake() or for `timeout` ticks.
 * Returns what task_wake() was given, 0 after the timeout. By then the cost of the next job is consumed. */
UInt task_wait(UInt32 timeout);
void task_wake(Task_Handle task, UInt outcome);
/* The wait that the task called for is over at once: the next job begins. `since`: when it was posted. */
void task_no_wait(sim_time_t since);
/* Off the ready list, and back on it. */
void task_block(Task_Handle task);
void task_unblock(Task_Handle task);
/* Queue of waiting tasks: at the end of its priority. */
void task_queue_by_priority(link_t *queue, Task_Handle task);
/* Computes priorities anew, along the chain of gates that the task waits for. */
void task_inherit(Task_Handle task);
/* The owner of a gate runs at least at the rank of who has begun to wait for it; so along the chain. */
void task_donate(Task_Handle owner, int rank);
/* Down to the rank that the task had when it entered the gate that it leaves. */
void task_give_back(Task_Handle task, int rank);

/* gate.c */

void gate_module_reset(void);
Int gate_highest_waiting(link_t *held); /* over all gates of the list, 0 when nobody waits */
Task_Handle gate_requeue(GateMutexPri_Handle gate, Task_Handle waiting); /* returns the owner */

/* swi.c */

void swi_module_reset(void);
job_t *swi_first(void);       /* begun or posted, highest first; the Swi lock aside */
job_t *swi_lock_holder(void); /* thread that called Swi_disable(), NULL */
void swi_begin(job_t *job);   /* it gets the processor */
void swi_run(job_t *job);     /* its cost is consumed */
Swi_Handle swi_create_internal(Swi_FuncPtr function, const char *name, bool (*needed)(void));

/* hwi.c */

void hwi_module_reset(void);
bool hwi_waiting(void); /* one that is enabled, and none of its group in hand */
job_t *hwi_take(void);  /* one must wait; it is in hand until hwi_run() returns */
void hwi_run(job_t *job);
void hwi_create_internal(Int number, Hwi_FuncPtr function, const char *name);

/* clock.c */

void clock_module_reset(void); /* after hwi and swi */
void clock_module_start(void);
void clock_arm(struct Clock_Object *object, UInt32 timeout); /* and append it to the list */
void clock_init(struct Clock_Object *object, Clock_FuncPtr function, UArg argument);

/* load.c */

void load_module_reset(void);
void load_idle(sim_time_t from, sim_time_t to); /* nobody had the processor; in order of time */

/* semaphore.c, event.c */

void semaphore_module_reset(void);
void event_module_reset(void);

#endif
