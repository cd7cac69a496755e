/* Scheduler of the simulated SYS/BIOS: one loop over virtual time. Each turn runs the timeline's due
 * events, chooses the job with the highest priority, lets its cost elapse (other jobs can preempt it
 * meanwhile), and then runs its code in no virtual time. Tasks and Swis run on fibers; Hwis run on the
 * loop's own stack. The rules are those of SYS/BIOS on a C28x; kernel.h states them.
 * What breaks: every simulated flight and every response time depends on the order of these steps. An event
 * that is due now must run before a job is chosen. A preempted job must keep its remaining cost. Only
 * the kernel's calls may give up the processor: otherwise a task could be interrupted at an instant that is
 * not repeatable. */
#include "sim/ti/sysbios/kernel.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ti/sysbios/BIOS.h>
#include <xdc/runtime/System.h>

#include "sim/ti/sysbios/core.h"

static fiber_t main_fiber;
static int (*main_entry)(void);
static kernel_costs_t costs;
static bool started;
static bool halted;
static char halt_reason[200];
static sim_time_t run_end;
static job_t *holder;                   /* has the processor */
static job_t *hwis_in_hand[HWI_GROUPS]; /* each has interrupted the one before it */
static int hwi_depth;
static job_t *resumed; /* thread whose code runs */

static void (*fault_hook)(void);
static kernel_hooks_t hooks;
static void (*pacer)(sim_time_t next);
static kernel_observer_t observer;
static void *observer_context;

/* ---- context ---- */

job_t *kernel_thread(void)
{
    return resumed;
}

context_t kernel_context(void)
{
    if (resumed != NULL) {
        return resumed->id.kind == KERNEL_TASK ? CONTEXT_TASK : CONTEXT_SWI;
    }
    return fiber_inside() ? CONTEXT_MAIN : CONTEXT_HWI;
}

bool kernel_started(void)
{
    return started;
}

const char *kernel_name(const xdc_runtime_IInstance_Params *instance)
{
    return instance != NULL && instance->name != NULL ? instance->name : "";
}

/* ---- costs ---- */

const kernel_costs_t *kernel_costs(void)
{
    return &costs;
}

sim_time_t kernel_cost_of_name(const char *name)
{
    for (int i = 0; i < costs.job_count; i++) {
        if (costs.jobs[i].interrupt < 0 && strcmp(costs.jobs[i].name, name) == 0) {
            return costs.jobs[i].job;
        }
    }
    return 0;
}

const kernel_cost_t *kernel_cost_of_interrupt(int number)
{
    for (int i = 0; i < costs.job_count; i++) {
        if (costs.jobs[i].interrupt == number) {
            return &costs.jobs[i];
        }
    }
    return NULL;
}

/* ---- the end ---- */

void kernel_set_fault_hook(void (*hook)(void))
{
    fault_hook = hook;
}

static void no_hwi_hook(Hwi_Handle hwi)
{
    (void)hwi;
}

static void no_swi_hook(Swi_Handle swi)
{
    (void)swi;
}

static void no_task_hook(Task_Handle before, Task_Handle now)
{
    (void)before;
    (void)now;
}

void kernel_set_hooks(const kernel_hooks_t *wanted)
{
    hooks = wanted != NULL ? *wanted : (kernel_hooks_t){.hwi_begin = NULL};
}

const kernel_hooks_t *kernel_hooks(void)
{
    hooks.hwi_begin = hooks.hwi_begin != NULL ? hooks.hwi_begin : no_hwi_hook;
    hooks.hwi_end = hooks.hwi_end != NULL ? hooks.hwi_end : no_hwi_hook;
    hooks.swi_begin = hooks.swi_begin != NULL ? hooks.swi_begin : no_swi_hook;
    hooks.swi_end = hooks.swi_end != NULL ? hooks.swi_end : no_swi_hook;
    hooks.task_switch = hooks.task_switch != NULL ? hooks.task_switch : no_task_hook;
    return &hooks;
}

static void first_halt(const char *format, va_list arguments)
{
    (void)vsnprintf(halt_reason, sizeof halt_reason, format, arguments);
    halted = true;
    holder = NULL;
    if (fault_hook != NULL) {
        fault_hook();
    }
}

void kernel_halt(const char *format, ...)
{
    if (!halted) {
        va_list arguments;

        va_start(arguments, format);
        first_halt(format, arguments);
        va_end(arguments);
    }
    if (fiber_inside()) {
        fiber_leave();
    }
    if (fiber_guarded()) {
        fiber_escape();
    }
    (void)fprintf(stderr, "kernel: called from outside: %s\n", halt_reason);
    abort();
}

void kernel_require(bool condition, const char *message)
{
    if (!condition) {
        kernel_halt("%s", message);
    }
}

void *kernel_create_failed(Error_Block *eb, const char *message)
{
    if (eb == NULL) {
        kernel_halt("%s", message);
    }
    eb->msg = message;
    return NULL;
}

void kernel_require_create_context(const char *function)
{
    if (kernel_context() == CONTEXT_HWI || kernel_context() == CONTEXT_SWI) {
        kernel_halt("%s: not from a Hwi or Swi", function);
    }
}

const char *kernel_halt_reason(void)
{
    return halted ? halt_reason : NULL;
}

/* ---- observation ---- */

void kernel_observe(kernel_observer_t new_observer, void *context)
{
    observer = new_observer;
    observer_context = context;
}

void kernel_observed(kernel_event_t event, const job_t *job, int detail)
{
    if (observer != NULL && !halted) {
        observer(observer_context, timeline_now(), event, &job->id, detail);
    }
}

void kernel_set_pacer(void (*new_pacer)(sim_time_t next))
{
    pacer = new_pacer;
}

/* ---- who runs ---- */

static job_t *first_thread(void)
{
    job_t *job = swi_lock_holder();

    if (job == NULL) {
        job = swi_first();
    }
    return job != NULL ? job : task_first();
}

static bool interrupt_goes_before(const job_t *thread)
{
    return hwi_waiting() && (thread == NULL || !thread->interrupts_off);
}

static job_t *first_job(void)
{
    if (!started || halted) {
        return NULL;
    }
    if (hwi_depth == 0) {
        job_t *thread = first_thread();

        if (!interrupt_goes_before(thread)) {
            return thread;
        }
    }
    /* TI's dispatcher masks a Hwi's own PIE group alone while its function runs: any other interrupts it. */
    while (hwi_waiting()) {
        hwis_in_hand[hwi_depth++] = hwi_take();
    }
    return hwis_in_hand[hwi_depth - 1];
}

static void hand_over(job_t *job)
{
    if (job == holder && job != NULL) {
        return;
    }
    if (holder != NULL) {
        kernel_observed(KERNEL_PREEMPTED, holder, holder->rank);
    }
    holder = job;
    if (job != NULL) {
        if (job->id.kind == KERNEL_SWI) {
            swi_begin(job);
        }
        kernel_observed(KERNEL_DISPATCHED, job, job->rank);
    }
    if (!halted && started && (job == NULL || job->id.kind == KERNEL_TASK)) {
        task_switch(job);
    }
}

void kernel_yield_processor(kernel_event_t event, const job_t *job, int detail)
{
    holder = NULL;
    kernel_observed(event, job, detail);
}

void kernel_reschedule(void)
{
    job_t *self = resumed;

    if (self == NULL || halted || !fiber_inside()) {
        return;
    }
    if (self->remaining > 0 || holder != self || first_thread() != self || interrupt_goes_before(self)) {
        fiber_pause();
    }
}

void kernel_consume(sim_time_t cost)
{
    resumed->remaining += cost;
    kernel_reschedule();
}

/* ---- the scheduler ---- */

static void execute(job_t *job)
{
    switch (job->id.kind) {
    case KERNEL_HWI:
        hwi_run(job);
        hwi_depth--;
        kernel_yield_processor(KERNEL_FINISHED, job, job->rank);
        break;
    case KERNEL_SWI:
        resumed = job;
        swi_run(job);
        break;
    case KERNEL_TASK:
        resumed = job;
        fiber_resume(&job->fiber);
        resumed = NULL;
        if (!halted) { /* an interrupt that waits comes after the switch, as on the chip */
            task_switch(task_first());
        }
        break;
    }
    resumed = NULL;
}

static sim_time_t earlier(sim_time_t a, sim_time_t b)
{
    return a < b ? a : b;
}

static void let_time_pass(job_t *job)
{
    sim_time_t now = timeline_now();
    sim_time_t next = earlier(run_end, timeline_next());

    if (job != NULL) {
        next = earlier(next, now + job->remaining);
    }
    if (pacer != NULL) {
        pacer(next);
        if (timeline_next() < next) {
            return;
        }
    }
    timeline_move_to(next);
    if (job != NULL) {
        job->remaining -= next - now;
    } else {
        load_idle(now, next);
    }
}

static void run(void)
{
    for (;;) {
        timeline_run_due();
        job_t *job = first_job();

        hand_over(job);
        if (job != NULL && job->remaining == 0) {
            execute(job);
        } else if (timeline_now() < run_end) {
            let_time_pass(job);
        } else {
            return;
        }
    }
}

bool kernel_run_until(sim_time_t until)
{
    run_end = until;
    fiber_guard(run); /* kernel_halt() begins it anew from a Hwi: the world goes on */
    return !halted;
}

/* ---- begin and end ---- */

static void run_main(void *unused)
{
    (void)unused;
    int status = main_entry();

    kernel_halt("main() returned %d without BIOS_start()", status);
}

void kernel_boot(int (*entry)(void), const kernel_costs_t *new_costs)
{
    if (fiber_inside()) {
        (void)fprintf(stderr, "kernel: kernel_boot() from inside the firmware\n");
        abort();
    }
    costs = new_costs != NULL ? *new_costs : (kernel_costs_t){.jobs = NULL};
    started = false;
    halted = false;
    holder = NULL;
    hwi_depth = 0;
    hwi_module_reset();
    swi_module_reset();
    task_module_reset();
    semaphore_module_reset();
    event_module_reset();
    gate_module_reset();
    clock_module_reset();
    load_module_reset();
    main_entry = entry;
    fiber_free(&main_fiber);
    if (!fiber_create(&main_fiber, run_main, NULL)) {
        (void)fprintf(stderr, "kernel: no memory for main()\n");
        abort();
    }
    fiber_resume(&main_fiber);
}

Void BIOS_start(Void)
{
    kernel_require(kernel_context() == CONTEXT_MAIN, "BIOS_start: only from main()");
    started = true;
    clock_module_start();
    fiber_leave();
}

/* ---- xdc.runtime ---- */

Void Error_init(Error_Block *eb)
{
    eb->msg = NULL;
}

Bool Error_check(Error_Block *eb)
{
    return eb->msg != NULL;
}

Void System_abort(CString str)
{
    kernel_halt("System_abort: %s", str);
}

Void System_exit(Int stat)
{
    kernel_halt("System_exit: %d", stat);
}

Int System_printf(CString fmt, ...)
{
    va_list arguments;

    va_start(arguments, fmt);
    int length = vfprintf(stderr, fmt, arguments);

    va_end(arguments);
    return length;
}

Void System_flush(Void)
{
    (void)fflush(stderr);
}
