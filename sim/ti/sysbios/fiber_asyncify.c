/* Fibers of a WebAssembly build. wasm-opt --asyncify makes every function between one that starts an
 * unwinding and one that stops it (here: pause_here or unwind_for_good, and resume_entry or try_once) able to
 * leave in the middle and to come back. Those two ends are not so treated themselves, therefore none of them
 * may be inlined. */
#include "sim/ti/sysbios/fiber.h"

#include <stdlib.h>
#include <string.h>

#define PATTERN 0xBE
#define FRAMES ((size_t)32 * 1024)

__attribute__((import_module("asyncify"), import_name("start_unwind"))) void asyncify_start_unwind(
    void *frames);
__attribute__((import_module("asyncify"), import_name("stop_unwind"))) void asyncify_stop_unwind(void);
__attribute__((import_module("asyncify"), import_name("start_rewind"))) void asyncify_start_rewind(
    void *frames);
__attribute__((import_module("asyncify"), import_name("stop_rewind"))) void asyncify_stop_rewind(void);

static fiber_t *current;
static bool rewinding;
static bool escaping;
static bool guarded;
static struct {
    void *next, *end;
} escape_frames;
static char escape_room[FRAMES];

static void *stack_pointer(void)
{
    void *pointer;

    __asm__ volatile(".globaltype __stack_pointer, i32\n"
                     "global.get __stack_pointer\n"
                     "local.set %0\n"
                     : "=r"(pointer));
    return pointer;
}

static void set_stack_pointer(void *pointer)
{
    __asm__ volatile("local.get %0\n"
                     "global.set __stack_pointer\n"
                     :
                     : "r"(pointer));
}

bool fiber_create(fiber_t *fiber, void (*entry)(void *argument), void *argument)
{
    *fiber = (fiber_t){
        .stack = malloc(FIBER_STACK), .frames_begin = malloc(FRAMES), .entry = entry, .argument = argument};
    if (fiber->stack == NULL || fiber->frames_begin == NULL) {
        fiber_free(fiber);
        return false;
    }
    memset(fiber->stack, PATTERN, FIBER_STACK);
    fiber->stack_pointer = (char *)fiber->stack + FIBER_STACK;
    fiber->frames.next = fiber->frames_begin;
    fiber->frames.end = (char *)fiber->frames_begin + FRAMES;
    return true;
}

void fiber_free(fiber_t *fiber)
{
    free(fiber->stack);
    free(fiber->frames_begin);
    fiber->stack = NULL;
    fiber->frames_begin = NULL;
}

size_t fiber_stack_used(const fiber_t *fiber)
{
    const unsigned char *stack = fiber->stack;
    size_t unused = 0;

    while (unused < FIBER_STACK && stack[unused] == PATTERN) {
        unused++;
    }
    return FIBER_STACK - unused;
}

/* The bottom of every fiber: calls into it, at the beginning or where it paused. */
static __attribute__((noinline)) void resume_entry(void)
{
    fiber_t *fiber = current;

    if (fiber->paused) {
        fiber->paused = false;
        rewinding = true;
        asyncify_start_rewind(&fiber->frames);
    }
    fiber->entry(fiber->argument);
    asyncify_stop_unwind();
}

/* Its locals outlive the fiber's run: the stack pointer is back before they are used. */
__attribute__((noinline)) void fiber_resume(fiber_t *fiber)
{
    void *const scheduler = stack_pointer();

    current = fiber;
    set_stack_pointer(fiber->stack_pointer);
    resume_entry();
    fiber->stack_pointer = stack_pointer();
    set_stack_pointer(scheduler);
    current = NULL;
}

static __attribute__((noinline)) void pause_here(void)
{
    if (rewinding) {
        rewinding = false;
        asyncify_stop_rewind();
    } else {
        current->paused = true;
        current->frames.next = current->frames_begin;
        asyncify_start_unwind(&current->frames);
    }
}

__attribute__((noinline)) void fiber_pause(void)
{
    pause_here();
}

static __attribute__((noinline)) void unwind_for_good(void)
{
    current->frames.next = current->frames_begin;
    asyncify_start_unwind(&current->frames);
}

__attribute__((noinline)) void fiber_leave(void)
{
    unwind_for_good();
    abort();
}

bool fiber_inside(void)
{
    return current != NULL;
}

static __attribute__((noinline)) void try_once(void (*function)(void))
{
    void *const before = stack_pointer();

    function();
    if (escaping) {
        asyncify_stop_unwind();
        set_stack_pointer(before);
    }
}

__attribute__((noinline)) void fiber_guard(void (*function)(void))
{
    guarded = true;
    do {
        escaping = false;
        try_once(function);
    } while (escaping);
    guarded = false;
}

static __attribute__((noinline)) void unwind_to_guard(void)
{
    escaping = true;
    escape_frames.next = escape_room;
    escape_frames.end = escape_room + sizeof escape_room;
    asyncify_start_unwind(&escape_frames);
}

__attribute__((noinline)) void fiber_escape(void)
{
    unwind_to_guard();
    abort();
}

bool fiber_guarded(void)
{
    return guarded;
}
