#include <string.h>

#include <ti/sysbios/BIOS.h>

#include "sim/ti/sysbios/core.h"

#define TASKS 32

static struct Task_Object tasks[TASKS];
static int task_count;
static link_t ready[PRIORITIES];
static unsigned ready_set; /* bit p: some task of priority p */
static job_t *lock_holder;
static struct Task_Object idle; /* SYS/BIOS's idle task: it has nothing to do here */
static Task_Handle switched_to; /* has the processor, or will have it again; NULL before the first */

void task_module_reset(void)
{
    for (int i = 0; i < task_count; i++) {
        fiber_free(&tasks[i].job.fiber);
    }
    memset(tasks, 0, sizeof tasks);
    for (int i = 0; i < PRIORITIES; i++) {
        link_init(&ready[i]);
    }
    task_count = 0;
    ready_set = 0;
    lock_holder = NULL;
    switched_to = NULL;
    link_init(&idle.ready);
}

static link_t *first_ready(void)
{
    return ready_set == 0 ? NULL : ready[31 - __builtin_clz(ready_set)].next;
}

job_t *task_first(void)
{
    if (lock_holder != NULL) {
        return lock_holder;
    }
    link_t *first = first_ready();

    return first == NULL ? NULL : &LINK_OWNER(first, struct Task_Object, ready)->job;
}

void task_switch(job_t *job)
{
    Task_Handle before = switched_to;
    Task_Handle now = job == NULL ? &idle : LINK_OWNER(job, struct Task_Object, job);

    if (now != before) {
        switched_to = now;
        kernel_hooks()->task_switch(before, now);
    }
}

Task_Mode Task_getMode(Task_Handle handle)
{
    if (handle == task_self()) {
        return Task_Mode_RUNNING;
    }
    if (handle->ended) {
        return Task_Mode_TERMINATED;
    }
    return handle == &idle || !link_alone(&handle->ready) ? Task_Mode_READY : Task_Mode_BLOCKED;
}

Task_Handle task_self(void)
{
    job_t *job = kernel_thread();

    return job != NULL && job->id.kind == KERNEL_TASK ? LINK_OWNER(job, struct Task_Object, job) : NULL;
}

/* ---- ready or not ---- */

void task_unblock(Task_Handle task)
{
    link_before(&ready[task->job.rank], &task->ready);
    ready_set |= 1u << task->job.rank;
}

void task_block(Task_Handle task)
{
    link_remove(&task->ready);
    if (link_alone(&ready[task->job.rank])) {
        ready_set &= ~(1u << task->job.rank);
    }
}

void task_queue_by_priority(link_t *queue, Task_Handle task)
{
    link_t *place = queue->next;

    while (place != queue && LINK_OWNER(place, struct Task_Object, wait)->job.rank >= task->job.rank) {
        place = place->next;
    }
    link_before(place, &task->wait);
}

/* ---- priority ---- */

static void set_rank(Task_Handle task, int rank)
{
    if (link_alone(&task->ready)) {
        task->job.rank = rank;
    } else {
        task_block(task);
        task->job.rank = rank;
        task_unblock(task);
        if (task == task_self()) { /* it goes before its equals */
            link_remove(&task->ready);
            link_before(ready[rank].next, &task->ready);
        }
    }
    kernel_observed(KERNEL_PRIORITY, &task->job, rank);
}

void task_inherit(Task_Handle task)
{
    while (task != NULL) {
        Int waiting = gate_highest_waiting(&task->held);
        int rank = waiting > task->job.id.priority ? waiting : task->job.id.priority;

        if (rank == task->job.rank) {
            return;
        }
        set_rank(task, rank);
        task = task->blocked_on != NULL ? gate_requeue(task->blocked_on, task) : NULL;
    }
}

void task_donate(Task_Handle owner, int rank)
{
    while (owner != NULL && rank > owner->job.rank) {
        set_rank(owner, rank);
        owner = owner->blocked_on != NULL ? gate_requeue(owner->blocked_on, owner) : NULL;
    }
}

void task_give_back(Task_Handle task, int rank)
{
    if (rank < task->job.rank) {
        set_rank(task, rank);
    }
}

Int Task_setPri(Task_Handle handle, Int newpri)
{
    Int old = handle->job.id.priority;

    kernel_require(newpri >= 1 && newpri < PRIORITIES, "Task_setPri: priority out of range");
    handle->job.id.priority = newpri;
    task_inherit(handle);
    kernel_reschedule();
    return old;
}

/* ---- waiting ---- */

void task_require_timeout(const char *function, UInt32 timeout)
{
    context_t context = kernel_context();

    if (timeout >= TIMEOUT_LIMIT && timeout != BIOS_WAIT_FOREVER) {
        kernel_halt("%s: timeout of %lu ticks: 65535 and more have another meaning in 16 bits", function,
                    (unsigned long)timeout);
    }
    if (timeout != BIOS_NO_WAIT && context != CONTEXT_TASK && context != CONTEXT_MAIN) {
        kernel_halt("%s: with a timeout only from a Task", function);
    }
}

void task_require_wait(const char *function)
{
    if (kernel_context() != CONTEXT_TASK) {
        kernel_halt("%s: waits outside a Task", function);
    }
    if (lock_holder != NULL || swi_lock_holder() != NULL) {
        kernel_halt("%s: waits with the scheduler disabled", function);
    }
}

static void release(Task_Handle task, sim_time_t since)
{
    task->job.remaining = task->job.cost;
    task->job.id.released = since;
    kernel_observed(KERNEL_RELEASED, &task->job, task->job.rank);
}

UInt task_wait(UInt32 timeout)
{
    Task_Handle self = task_self();

    task_block(self);
    if (timeout != BIOS_WAIT_FOREVER) {
        clock_arm(&self->timeout, timeout);
    }
    kernel_yield_processor(KERNEL_FINISHED, &self->job, self->job.rank);
    fiber_pause();
    link_remove(&self->timeout.link);
    return self->outcome;
}

void task_wake(Task_Handle task, UInt outcome)
{
    task->outcome = outcome;
    task->timeout.active = false;
    link_remove(&task->wait);
    task_unblock(task);
    release(task, timeline_now());
    kernel_reschedule();
}

void task_no_wait(sim_time_t since)
{
    Task_Handle self = task_self();

    kernel_yield_processor(KERNEL_FINISHED, &self->job, self->job.rank);
    release(self, since < self->job.id.released ? timeline_now() : since);
    kernel_reschedule();
}

static Void timed_out(UArg task)
{
    task_wake((Task_Handle)task, 0);
}

/* ---- life ---- */

static void thread(void *argument)
{
    Task_Handle task = argument;

    task->function(task->arguments[0], task->arguments[1]);
    if (lock_holder != NULL || swi_lock_holder() != NULL) {
        kernel_halt("Task \"%s\" ended with the scheduler disabled", task->job.id.name);
    }
    task_block(task);
    task->ended = true;
    kernel_yield_processor(KERNEL_FINISHED, &task->job, task->job.rank);
    fiber_leave();
}

Task_Handle Task_create(Task_FuncPtr fxn, const Task_Params *params, Error_Block *eb)
{
    Task_Params defaults;

    kernel_require_create_context("Task_create");
    if (params == NULL) {
        Task_Params_init(&defaults);
        params = &defaults;
    }
    kernel_require(params->priority >= 1 && params->priority < PRIORITIES,
                   "Task_create: priority out of range");
    Task_Handle task = &tasks[task_count];

    if (task_count == TASKS || !fiber_create(&task->job.fiber, thread, task)) {
        return kernel_create_failed(eb, "Task_create: no memory");
    }
    task->job.id = (kernel_job_t){KERNEL_TASK, kernel_name(params->instance), task_count++, params->priority,
                                  timeline_now()};
    task->job.rank = params->priority;
    task->job.cost = kernel_cost_of_name(task->job.id.name) + kernel_costs()->switches;
    task->function = fxn;
    task->arguments[0] = params->arg0;
    task->arguments[1] = params->arg1;
    link_init(&task->wait);
    link_init(&task->held);
    clock_init(&task->timeout, timed_out, (UArg)task);
    task_unblock(task);
    kernel_observed(KERNEL_RELEASED, &task->job, task->job.rank);
    kernel_reschedule();
    return task;
}

Void Task_sleep(UInt32 nticks)
{
    if (nticks == BIOS_NO_WAIT) {
        return;
    }
    task_require_timeout("Task_sleep", nticks);
    kernel_require(nticks != BIOS_WAIT_FOREVER, "Task_sleep: forever");
    task_require_wait("Task_sleep");
    (void)task_wait(nticks);
}

Void Task_yield(Void)
{
    link_t *first = first_ready();

    if (first != NULL && kernel_started()) {
        link_t *list = &ready[LINK_OWNER(first, struct Task_Object, ready)->job.rank];

        link_remove(first);
        link_before(list, first);
        kernel_reschedule();
    }
}

Void Task_stat(Task_Handle handle, Task_Stat *statbuf)
{
    statbuf->priority = handle->job.rank;
    statbuf->stackSize = FIBER_STACK;
    statbuf->used = fiber_stack_used(&handle->job.fiber);
}

UInt Task_disable(Void)
{
    Task_Handle self = task_self();

    if (self == NULL || lock_holder != NULL) {
        return 1;
    }
    lock_holder = &self->job;
    return 0;
}

Void Task_restore(UInt key)
{
    if (key == 0 && task_self() != NULL) {
        lock_holder = NULL;
        kernel_reschedule();
    }
}
