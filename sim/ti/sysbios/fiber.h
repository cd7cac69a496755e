/* Code with a stack of its own that can be left and resumed. One scheduler, on the caller's stack, resumes fibers; a fiber
 * never resumes another one. */
#ifndef SIM_TI_SYSBIOS_FIBER_H
#define SIM_TI_SYSBIOS_FIBER_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <ucontext.h>

#define FIBER_STACK ((size_t)256 * 1024)

typedef struct {
    ucontext_t context; /* where it begins; under AddressSanitizer also where it goes on */
    jmp_buf jump;       /* where it goes on */
    bool begun;
    void *stack;        /* NULL: no fiber */
    void *fake_stack;   /* AddressSanitizer's */
    void (*entry)(void *argument);
    void *argument;
} fiber_t;

/* False when there is no memory. entry must not return: it ends with fiber_leave(). */
bool fiber_create(fiber_t *fiber, void (*entry)(void *argument), void *argument);
void fiber_free(fiber_t *fiber); /* in any state but running */

/* Most that it has ever had on its stack, in octets: what still has the pattern of fiber_create() was never used. */
size_t fiber_stack_used(const fiber_t *fiber);

/* Scheduler only: runs the fiber until it pauses or leaves. */
void fiber_resume(fiber_t *fiber);
/* Fiber only: back to the scheduler, until resumed. */
void fiber_pause(void);
/* Fiber only: back to the scheduler for good. */
void fiber_leave(void) __attribute__((noreturn));

/* True on a fiber, false on the scheduler's stack. */
bool fiber_inside(void);

#endif
