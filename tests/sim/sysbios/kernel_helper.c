#include "tests/sim/sysbios/kernel_helper.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

char trace[4096];

void say(const char *format, ...)
{
    size_t used = strlen(trace);
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(trace + used, sizeof trace - used, format, arguments);
    va_end(arguments);
    used = strlen(trace);
    (void)snprintf(trace + used, sizeof trace - used, "@%" PRId64 " ", timeline_now() / SIM_US);
}

Task_Handle task(const char *name, Int priority, Task_FuncPtr function)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    return Task_create(function, &params, NULL);
}

Swi_Handle swi(const char *name, UInt priority, Swi_FuncPtr function)
{
    Swi_Params params;

    Swi_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    return Swi_create(function, &params, NULL);
}

void hwi(Int number, Hwi_FuncPtr function)
{
    Hwi_Params params;

    Hwi_Params_init(&params);
    params.instance->name = "hwi";
    params.arg = (UArg)number;
    (void)Hwi_create(number, function, &params, NULL);
}

Semaphore_Handle semaphore(Int count, Semaphore_Mode mode)
{
    Semaphore_Params params;

    Semaphore_Params_init(&params);
    params.mode = mode;
    return Semaphore_create(count, &params, NULL);
}

Clock_Handle clock_object(Clock_FuncPtr function, UInt timeout, UInt32 period, Bool start, UArg argument)
{
    Clock_Params params;

    Clock_Params_init(&params);
    params.period = period;
    params.startFlag = start;
    params.arg = argument;
    return Clock_create(function, timeout, &params, NULL);
}

static void raise_interrupt(void *number)
{
    kernel_raise((int)(intptr_t)number);
}

void raise_at_us(sim_time_t when, int number)
{
    (void)timeline_at(when * SIM_US, raise_interrupt, (void *)(intptr_t)number);
}

void run_ms(sim_time_t milliseconds)
{
    bool alive = kernel_run_until(timeline_now() + milliseconds * SIM_MS);

    TEST_ASSERT_TRUE_MESSAGE(alive, kernel_halt_reason());
}

void boot_and_run_ms(int (*entry)(void), sim_time_t milliseconds)
{
    kernel_boot(entry, NULL);
    run_ms(milliseconds);
}

Semaphore_Handle sem, sem_b;
Event_Handle event;
GateMutexPri_Handle gate, gate_b;
Swi_Handle swi_low, swi_mid, swi_high;
Clock_Handle clk;
Task_Handle task_a, task_b;

void kernel_helper_start(void)
{
    trace[0] = '\0';
    timeline_reset();
    kernel_observe(NULL, NULL);
    kernel_set_pacer(NULL);
    kernel_set_fault_hook(NULL);
}

Void say_name(UArg name, UArg unused)
{
    (void)unused;
    say("%s", (const char *)name);
}

static Void wait_and_say(UArg name, UArg handle)
{
    for (;;) {
        (void)Semaphore_pend((Semaphore_Handle)handle, BIOS_WAIT_FOREVER);
        say("%s", (const char *)name);
    }
}

void waiter(const char *name, Int priority, Semaphore_Handle handle)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    params.arg0 = (UArg)name;
    params.arg1 = (UArg)handle;
    (void)Task_create(wait_and_say, &params, NULL);
}

Void poster(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("before");
    Semaphore_post(sem);
    say("between");
    Semaphore_post(sem_b);
    say("after");
}

Void post_sem(UArg unused)
{
    (void)unused;
    Semaphore_post(sem);
}

Void swi_high_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("high");
}

Void equal_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("equal");
}

Void hwi_function(UArg number)
{
    say("hwi %d", (int)number);
}

Void clock_says(UArg name)
{
    say("%s", (const char *)name);
}

void observe_priorities(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                        int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_PRIORITY && detail > job->priority) {
        say("[%s %d]", job->name, detail);
    }
}

void observe_changes(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_PRIORITY) {
        say("[%s %d of %d]", job->name, detail, job->priority);
    }
}

const char *const event_names[] = {"R", "D", "P", "F", "B", "E", "L", "N"};

void observe_all(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)detail;
    TEST_ASSERT_EQUAL_INT64(timeline_now(), when);
    if (strncmp(job->name, "Clock", 5) != 0) {
        say("%s:%s", event_names[what], job->name);
    }
}

static const kernel_cost_t hwi_jobs[] = {
    {NULL, 38, 0},
    {NULL, 96, 500 * SIM_US},
    {NULL, 97, 100 * SIM_US},
    {NULL, 98, 30 * SIM_US},
};
const kernel_costs_t hwi_costs = {hwi_jobs, sizeof hwi_jobs / sizeof hwi_jobs[0], 0, 0};

int hwi_costs_main(void)
{
    hwi(96, hwi_function);
    hwi(97, hwi_function);
    hwi(98, hwi_function);
    BIOS_start();
    return 0;
}
