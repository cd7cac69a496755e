#ifndef TESTS_SIM_SYSBIOS_KERNEL_HELPER_H
#define TESTS_SIM_SYSBIOS_KERNEL_HELPER_H

/* What the tests of the simulated kernel share. Nothing is asserted inside the firmware of a test: it writes
 * the trace with say(), and the test compares the trace afterwards. */

#include "sim/ti/sysbios/kernel.h"

#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>

/* For setUp(): virtual time 0, an empty trace, nobody observes. */
void kernel_helper_start(void);

/* "text@time " for every say(), time in microseconds. */
extern char trace[4096];
void say(const char *format, ...);

/* Objects for the firmware of a test; each test creates those that it uses. */
extern Semaphore_Handle sem, sem_b;
extern Event_Handle event;
extern GateMutexPri_Handle gate, gate_b;
extern Swi_Handle swi_low, swi_mid, swi_high;
extern Clock_Handle clk;
extern Task_Handle task_a, task_b;

/* Create with the parameters given and defaults for the others. hwi(): the function's argument is the number.
 */
Task_Handle task(const char *name, Int priority, Task_FuncPtr function);
Swi_Handle swi(const char *name, UInt priority, Swi_FuncPtr function);
void hwi(Int number, Hwi_FuncPtr function);
Semaphore_Handle semaphore(Int count, Semaphore_Mode mode);
Clock_Handle clock_object(Clock_FuncPtr function, UInt timeout, UInt32 period, Bool start, UArg argument);
/* A task that says its name whenever it got the semaphore. */
void waiter(const char *name, Int priority, Semaphore_Handle handle);

/* The run must not halt. */
void run_ms(sim_time_t milliseconds);
void boot_and_run_ms(int (*entry)(void), sim_time_t milliseconds);
void raise_at_us(sim_time_t when, int number);

/* Functions for tasks, Swis, Hwis and Clock objects. */
Void say_name(UArg name, UArg unused);
Void poster(UArg a0, UArg a1); /* posts sem, then sem_b, and speaks before, between and after */
Void post_sem(UArg unused);
Void swi_high_function(UArg a0, UArg a1); /* says "high" */
Void equal_swi(UArg a0, UArg a1);         /* says "equal" */
Void hwi_function(UArg number);           /* says "hwi number" */
Void clock_says(UArg name);

/* Observers. Letters of kernel_event_t in event_names. */
extern const char *const event_names[];
void observe_priorities(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                        int detail);
void observe_changes(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                     int detail);
void observe_all(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail);

/* A firmware of three Hwis: 96 costs 500 us, 97 costs 100 us, 98 costs 30 us. */
extern const kernel_costs_t hwi_costs;
int hwi_costs_main(void);

#endif
