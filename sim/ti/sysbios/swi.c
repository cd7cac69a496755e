#include <string.h>

#include "sim/ti/sysbios/core.h"

#define SWIS 32

struct Swi_Object {
    job_t job;
    Swi_FuncPtr function;
    UArg arguments[2];
    bool posted; /* and not begun */
    bool begun;
    sim_time_t posted_at;
    link_t link;          /* in posted[], while posted */
    bool (*needed)(void); /* kernel's own: false = nothing to do, the function need not be called; or NULL */
};

static struct Swi_Object swis[SWIS];
static int swi_count;
static link_t posted[PRIORITIES];
static struct Swi_Object *begun[PRIORITIES]; /* at most one of a priority */
static unsigned waiting;                     /* bit p: posted or begun at p */
static job_t *lock_holder;

void swi_module_reset(void)
{
    for (int i = 0; i < swi_count; i++) {
        fiber_free(&swis[i].job.fiber);
    }
    memset(swis, 0, sizeof swis);
    memset(begun, 0, sizeof begun);
    for (int i = 0; i < PRIORITIES; i++) {
        link_init(&posted[i]);
    }
    swi_count = 0;
    waiting = 0;
    lock_holder = NULL;
}

static void update(int priority)
{
    unsigned bit = 1u << priority;

    if (begun[priority] != NULL || !link_alone(&posted[priority])) {
        waiting |= bit;
    } else {
        waiting &= ~bit;
    }
}

job_t *swi_first(void)
{
    if (waiting == 0) {
        return NULL;
    }
    int priority = 31 - __builtin_clz(waiting);

    if (begun[priority] != NULL) {
        return &begun[priority]->job;
    }
    return &LINK_OWNER(posted[priority].next, struct Swi_Object, link)->job;
}

job_t *swi_lock_holder(void)
{
    return lock_holder;
}

void swi_begin(job_t *job)
{
    struct Swi_Object *swi = LINK_OWNER(job, struct Swi_Object, job);

    if (!swi->begun) {
        link_remove(&swi->link);
        swi->posted = false;
        swi->begun = true;
        begun[job->rank] = swi;
        job->remaining = job->cost;
        job->id.released = swi->posted_at;
        kernel_hooks()->swi_begin(swi);
    }
}

static void finish(struct Swi_Object *swi)
{
    kernel_hooks()->swi_end(swi);
    swi->begun = false;
    swi->job.interrupts_off = false;
    begun[swi->job.rank] = NULL;
    update(swi->job.rank);
    if (lock_holder == &swi->job) {
        lock_holder = NULL;
    }
    kernel_yield_processor(KERNEL_FINISHED, &swi->job, swi->job.rank);
}

void swi_run(job_t *job)
{
    struct Swi_Object *swi = LINK_OWNER(job, struct Swi_Object, job);

    if (swi->needed != NULL && !swi->needed()) {
        finish(swi);
    } else {
        fiber_resume(&job->fiber);
    }
}

static void thread(void *argument)
{
    struct Swi_Object *swi = argument;

    for (;;) {
        swi->function(swi->arguments[0], swi->arguments[1]);
        finish(swi);
        fiber_pause();
    }
}

static Swi_Handle create(Swi_FuncPtr function, const Swi_Params *params, const char *name, Error_Block *eb)
{
    struct Swi_Object *swi = &swis[swi_count];

    if (swi_count == SWIS || !fiber_create(&swi->job.fiber, thread, swi)) {
        return kernel_create_failed(eb, "Swi_create: no memory");
    }
    swi->job.rank = params->priority == ~(0U) ? PRIORITIES - 1 : (int)params->priority;
    swi->job.id = (kernel_job_t){KERNEL_SWI, name, swi_count++, swi->job.rank, 0};
    swi->job.cost = kernel_cost_of_name(name);
    swi->function = function;
    swi->arguments[0] = params->arg0;
    swi->arguments[1] = params->arg1;
    return swi;
}

Swi_Handle swi_create_internal(Swi_FuncPtr function, const char *name, bool (*needed)(void))
{
    Swi_Params params;

    Swi_Params_init(&params);
    Swi_Handle swi = create(function, &params, name, NULL);

    swi->needed = needed;
    return swi;
}

Swi_Handle Swi_create(Swi_FuncPtr swiFxn, const Swi_Params *params, Error_Block *eb)
{
    Swi_Params defaults;

    kernel_require_create_context("Swi_create");
    if (params == NULL) {
        Swi_Params_init(&defaults);
        params = &defaults;
    }
    kernel_require(params->priority < PRIORITIES || params->priority == ~(0U),
                   "Swi_create: priority out of range");
    return create(swiFxn, params, kernel_name(params->instance), eb);
}

Void Swi_post(Swi_Handle handle)
{
    if (handle->posted) {
        return;
    }
    handle->posted = true;
    handle->posted_at = timeline_now();
    link_before(&posted[handle->job.rank], &handle->link);
    update(handle->job.rank);
    kernel_observed(KERNEL_RELEASED, &handle->job, handle->job.rank);
    kernel_reschedule();
}

UInt Swi_disable(Void)
{
    job_t *self = kernel_thread();

    if (self == NULL || lock_holder != NULL) {
        return 1;
    }
    lock_holder = self;
    return 0;
}

Void Swi_restore(UInt key)
{
    if (key == 0 && kernel_thread() != NULL) {
        lock_holder = NULL;
        kernel_reschedule();
    }
}
