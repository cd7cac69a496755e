#include <string.h>

#include <ti/sysbios/BIOS.h>

#include "sim/ti/sysbios/core.h"

#define SEMAPHORES 64

struct Semaphore_Object {
    UInt count;
    Semaphore_Mode mode;
    sim_time_t since; /* the first of the posts that are counted has its turn */
    link_t waiting;   /* tasks */
};

static struct Semaphore_Object semaphores[SEMAPHORES];
static int semaphore_count;

void semaphore_module_reset(void)
{
    memset(semaphores, 0, sizeof semaphores);
    semaphore_count = 0;
}

static bool is_binary(const struct Semaphore_Object *semaphore)
{
    return semaphore->mode == Semaphore_Mode_BINARY || semaphore->mode == Semaphore_Mode_BINARY_PRIORITY;
}

static bool is_by_priority(const struct Semaphore_Object *semaphore)
{
    return semaphore->mode == Semaphore_Mode_COUNTING_PRIORITY ||
           semaphore->mode == Semaphore_Mode_BINARY_PRIORITY;
}

Semaphore_Handle Semaphore_create(Int count, const Semaphore_Params *params, Error_Block *eb)
{
    kernel_require_create_context("Semaphore_create");
    kernel_require(count >= 0 && count <= INT_MAX_C28, "Semaphore_create: count out of range");
    if (semaphore_count == SEMAPHORES) {
        return kernel_create_failed(eb, "Semaphore_create: no memory");
    }
    struct Semaphore_Object *semaphore = &semaphores[semaphore_count++];

    semaphore->count = (UInt)count;
    semaphore->mode = params != NULL ? params->mode : Semaphore_Mode_COUNTING;
    link_init(&semaphore->waiting);
    return semaphore;
}

static Bool take(Semaphore_Handle semaphore, UInt32 timeout)
{
    sim_time_t since = semaphore->since;

    semaphore->count--;
    semaphore->since = timeline_now();
    if (timeout != BIOS_NO_WAIT && kernel_context() == CONTEXT_TASK) {
        task_no_wait(since);
    }
    return TRUE;
}

Bool Semaphore_pend(Semaphore_Handle handle, UInt32 timeout)
{
    task_require_timeout("Semaphore_pend", timeout);
    if (handle->count > 0) {
        return take(handle, timeout);
    }
    if (timeout == BIOS_NO_WAIT) {
        return FALSE;
    }
    task_require_wait("Semaphore_pend");
    if (is_by_priority(handle)) {
        task_queue_by_priority(&handle->waiting, task_self());
    } else {
        link_before(&handle->waiting, &task_self()->wait);
    }
    return task_wait(timeout) != 0 ? TRUE : FALSE;
}

Void Semaphore_post(Semaphore_Handle handle)
{
    if (!link_alone(&handle->waiting)) {
        task_wake(LINK_OWNER(handle->waiting.next, struct Task_Object, wait), 1);
        return;
    }
    if (handle->count == 0) {
        handle->since = timeline_now();
    }
    if (is_binary(handle)) {
        handle->count = 1;
    } else {
        kernel_require(handle->count < WORD_MAX, "Semaphore_post: count past 65535");
        handle->count++;
    }
    kernel_reschedule();
}

Int Semaphore_getCount(Semaphore_Handle handle)
{
    return (Int)handle->count;
}

Void Semaphore_reset(Semaphore_Handle handle, Int count)
{
    kernel_require(count >= 0 && count <= INT_MAX_C28, "Semaphore_reset: count out of range");
    kernel_require(link_alone(&handle->waiting), "Semaphore_reset: a task is waiting");
    handle->count = (UInt)count;
}
