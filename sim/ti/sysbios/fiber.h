/* Code with a stack of its own that can be left and resumed. One scheduler, on the caller's stack, resumes
 * fibers; a fiber never resumes another one. */
#ifndef SIM_TI_SYSBIOS_FIBER_H
#define SIM_TI_SYSBIOS_FIBER_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __wasm__

#define FIBER_STACK ((size_t)64 * 1024)

/* fiber_asyncify.c. A WebAssembly machine keeps return addresses and locals where no program reaches them: a
 * fiber that pauses unwinds, and writes them to `frames` on the way. */
typedef struct {
    void *stack; /* what C keeps in memory; NULL: no fiber */
    void *stack_pointer;
    struct {
        void *next, *end; /* layout of asyncify */
    } frames;
    void *frames_begin;
    bool paused;
    void (*entry)(void *argument);
    void *argument;
} fiber_t;

#else

#include <setjmp.h>
#include <ucontext.h>

#define FIBER_STACK ((size_t)256 * 1024)

/* fiber.c */
typedef struct {
    ucontext_t context; /* where it begins; under AddressSanitizer also where it goes on */
    jmp_buf jump;       /* where it goes on */
    bool begun;
    void *stack;      /* NULL: no fiber */
    void *fake_stack; /* AddressSanitizer's */
    void (*entry)(void *argument);
    void *argument;
} fiber_t;

#endif

/* False when there is no memory. entry must not return: it ends with fiber_leave(). */
bool fiber_create(fiber_t *fiber, void (*entry)(void *argument), void *argument);
void fiber_free(fiber_t *fiber); /* in any state but running */

/* Most that it has ever had on its stack, in octets: what still has the pattern of fiber_create() was never
 * used. */
size_t fiber_stack_used(const fiber_t *fiber);

/* Scheduler only: runs the fiber until it pauses or leaves. */
void fiber_resume(fiber_t *fiber);
/* Fiber only: back to the scheduler, until resumed. */
void fiber_pause(void);
/* Fiber only: back to the scheduler for good. */
void fiber_leave(void) __attribute__((noreturn));

/* True on a fiber, false on the scheduler's stack. */
bool fiber_inside(void);

/* On the scheduler's stack: calls `function`, and once more each time that it escapes, until it returns. */
void fiber_guard(void (*function)(void));
/* From `function` or what it calls, but not from a fiber: gives up what was begun. */
void fiber_escape(void) __attribute__((noreturn));
/* An escape is possible here: within a guard. */
bool fiber_guarded(void);

#endif
