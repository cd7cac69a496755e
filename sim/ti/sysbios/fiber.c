#undef _FORTIFY_SOURCE /* its longjmp() takes another stack for an error */

#include "sim/ti/sysbios/fiber.h"

#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define PATTERN 0xBE
#define PATTERNS UINT64_C(0xBEBEBEBEBEBEBEBE)

static fiber_t *current;
static jmp_buf guard;
static bool guarded;

/* swapcontext() asks the kernel for the signal mask each time, which takes longer than all the rest; jumps do
 * not. The sanitizer wants to be told of each change of the stack, and does not follow jumps. */
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>

static void *scheduler_fake_stack;
static const void *scheduler_stack;
static size_t scheduler_stack_size;

static void announce_fiber(fiber_t *fiber)
{
    __sanitizer_start_switch_fiber(&scheduler_fake_stack, fiber->stack, FIBER_STACK);
}

static void announce_scheduler(void **fake_stack)
{
    __sanitizer_start_switch_fiber(fake_stack, scheduler_stack, scheduler_stack_size);
}

static void arrived_in_fiber(void *fake_stack)
{
    __sanitizer_finish_switch_fiber(fake_stack, &scheduler_stack, &scheduler_stack_size);
}

static ucontext_t scheduler;

static void to_fiber(fiber_t *fiber)
{
    announce_fiber(fiber);
    (void)swapcontext(&scheduler, &fiber->context);
    __sanitizer_finish_switch_fiber(scheduler_fake_stack, NULL, NULL);
}

static void to_scheduler(fiber_t *fiber)
{
    announce_scheduler(&fiber->fake_stack);
    (void)swapcontext(&fiber->context, &scheduler);
    arrived_in_fiber(fiber->fake_stack);
}

static void leave(void)
{
    announce_scheduler(NULL);
    (void)setcontext(&scheduler);
}
#else
static jmp_buf scheduler;

static void arrived_in_fiber(void *fake_stack)
{
    (void)fake_stack;
}

static void to_fiber(fiber_t *fiber)
{
    if (_setjmp(scheduler) != 0) {
        return;
    }
    if (fiber->begun) {
        _longjmp(fiber->jump, 1);
    }
    fiber->begun = true;
    (void)setcontext(&fiber->context);
}

static void to_scheduler(fiber_t *fiber)
{
    if (_setjmp(fiber->jump) == 0) {
        _longjmp(scheduler, 1);
    }
}

static void leave(void)
{
    _longjmp(scheduler, 1);
}
#endif

static void begin(void)
{
    fiber_t *self = current;

    arrived_in_fiber(NULL);
    self->entry(self->argument);
    abort();
}

bool fiber_create(fiber_t *fiber, void (*entry)(void *argument), void *argument)
{
    *fiber = (fiber_t){.stack = malloc(FIBER_STACK), .entry = entry, .argument = argument};
    if (fiber->stack == NULL || getcontext(&fiber->context) != 0) {
        fiber_free(fiber);
        return false;
    }
    memset(fiber->stack, PATTERN, FIBER_STACK);
    fiber->context.uc_stack.ss_sp = fiber->stack;
    fiber->context.uc_stack.ss_size = FIBER_STACK;
    makecontext(&fiber->context, begin, 0);
    return true;
}

void fiber_free(fiber_t *fiber)
{
    free(fiber->stack);
    fiber->stack = NULL;
}

/* The sanitizer marks parts of a stack that is in use. Words first: a flight asks some hundred times. */
__attribute__((no_sanitize("address"))) size_t fiber_stack_used(const fiber_t *fiber)
{
    const unsigned char *stack = fiber->stack;
    const uint64_t *words = fiber->stack; /* malloc() aligns for any type */
    size_t unused = 0;

    while (unused < FIBER_STACK && words[unused / sizeof *words] == PATTERNS) {
        unused += sizeof *words;
    }
    while (unused < FIBER_STACK && stack[unused] == PATTERN) {
        unused++;
    }
    return FIBER_STACK - unused;
}

void fiber_resume(fiber_t *fiber)
{
    current = fiber;
    to_fiber(fiber);
    current = NULL;
}

void fiber_pause(void)
{
    to_scheduler(current);
}

void fiber_leave(void)
{
    leave();
    abort();
}

bool fiber_inside(void)
{
    return current != NULL;
}

void fiber_guard(void (*function)(void))
{
    guarded = true;
    (void)setjmp(guard);
    function();
    guarded = false;
}

void fiber_escape(void)
{
    longjmp(guard, 1);
}

bool fiber_guarded(void)
{
    return guarded;
}
