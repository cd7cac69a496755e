#include <string.h>

#include "sim/ti/sysbios/core.h"

#define GATES 32

enum { KEY_FIRST, KEY_NESTED };

struct GateMutexPri_Object {
    int number; /* in order of creation */
    const char *name;
    Task_Handle owner; /* NULL: free */
    int depth;         /* enters of the owner */
    int original;      /* the owner's rank when it entered */
    link_t held;       /* in the owner's list */
    link_t waiting;    /* tasks, highest priority first */
};

static struct GateMutexPri_Object gates[GATES];
static int gate_count;

void gate_module_reset(void)
{
    memset(gates, 0, sizeof gates);
    gate_count = 0;
}

const char *kernel_gate_name(int number)
{
    return gates[number].name;
}

static Task_Handle first_waiting(const struct GateMutexPri_Object *gate)
{
    return link_alone(&gate->waiting) ? NULL : LINK_OWNER(gate->waiting.next, struct Task_Object, wait);
}

Int gate_highest_waiting(link_t *held)
{
    Int highest = 0;

    for (link_t *element = held->next; element != held; element = element->next) {
        Task_Handle first = first_waiting(LINK_OWNER(element, struct GateMutexPri_Object, held));

        if (first != NULL && first->job.rank > highest) {
            highest = first->job.rank;
        }
    }
    return highest;
}

Task_Handle gate_requeue(GateMutexPri_Handle gate, Task_Handle waiting)
{
    link_remove(&waiting->wait);
    task_queue_by_priority(&gate->waiting, waiting);
    return gate->owner;
}

GateMutexPri_Handle GateMutexPri_create(const GateMutexPri_Params *params, Error_Block *eb)
{
    kernel_require_create_context("GateMutexPri_create");
    if (gate_count == GATES) {
        return kernel_create_failed(eb, "GateMutexPri_create: no memory");
    }
    struct GateMutexPri_Object *gate = &gates[gate_count];

    gate->number = gate_count++;
    gate->name = params != NULL ? kernel_name(params->instance) : "";
    link_init(&gate->held);
    link_init(&gate->waiting);
    return gate;
}

static void give(GateMutexPri_Handle gate, Task_Handle task)
{
    gate->owner = task;
    gate->depth = 1;
    gate->original = task->job.rank;
    link_before(&task->held, &gate->held);
    kernel_observed(KERNEL_GATE_ENTERED, &task->job, gate->number);
}

static void wait_for(GateMutexPri_Handle gate, Task_Handle self)
{
    task_require_wait("GateMutexPri_enter");
    task_block(self);
    self->blocked_on = gate;
    task_queue_by_priority(&gate->waiting, self);
    kernel_yield_processor(KERNEL_GATE_BLOCKED, &self->job, gate->number);
    task_donate(gate->owner, self->job.rank);
    fiber_pause();
}

static void hand_on(GateMutexPri_Handle gate)
{
    Task_Handle next = first_waiting(gate);

    if (next == NULL) {
        gate->owner = NULL;
        return;
    }
    link_remove(&next->wait);
    next->blocked_on = NULL;
    next->job.remaining = kernel_costs()->switches + kernel_costs()->gate_access;
    task_unblock(next);
    give(gate, next);
}

IArg GateMutexPri_enter(GateMutexPri_Handle handle)
{
    Task_Handle self = task_self();

    if (self == NULL) {
        kernel_require(kernel_context() == CONTEXT_MAIN, "GateMutexPri_enter: not from a Hwi or Swi");
        return KEY_NESTED;
    }
    if (handle->owner == self) {
        handle->depth++;
        kernel_consume(kernel_costs()->gate_access);
        return KEY_NESTED;
    }
    if (handle->owner == NULL) {
        give(handle, self);
        kernel_consume(kernel_costs()->gate_access);
    } else {
        wait_for(handle, self);
    }
    return KEY_FIRST;
}

Void GateMutexPri_leave(GateMutexPri_Handle handle, IArg key)
{
    Task_Handle self = task_self();

    if (self == NULL) {
        kernel_require(kernel_context() == CONTEXT_MAIN, "GateMutexPri_leave: not from a Hwi or Swi");
        return;
    }
    kernel_require(handle->owner == self, "GateMutexPri_leave: the caller does not hold the gate");
    kernel_require(key == (handle->depth > 1 ? KEY_NESTED : KEY_FIRST), "GateMutexPri_leave: out of order");
    handle->depth--;
    if (handle->depth == 0) {
        link_remove(&handle->held);
        kernel_observed(KERNEL_GATE_LEFT, &self->job, handle->number);
        /* As TI's gate does: what the owner has inherited through another gate that it holds meanwhile is
         * lost too. */
        task_give_back(self, handle->original);
        hand_on(handle);
        kernel_reschedule();
    }
}
