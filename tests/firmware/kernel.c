#include "kernel.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

struct Task_Object {
    char unused;
};
struct Swi_Object {
    char unused;
};
struct Hwi_Object {
    char unused;
};
struct Clock_Object {
    char unused;
};
struct Semaphore_Object {
    char unused;
};
struct Event_Object {
    char unused;
};
struct GateMutexPri_Object {
    char unused;
};

static struct Task_Object task_object;
static struct Swi_Object swi_object;
static struct Hwi_Object hwi_object;
static struct Clock_Object clock_object;
static struct Semaphore_Object semaphore_object;
static struct Event_Object event_object;
static struct GateMutexPri_Object gate_objects[KERNEL_GATES_MAX];

kernel_t kernel;
static jmp_buf blocked;
static bool may_block;
static IArg next_key;
static uint32_t random_state;

#define SWI_KEY 100U
#define HWI_KEY 200U

void kernel_note(const char *word)
{
    TEST_ASSERT_LESS_THAN(sizeof kernel.notes, strlen(kernel.notes) + strlen(word) + 2U);
    (void)strcat(strcat(kernel.notes, word), " ");
}

void kernel_no_lock(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(0, kernel.swi.depth, "Swis are off");
    TEST_ASSERT_EQUAL_MESSAGE(0, kernel.hwi.depth, "interrupts are off");
    for (uint16_t i = 0; i < kernel.gates.count; i++) {
        TEST_ASSERT_FALSE_MESSAGE(kernel.gates.made[i].held, kernel.gates.made[i].name);
    }
}

void kernel_check(void)
{
    kernel_no_lock();
}

void kernel_block(void)
{
    TEST_ASSERT_TRUE_MESSAGE(may_block, "waits for ever");
    longjmp(blocked, 1);
}

bool kernel_blocks(void (*action)(void))
{
    volatile bool left = true;

    may_block = true;
    if (setjmp(blocked) == 0) {
        action();
        left = false;
    }
    may_block = false;
    return left;
}

static void run_task(void)
{
    kernel.task.function(kernel.task.params.arg0, kernel.task.params.arg1);
}

void kernel_run_task(void)
{
    TEST_ASSERT_NOT_NULL(kernel.task.function);
    TEST_ASSERT_TRUE_MESSAGE(kernel_blocks(run_task), "the task ended");
}

void kernel_run_swi(void)
{
    TEST_ASSERT_EQUAL(0, kernel.swi.depth);
    TEST_ASSERT_EQUAL(0, kernel.hwi.depth);
    if (kernel.swi.posted) {
        kernel.swi.posted = false;
        kernel.swi.function(kernel.swi.params.arg0, kernel.swi.params.arg1);
        kernel_no_lock();
    }
}

void kernel_interrupt(Int number)
{
    uint16_t i = 0;

    TEST_ASSERT_EQUAL_MESSAGE(0, kernel.hwi.depth, "interrupts are off");
    while (i < kernel.hwi.count && kernel.hwi.made[i].number != number) {
        i++;
    }
    TEST_ASSERT_LESS_THAN_MESSAGE(kernel.hwi.count, i, "no Hwi of that number");
    kernel.hwi.made[i].function(kernel.hwi.made[i].params.arg);
    TEST_ASSERT_EQUAL(0, kernel.hwi.depth);
    kernel_run_swi();
}

kernel_gate_t *kernel_gate(const char *name)
{
    for (uint16_t i = 0; i < kernel.gates.count; i++) {
        if (strcmp(kernel.gates.made[i].name, name) == 0) {
            return &kernel.gates.made[i];
        }
    }
    return NULL;
}

void kernel_random_seed(uint32_t seed)
{
    random_state = seed;
    printf("seed %lu\n", (unsigned long)seed);
}

uint16_t kernel_random(uint32_t limit)
{
    random_state = (uint32_t)(random_state * 1664525UL + 1013904223UL);
    return (uint16_t)(((random_state >> 16) * limit) >> 16);
}

/* Only after X_Params_init() do they point into themselves. */
#define ASSERT_INITIALISED(params) \
    TEST_ASSERT_EQUAL_PTR_MESSAGE(&(params)->__iprms, (params)->instance, "parameters without their defaults")

static Task_Handle task_create(Task_FuncPtr function, const Task_Params *params, Error_Block *error,
                               int calls)
{
    (void)calls;
    ASSERT_INITIALISED(params);
    TEST_ASSERT_NULL_MESSAGE(error, "a failure must stop the system");
    kernel.task.created++;
    kernel.task.function = function;
    kernel.task.params = *params;
    kernel.task.name = params->instance->name;
    return &task_object;
}

static Void task_sleep(UInt32 ticks, int calls)
{
    (void)calls;
    kernel_no_lock();
    kernel.task.sleeps++;
    kernel.task.slept_ticks = ticks;
    if (kernel.task.on_sleep == NULL) {
        kernel_block();
    } else {
        kernel.task.on_sleep();
    }
}

static Swi_Handle swi_create(Swi_FuncPtr function, const Swi_Params *params, Error_Block *error, int calls)
{
    (void)calls;
    ASSERT_INITIALISED(params);
    TEST_ASSERT_NULL(error);
    kernel.swi.created++;
    kernel.swi.function = function;
    kernel.swi.params = *params;
    kernel.swi.name = params->instance->name;
    return &swi_object;
}

static Void swi_post(Swi_Handle handle, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&swi_object, handle);
    kernel.swi.posted = true;
    kernel.swi.posts++;
}

static UInt swi_disable(int calls)
{
    (void)calls;
    kernel.swi.disabled++;
    return SWI_KEY + kernel.swi.depth++;
}

static Void swi_restore(UInt key, int calls)
{
    (void)calls;
    TEST_ASSERT_GREATER_THAN(0, kernel.swi.depth);
    kernel.swi.depth--;
    TEST_ASSERT_EQUAL_UINT(SWI_KEY + kernel.swi.depth, key);
}

static Hwi_Handle hwi_create(Int number, Hwi_FuncPtr function, const Hwi_Params *params, Error_Block *error,
                             int calls)
{
    const uint16_t at = kernel.hwi.count;

    (void)calls;
    ASSERT_INITIALISED(params);
    TEST_ASSERT_NULL(error);
    TEST_ASSERT_LESS_THAN(KERNEL_HWIS_MAX, at);
    for (uint16_t i = 0; i < at; i++) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(number, kernel.hwi.made[i].number, "two Hwis of one number");
    }
    TEST_ASSERT_TRUE(params->enableInt);
    kernel.hwi.count++;
    kernel.hwi.made[at].number = number;
    kernel.hwi.made[at].function = function;
    kernel.hwi.made[at].params = *params;
    return &hwi_object;
}

static UInt hwi_disable(int calls)
{
    (void)calls;
    kernel.hwi.disabled++;
    return HWI_KEY + kernel.hwi.depth++;
}

static Void hwi_restore(UInt key, int calls)
{
    (void)calls;
    TEST_ASSERT_GREATER_THAN(0, kernel.hwi.depth);
    kernel.hwi.depth--;
    TEST_ASSERT_EQUAL_UINT(HWI_KEY + kernel.hwi.depth, key);
}

static Clock_Handle clock_create(Clock_FuncPtr function, UInt timeout, const Clock_Params *params,
                                 Error_Block *error, int calls)
{
    (void)calls;
    ASSERT_INITIALISED(params);
    TEST_ASSERT_NULL(error);
    kernel.clock.created++;
    kernel.clock.function = function;
    kernel.clock.timeout = timeout;
    kernel.clock.params = *params;
    return &clock_object;
}

static Semaphore_Handle semaphore_create(Int count, const Semaphore_Params *params, Error_Block *error,
                                         int calls)
{
    (void)calls;
    TEST_ASSERT_NULL(error);
    if (params != NULL) {
        ASSERT_INITIALISED(params);
    }
    kernel.semaphore.created++;
    kernel.semaphore.mode = (params == NULL) ? Semaphore_Mode_COUNTING : params->mode;
    kernel.semaphore.count = count;
    return &semaphore_object;
}

static Void semaphore_post(Semaphore_Handle handle, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&semaphore_object, handle);
    kernel.semaphore.posts++;
    if (kernel.semaphore.mode == Semaphore_Mode_COUNTING || kernel.semaphore.count == 0) {
        kernel.semaphore.count++;
    }
}

static Bool semaphore_pend(Semaphore_Handle handle, UInt32 timeout, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&semaphore_object, handle);
    TEST_ASSERT_EQUAL_UINT32(BIOS_WAIT_FOREVER, timeout);
    kernel_no_lock();
    kernel_note("pend");
    if (kernel.semaphore.count == 0) {
        kernel_block();
    }
    kernel.semaphore.count--;
    return TRUE;
}

static Event_Handle event_create(const Event_Params *params, Error_Block *error, int calls)
{
    (void)params;
    (void)calls;
    TEST_ASSERT_NULL(error);
    kernel.event.created++;
    return &event_object;
}

static Void event_post(Event_Handle handle, UInt mask, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&event_object, handle);
    kernel.event.posted |= mask;
}

static UInt event_pend(Event_Handle handle, UInt and_mask, UInt or_mask, UInt32 timeout, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&event_object, handle);
    kernel_no_lock();
    kernel_note("pend");
    kernel.event.and_mask = and_mask;
    kernel.event.or_mask = or_mask;
    kernel.event.timeout = timeout;
    if (kernel.event.on_pend != NULL) {
        return kernel.event.on_pend(or_mask);
    }
    const UInt matched = kernel.event.posted & or_mask;
    if (matched == 0U) {
        kernel_block();
    }
    kernel.event.posted &= ~matched;
    return matched;
}

static GateMutexPri_Handle gate_create(const GateMutexPri_Params *params, Error_Block *error, int calls)
{
    const uint16_t at = kernel.gates.count;

    (void)calls;
    TEST_ASSERT_NULL(error);
    TEST_ASSERT_LESS_THAN(KERNEL_GATES_MAX, at);
    kernel.gates.count++;
    kernel.gates.made[at].name = params->instance->name;
    return &gate_objects[at];
}

static kernel_gate_t *gate_of(GateMutexPri_Handle handle)
{
    uint16_t i = 0;

    while (i < kernel.gates.count && handle != &gate_objects[i]) {
        i++;
    }
    TEST_ASSERT_LESS_THAN_MESSAGE(kernel.gates.count, i, "a gate that was never created");
    return &kernel.gates.made[i];
}

static IArg gate_enter(GateMutexPri_Handle handle, int calls)
{
    kernel_gate_t *gate = gate_of(handle);

    (void)calls;
    kernel_no_lock();
    gate->held = true;
    gate->entered++;
    gate->key = ++next_key;
    if (kernel.gates.on_enter != NULL) {
        kernel.gates.on_enter();
    }
    return gate->key;
}

static Void gate_leave(GateMutexPri_Handle handle, IArg key, int calls)
{
    kernel_gate_t *gate = gate_of(handle);

    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(gate->held, gate->name);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(gate->key, key, gate->name);
    if (kernel.gates.on_leave != NULL) {
        kernel.gates.on_leave();
    }
    gate->held = false;
}

void kernel_reset(void)
{
    (void)memset(&kernel, 0, sizeof kernel);
    may_block = false;
    Task_create_Stub(task_create);
    Task_sleep_Stub(task_sleep);
    Swi_create_Stub(swi_create);
    Swi_post_Stub(swi_post);
    Swi_disable_Stub(swi_disable);
    Swi_restore_Stub(swi_restore);
    Hwi_create_Stub(hwi_create);
    Hwi_disable_Stub(hwi_disable);
    Hwi_restore_Stub(hwi_restore);
    Clock_create_Stub(clock_create);
    Semaphore_create_Stub(semaphore_create);
    Semaphore_post_Stub(semaphore_post);
    Semaphore_pend_Stub(semaphore_pend);
    Event_create_Stub(event_create);
    Event_post_Stub(event_post);
    Event_pend_Stub(event_pend);
    GateMutexPri_create_Stub(gate_create);
    GateMutexPri_enter_Stub(gate_enter);
    GateMutexPri_leave_Stub(gate_leave);
}
