/* SYS/BIOS for the tests of firmware/: CMock's mocks, stubbed by a kernel that runs nothing by itself. It
 * keeps what was created, counts what was posted, runs an interrupt or a task when the test says so, and
 * fails the test at once when a lock is misused. One object of each kind per file under test, several Hwis
 * and gates. */
#ifndef TESTS_FIRMWARE_KERNEL_H
#define TESTS_FIRMWARE_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

#include <ti/sysbios/BIOS.h>
#include <xdc/std.h>

#include "mock_Clock.h"
#include "mock_Event.h"
#include "mock_GateMutexPri.h"
#include "mock_Hwi.h"
#include "mock_Semaphore.h"
#include "mock_Swi.h"
#include "mock_Task.h"

#define KERNEL_HWIS_MAX 6U
#define KERNEL_GATES_MAX 8U
#define KERNEL_NOTES_MAX 16384U

typedef struct {
    const char *name;
    bool held;
    uint32_t entered;
    IArg key;
} kernel_gate_t;

typedef struct {
    struct {
        uint16_t created;
        Task_FuncPtr function;
        Task_Params params;
        const char *name;
        uint16_t sleeps;
        UInt32 slept_ticks;     /* the latest */
        void (*on_sleep)(void); /* what happens meanwhile, or NULL */
    } task;
    struct {
        uint16_t created;
        Swi_FuncPtr function;
        Swi_Params params;
        const char *name;
        bool posted;
        uint16_t posts;
        uint16_t disabled; /* times Swi_disable was called */
        uint16_t depth;
    } swi;
    struct {
        uint16_t count;
        uint16_t disabled; /* times Hwi_disable was called */
        uint16_t depth;
        struct {
            Int number;
            Hwi_FuncPtr function;
            Hwi_Params params;
        } made[KERNEL_HWIS_MAX];
    } hwi;
    struct {
        uint16_t created;
        Clock_FuncPtr function;
        UInt timeout;
        Clock_Params params;
    } clock;
    struct {
        uint16_t created;
        Semaphore_Mode mode;
        Int count;
        uint16_t posts;
    } semaphore;
    struct {
        uint16_t created;
        UInt posted;
        UInt and_mask, or_mask; /* of the latest wait */
        UInt32 timeout;
        UInt (*on_pend)(UInt mask); /* NULL: what is posted of the mask, or blocks */
    } event;
    struct {
        uint16_t count;
        kernel_gate_t made[KERNEL_GATES_MAX];
        void (*on_enter)(void); /* once the gate is held, or NULL */
        void (*on_leave)(void); /* while it is still held, or NULL */
    } gates;
    char notes[KERNEL_NOTES_MAX]; /* what happened, in its order, words with a blank behind each */
} kernel_t;

extern kernel_t kernel;

/* From setUp: an empty kernel, every function stubbed. */
void kernel_reset(void);

/* From tearDown: every lock was given back. */
void kernel_check(void);

/* Adds a word to the notes. The kernel itself notes "pend" when a task waits. */
void kernel_note(const char *word);

/* Runs the created task until it would wait for ever. It fails when the task returns. */
void kernel_run_task(void);

/* True when the action would wait for ever; it is left there. */
bool kernel_blocks(void (*action)(void));

/* For stubs of the product's own waiting functions: nothing more will come. */
void kernel_block(void);

/* Runs the Hwi of that number, then the Swi if it was posted. */
void kernel_interrupt(Int number);

/* Runs the Swi if it is posted. */
void kernel_run_swi(void);

/* Fails unless no lock at all is held: where the firmware calls outward or waits. */
void kernel_no_lock(void);

/* The gate of that name, NULL when there is none. */
kernel_gate_t *kernel_gate(const char *name);

/* A pseudorandom number below `limit` (1..65535), the same sequence in every run after kernel_random_seed().
 */
void kernel_random_seed(uint32_t seed);
uint16_t kernel_random(uint32_t limit);

#endif
