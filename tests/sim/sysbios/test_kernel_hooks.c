/* The application's hooks: called around every Hwi and Swi, and at every change of the task. */
#include <string.h>

#include "tests/sim/sysbios/kernel_helper.h"
#include "unity.h"

static const kernel_cost_t jobs[] = {
    {NULL, 96, 100 * SIM_US},
    {"swi", -1, 100 * SIM_US},
    {"low", -1, 200 * SIM_US},
    {"high", -1, 100 * SIM_US},
};
static const kernel_costs_t costs = {.jobs = jobs, .job_count = 4};

static const char *name_of(Task_Handle handle)
{
    return handle == NULL ? "nobody" : handle == task_a ? "low" : handle == task_b ? "high" : "idle";
}

static const char *mode_of(Task_Handle handle)
{
    static const char *const modes[] = {"running", "ready", "blocked", "terminated"};

    return handle == NULL ? "-" : modes[Task_getMode(handle)];
}

static void hwi_begin(Hwi_Handle hwi)
{
    (void)hwi;
    say("hwi(");
}

static void hwi_end(Hwi_Handle hwi)
{
    (void)hwi;
    say(")hwi");
}

static void swi_begin(Swi_Handle swi)
{
    say(swi == swi_high ? "swi(" : "clock(");
}

static void swi_end(Swi_Handle swi)
{
    say(swi == swi_high ? ")swi" : ")clock");
}

static void task_switch(Task_Handle before, Task_Handle now)
{
    say("%s:%s>%s", name_of(before), mode_of(before), name_of(now));
}

static const kernel_hooks_t hooks = {hwi_begin, hwi_end, swi_begin, swi_end, task_switch};

void setUp(void)
{
    kernel_helper_start();
    task_a = task_b = NULL;
    kernel_set_hooks(&hooks);
}

void tearDown(void)
{
    kernel_set_hooks(NULL);
}

static Void posts_swi(UArg number)
{
    (void)number;
    Swi_post(swi_high);
}

static Void wakes_high(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    Semaphore_post(sem);
}

static Void low(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    (void)Semaphore_pend(sem_b, BIOS_WAIT_FOREVER);
}

static Void high(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
        say("high");
    }
}

static int hooked_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(1, Semaphore_Mode_COUNTING); /* low's work begins at once */
    hwi(96, posts_swi);
    swi_high = swi("swi", 3, wakes_high);
    task_a = task("low", 2, low);
    task_b = task("high", 5, high);
    BIOS_start();
    return 0;
}

/* The tick's Hwi has no cost and falls together with nothing here. */
void test_an_interrupt_its_swi_and_the_task_that_it_wakes_within_another_task(void)
{
    raise_at_us(150, 96);
    kernel_boot(hooked_main, &costs);
    TEST_ASSERT_TRUE(kernel_run_until(900 * SIM_US));
    TEST_ASSERT_EQUAL_STRING("nobody:->high@0 high:blocked>low@0 hwi(@150 )hwi@250 swi(@250 )swi@350 "
                             "low:ready>high@350 high@450 high:blocked>low@450 low:terminated>idle@500 ",
                             trace);
}

static Void raises_and_waits(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    kernel_raise(96); /* it waits until the kernel lets it in */
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("woken");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
}

static int sleepy_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    hwi(96, post_sem);
    task_b = task("high", 5, raises_and_waits);
    BIOS_start();
    return 0;
}

/* The interrupt waits while the task goes to sleep: the switch comes first, as on the chip. */
void test_a_task_that_waits_and_is_woken_at_once_was_switched_away(void)
{
    kernel_boot(sleepy_main, &costs);
    TEST_ASSERT_TRUE(kernel_run_until(900 * SIM_US));
    TEST_ASSERT_EQUAL_STRING("nobody:->high@0 high:blocked>idle@0 hwi(@0 )hwi@100 idle:ready>high@100 "
                             "woken@200 high:blocked>idle@200 ",
                             trace);
}
