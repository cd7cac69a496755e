#include <string.h>

#include "sim/ti/sysbios/core.h"

#define CLOCKS 64

static struct Clock_Object clocks[CLOCKS];
static int clock_count;
static link_t all;
static UInt32 ticks;
static UInt32 served; /* ticks whose functions were called */
static Swi_Handle swi;
static timeline_id_t tick_event;

static void tick(void *unused)
{
    (void)unused;
    tick_event = timeline_after(TICK_PERIOD, tick, NULL);
    kernel_raise(TICK_INTERRUPT);
}

static Void tick_hwi(UArg unused)
{
    (void)unused;
    ticks++;
    Swi_post(swi);
}

static bool is_due(const struct Clock_Object *object, UInt32 at)
{
    return object->active && object->due == at;
}

static bool any_due(void)
{
    for (UInt32 at = served + 1; at != ticks + 1; at++) {
        for (link_t *element = all.next; element != &all; element = element->next) {
            if (is_due(LINK_OWNER(element, struct Clock_Object, link), at)) {
                return true;
            }
        }
    }
    served = ticks;
    return false;
}

static void serve(struct Clock_Object *object)
{
    if (object->period == 0) {
        object->active = false;
    } else {
        object->due += object->period;
    }
    object->function(object->argument);
}

static Void swi_function(UArg unused0, UArg unused1)
{
    UInt32 last = ticks;

    (void)unused0;
    (void)unused1;
    while (served != last) {
        served++;
        for (link_t *element = all.next; element != &all; element = element->next) {
            struct Clock_Object *object = LINK_OWNER(element, struct Clock_Object, link);

            if (is_due(object, served)) {
                serve(object);
            }
        }
    }
}

void clock_module_reset(void)
{
    (void)timeline_cancel(tick_event);
    tick_event = 0;
    memset(clocks, 0, sizeof clocks);
    clock_count = 0;
    link_init(&all);
    ticks = 0;
    served = 0;
    swi = swi_create_internal(swi_function, "Clock_swi", any_due);
    hwi_create_internal(TICK_INTERRUPT, tick_hwi, "Clock");
}

void clock_module_start(void)
{
    tick_event = timeline_after(TICK_PERIOD, tick, NULL);
}

void clock_init(struct Clock_Object *object, Clock_FuncPtr function, UArg argument)
{
    *object = (struct Clock_Object){.function = function, .argument = argument};
    link_init(&object->link);
}

static void start(struct Clock_Object *object)
{
    object->due = ticks + object->timeout;
    object->active = true;
}

void clock_arm(struct Clock_Object *object, UInt32 timeout)
{
    link_before(&all, &object->link);
    object->timeout = timeout;
    start(object);
}

Clock_Handle Clock_create(Clock_FuncPtr clockFxn, UInt timeout, const Clock_Params *params, Error_Block *eb)
{
    Clock_Params defaults;

    kernel_require_create_context("Clock_create");
    kernel_require(timeout <= WORD_MAX, "Clock_create: timeout does not fit 16 bits");
    if (params == NULL) {
        Clock_Params_init(&defaults);
        params = &defaults;
    }
    kernel_require(!params->startFlag || timeout != 0, "Clock_create: started with a timeout of 0");
    if (clock_count == CLOCKS) {
        return kernel_create_failed(eb, "Clock_create: no memory");
    }
    struct Clock_Object *object = &clocks[clock_count++];

    clock_init(object, clockFxn, params->arg);
    object->timeout = timeout;
    object->period = params->period;
    link_before(&all, &object->link);
    if (params->startFlag) {
        start(object);
    }
    return object;
}

Void Clock_start(Clock_Handle handle)
{
    kernel_require(handle->timeout != 0, "Clock_start: a timeout of 0");
    start(handle);
}

Void Clock_stop(Clock_Handle handle)
{
    handle->active = false;
}

Void Clock_setPeriod(Clock_Handle handle, UInt32 period)
{
    handle->period = period;
}

Void Clock_setTimeout(Clock_Handle handle, UInt32 timeout)
{
    handle->timeout = timeout;
}

UInt32 Clock_getTicks(Void)
{
    return ticks;
}
