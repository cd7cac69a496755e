#include <string.h>

#include <ti/sysbios/BIOS.h>

#include "sim/ti/sysbios/core.h"

#define EVENTS 32
#define FLAGS 16

struct Event_Object {
    UInt posted;
    sim_time_t since[FLAGS];
    UInt and_mask, or_mask; /* of the waiting task */
    link_t waiting;         /* at most one task */
};

static struct Event_Object events[EVENTS];
static int event_count;

void event_module_reset(void)
{
    memset(events, 0, sizeof events);
    event_count = 0;
}

Event_Handle Event_create(const Event_Params *params, Error_Block *eb)
{
    (void)params;
    kernel_require_create_context("Event_create");
    if (event_count == EVENTS) {
        return kernel_create_failed(eb, "Event_create: no memory");
    }
    struct Event_Object *event = &events[event_count++];

    link_init(&event->waiting);
    return event;
}

static UInt consume(Event_Handle event, UInt and_mask, UInt or_mask)
{
    UInt matching = or_mask & event->posted;

    if ((and_mask & event->posted) == and_mask) {
        matching |= and_mask;
    }
    event->posted &= ~matching;
    return matching;
}

static sim_time_t earliest(const struct Event_Object *event, UInt flags)
{
    sim_time_t when = SIM_NEVER;

    for (int i = 0; i < FLAGS; i++) {
        if ((flags >> i & 1u) != 0 && event->since[i] < when) {
            when = event->since[i];
        }
    }
    return when;
}

static void put(Event_Handle event, UInt flags)
{
    for (int i = 0; i < FLAGS; i++) {
        if ((flags & ~event->posted) >> i & 1u) {
            event->since[i] = timeline_now();
        }
    }
    event->posted |= flags;
}

UInt Event_pend(Event_Handle handle, UInt andMask, UInt orMask, UInt32 timeout)
{
    kernel_require((andMask | orMask) != 0, "Event_pend: both masks are 0");
    kernel_require((andMask | orMask) <= WORD_MAX, "Event_pend: mask does not fit 16 bits");
    task_require_timeout("Event_pend", timeout);
    UInt matching = consume(handle, andMask, orMask);

    if (matching != 0 || timeout == BIOS_NO_WAIT) {
        if (timeout != BIOS_NO_WAIT && kernel_context() == CONTEXT_TASK) {
            task_no_wait(earliest(handle, matching));
        }
        return matching;
    }
    task_require_wait("Event_pend");
    kernel_require(link_alone(&handle->waiting), "Event_pend: another task is waiting");
    handle->and_mask = andMask;
    handle->or_mask = orMask;
    link_before(&handle->waiting, &task_self()->wait);
    return task_wait(timeout);
}

Void Event_post(Event_Handle handle, UInt eventMask)
{
    kernel_require(eventMask != 0, "Event_post: no event");
    kernel_require(eventMask <= WORD_MAX, "Event_post: mask does not fit 16 bits");
    put(handle, eventMask);
    if (!link_alone(&handle->waiting)) {
        UInt matching = consume(handle, handle->and_mask, handle->or_mask);

        if (matching != 0) {
            task_wake(LINK_OWNER(handle->waiting.next, struct Task_Object, wait), matching);
            return;
        }
    }
    kernel_reschedule();
}

UInt Event_getPostedEvents(Event_Handle handle)
{
    return handle->posted;
}
