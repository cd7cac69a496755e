#include "sim/ti/sysbios/kernel.h"

#include <inttypes.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/runtime/Error.h>
#include <xdc/runtime/System.h>

#include "sim/noise.h"
#include "unity.h"

/* Times in the traces are microseconds. Nothing is asserted inside the firmware of a test: it writes the trace, and the
 * test compares it afterwards. */

static char trace[4096];

static void say(const char *format, ...)
{
    size_t used = strlen(trace);
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(trace + used, sizeof trace - used, format, arguments);
    va_end(arguments);
    used = strlen(trace);
    (void)snprintf(trace + used, sizeof trace - used, "@%" PRId64 " ", timeline_now() / SIM_US);
}

static Task_Handle task(const char *name, Int priority, Task_FuncPtr function)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    return Task_create(function, &params, NULL);
}

static Swi_Handle swi(const char *name, UInt priority, Swi_FuncPtr function)
{
    Swi_Params params;

    Swi_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    return Swi_create(function, &params, NULL);
}

static void hwi(Int number, Hwi_FuncPtr function)
{
    Hwi_Params params;

    Hwi_Params_init(&params);
    params.instance->name = "hwi";
    params.arg = (UArg)number;
    (void)Hwi_create(number, function, &params, NULL);
}

static Semaphore_Handle semaphore(Int count, Semaphore_Mode mode)
{
    Semaphore_Params params;

    Semaphore_Params_init(&params);
    params.mode = mode;
    return Semaphore_create(count, &params, NULL);
}

static Clock_Handle clock_object(Clock_FuncPtr function, UInt timeout, UInt32 period, Bool start, UArg argument)
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

static void raise_at_us(sim_time_t when, int number)
{
    (void)timeline_at(when * SIM_US, raise_interrupt, (void *)(intptr_t)number);
}

static void run_ms(sim_time_t milliseconds)
{
    bool alive = kernel_run_until(timeline_now() + milliseconds * SIM_MS);

    TEST_ASSERT_TRUE_MESSAGE(alive, kernel_halt_reason());
}

static void boot_and_run_ms(int (*entry)(void), sim_time_t milliseconds)
{
    kernel_boot(entry, NULL);
    run_ms(milliseconds);
}

static Semaphore_Handle sem, sem_b;
static Event_Handle event;
static GateMutexPri_Handle gate, gate_b;
static Swi_Handle swi_low, swi_mid, swi_high;
static Clock_Handle clk;
static Task_Handle task_a, task_b;

void setUp(void)
{
    trace[0] = '\0';
    timeline_reset();
    kernel_observe(NULL, NULL);
    kernel_set_pacer(NULL);
    kernel_set_fault_hook(NULL);
}

void tearDown(void) {}

static Void say_name(UArg name, UArg unused)
{
    (void)unused;
    say("%s", (const char *)name);
}

/* ---- tasks ---- */

static Task_Handle named_task(const char *name, Int priority)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    params.arg0 = (UArg)name;
    return Task_create(say_name, &params, NULL);
}

static int start_order_main(void)
{
    (void)named_task("low1", 1);
    (void)named_task("high1", 15);
    (void)named_task("low2", 1);
    (void)named_task("high2", 15);
    (void)named_task("mid", 7);
    say("main");
    BIOS_start();
    return 0;
}

void test_tasks_start_by_priority_and_in_order_of_creation_among_equals(void)
{
    kernel_boot(start_order_main, NULL);
    TEST_ASSERT_EQUAL_STRING("main@0 ", trace);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("main@0 high1@0 high2@0 mid@0 low1@0 low2@0 ", trace);
}

static Void args_function(UArg a0, UArg a1)
{
    say("%lx %lx", (unsigned long)a0, (unsigned long)a1);
}

static int args_main(void)
{
    Task_Params params;

    Task_Params_init(&params);
    params.arg0 = 0xAAAA5555u;
    params.arg1 = 0x12u;
    (void)Task_create(args_function, &params, NULL);
    (void)Task_create(args_function, NULL, NULL);
    BIOS_start();
    return 0;
}

void test_arguments_reach_the_task_and_null_params_are_defaults(void)
{
    boot_and_run_ms(args_main, 1);
    TEST_ASSERT_EQUAL_STRING("aaaa5555 12@0 0 0@0 ", trace);
}

static Void wait_and_say(UArg name, UArg handle)
{
    for (;;) {
        (void)Semaphore_pend((Semaphore_Handle)handle, BIOS_WAIT_FOREVER);
        say("%s", (const char *)name);
    }
}

static void waiter(const char *name, Int priority, Semaphore_Handle handle)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    params.arg0 = (UArg)name;
    params.arg1 = (UArg)handle;
    (void)Task_create(wait_and_say, &params, NULL);
}

static Void poster(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("before");
    Semaphore_post(sem);
    say("between");
    Semaphore_post(sem_b);
    say("after");
}

static int preempt_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("high", 9, sem);
    waiter("low", 2, sem_b);
    (void)task("poster", 5, poster);
    BIOS_start();
    return 0;
}

void test_a_post_switches_at_once_to_a_higher_task_and_later_to_a_lower_one(void)
{
    boot_and_run_ms(preempt_main, 1);
    TEST_ASSERT_EQUAL_STRING("before@0 high@0 between@0 after@0 low@0 ", trace);
}

static Void yielder(UArg name, UArg unused)
{
    (void)unused;
    for (int i = 0; i < 2; i++) {
        say("%s%d", (const char *)name, i);
        Task_yield();
    }
}

static int yield_main(void)
{
    static const char *const names[] = {"a", "b", "c"};

    for (int i = 0; i < 3; i++) {
        Task_Params params;

        Task_Params_init(&params);
        params.priority = 3;
        params.arg0 = (UArg)names[i];
        (void)Task_create(yielder, &params, NULL);
    }
    (void)named_task("low", 2);
    BIOS_start();
    return 0;
}

void test_yield_gives_way_to_equals_in_turn_and_not_to_lower_ones(void)
{
    boot_and_run_ms(yield_main, 1);
    TEST_ASSERT_EQUAL_STRING("a0@0 b0@0 c0@0 a1@0 b1@0 c1@0 low@0 ", trace);
}

static Void pri_changer(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("was %d", (int)Task_setPri(task_b, 9)); /* b runs inside */
    say("raised b");
    say("was %d", (int)Task_setPri(task_a, 1)); /* c goes first */
    say("lowered a");
}

static int pri_main(void)
{
    task_a = task("a", 5, pri_changer);
    task_b = named_task("b", 2);
    (void)named_task("c", 3);
    (void)named_task("d", 1);
    BIOS_start();
    return 0;
}

void test_set_pri_takes_effect_at_once_and_returns_the_old_one(void)
{
    boot_and_run_ms(pri_main, 1);
    TEST_ASSERT_EQUAL_STRING("b@0 was 2@0 raised b@0 c@0 was 5@0 lowered a@0 d@0 ", trace);
}

static Void lock_tasks(UArg a0, UArg a1)
{
    UInt outer = Task_disable();
    UInt inner = Task_disable();

    (void)a0;
    (void)a1;
    Semaphore_post(sem);
    say("locked");
    Swi_post(swi_low);
    Task_restore(inner);
    say("still locked");
    Task_restore(outer);
    say("open");
}

static int lock_tasks_main(void)
{
    Swi_Params params;

    sem = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("high", 9, sem);
    (void)task("locker", 5, lock_tasks);
    Swi_Params_init(&params);
    params.arg0 = (UArg) "swi";
    swi_low = Swi_create(say_name, &params, NULL);
    BIOS_start();
    return 0;
}

void test_task_disable_nests_and_holds_back_tasks_but_not_swis(void)
{
    boot_and_run_ms(lock_tasks_main, 1);
    TEST_ASSERT_EQUAL_STRING("locked@0 swi@0 still locked@0 high@0 open@0 ", trace);
}

static Void create_more(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)named_task("higher", 6);
    say("created");
    (void)named_task("lower", 4);
    say("end");
}

static int create_main(void)
{
    (void)task("creator", 5, create_more);
    BIOS_start();
    return 0;
}

void test_a_task_creates_tasks_that_compete_at_once(void)
{
    boot_and_run_ms(create_main, 1);
    TEST_ASSERT_EQUAL_STRING("higher@0 created@0 end@0 lower@0 ", trace);
}

/* ---- time-outs ---- */

static Void sleeper(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(0);
    say("0");
    Task_sleep(1);
    say("1");
    Task_sleep(2);
    say("2");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); /* posted at 4500 us */
    say("posted");
    Task_sleep(1);
    say("1");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); /* at 5999 us */
    Task_sleep(3);
    say("3 ticks %lu", (unsigned long)Clock_getTicks());
}

static Void post_sem(UArg unused)
{
    (void)unused;
    Semaphore_post(sem);
}

static int sleep_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    hwi(96, post_sem);
    (void)task("sleeper", 5, sleeper);
    BIOS_start();
    return 0;
}

void test_a_sleep_of_n_ends_at_the_nth_tick_after_the_call(void)
{
    raise_at_us(4500, 96);
    raise_at_us(5999, 96);
    boot_and_run_ms(sleep_main, 20);
    TEST_ASSERT_EQUAL_STRING("0@0 1@1000 2@3000 posted@4500 1@5000 3 ticks 8@8000 ", trace);
}

static Void pender(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        say(Semaphore_pend(sem, 3) ? "got" : "timeout");
    }
}

static int pend_timeout_main(void)
{
    sem = semaphore(0, Semaphore_Mode_BINARY);
    hwi(96, post_sem);
    (void)task("pender", 5, pender);
    BIOS_start();
    return 0;
}

/* Waits of 3 ticks: 0-3, 3-5.5 (posted), 5.5-8, 8-11. At 11.0 the tick (38) and the post (96) fall together: both Hwis run
 * before the Clock Swi, so the post comes first; the time-out must not strike a second time. 11-14. */
void test_a_pend_times_out_at_the_tick_unless_posted_before(void)
{
    raise_at_us(5500, 96);
    raise_at_us(11000, 96);
    boot_and_run_ms(pend_timeout_main, 14);
    TEST_ASSERT_EQUAL_STRING("timeout@3000 got@5500 timeout@8000 got@11000 timeout@14000 ", trace);
    TEST_ASSERT_EQUAL_INT(0, Semaphore_getCount(sem));
}

static Void longest_sleeper(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(65534);
    say("slept");
    say(Semaphore_pend(sem, 65534) ? "got" : "timeout");
}

static int longest_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    (void)task("sleeper", 5, longest_sleeper);
    BIOS_start();
    return 0;
}

void test_65534_ticks_is_the_longest_finite_wait(void)
{
    boot_and_run_ms(longest_main, 140000);
    TEST_ASSERT_EQUAL_STRING("slept@65534000 timeout@131068000 ", trace);
}

static Void sleeps_until_3(UArg name, UArg first)
{
    Task_sleep((UInt32)first);
    Task_sleep(3 - (UInt32)first);
    say("%s", (const char *)name);
}

static int equal_timeouts_main(void)
{
    static const char *const names[] = {"a", "b", "c"};
    static const UArg first[] = {1, 0, 2};

    for (int i = 0; i < 3; i++) {
        Task_Params params;

        Task_Params_init(&params);
        params.arg0 = (UArg)names[i];
        params.arg1 = first[i];
        (void)Task_create(sleeps_until_3, &params, NULL);
    }
    BIOS_start();
    return 0;
}

void test_equal_timeouts_release_equal_tasks_in_order_of_waiting(void)
{
    boot_and_run_ms(equal_timeouts_main, 5);
    TEST_ASSERT_EQUAL_STRING("b@3000 a@3000 c@3000 ", trace);
}

/* ---- semaphores ---- */

static Void count_down(UArg a0, UArg a1)
{
    int count = 0;

    (void)a0;
    (void)a1;
    for (int i = 0; i < 5; i++) {
        Semaphore_post(sem);
        Semaphore_post(sem_b);
    }
    say("counts %d %d", (int)Semaphore_getCount(sem), (int)Semaphore_getCount(sem_b));
    while (Semaphore_pend(sem, BIOS_NO_WAIT)) {
        count++;
    }
    say("counting %d", count);
    for (count = 0; Semaphore_pend(sem_b, BIOS_NO_WAIT); count++) {
    }
    say("binary %d", count);
    Semaphore_reset(sem, 3);
    say("reset %d", (int)Semaphore_getCount(sem));
    Bool taken = Semaphore_pend(sem, 7);

    say("pend %u left %d", taken, (int)Semaphore_getCount(sem));
}

static int count_main(void)
{
    sem = semaphore(2, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_BINARY);
    (void)task("counter", 5, count_down);
    BIOS_start();
    return 0;
}

void test_counting_semaphores_count_and_binary_ones_stay_at_one(void)
{
    boot_and_run_ms(count_main, 1);
    TEST_ASSERT_EQUAL_STRING("counts 7 1@0 counting 7@0 binary 1@0 reset 3@0 pend 1 left 2@0 ", trace);
}

static Semaphore_Mode mode;

static Void post_four(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    UInt key = Task_disable();

    for (int i = 0; i < 4; i++) {
        Semaphore_post(sem);
        Semaphore_post(sem_b);
    }
    Task_restore(key);
}

static Void wait_once(UArg name, UArg delay)
{
    Task_sleep((UInt32)delay);
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("%s", (const char *)name);
}

static Void post_one_by_one(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    for (int i = 0; i < 4; i++) {
        Semaphore_post(sem);
        Task_sleep(1);
    }
}

static int served_main(void)
{
    static const char *const names[] = {"low1", "high1", "low2", "high2"};

    sem = semaphore(0, mode);
    for (UInt i = 0; i < 4; i++) { /* they begin to wait in this order, at ticks 1 to 4 */
        Task_Params params;

        Task_Params_init(&params);
        params.priority = i % 2 == 0 ? 2 : 4;
        params.arg0 = (UArg)names[i];
        params.arg1 = i + 1;
        (void)Task_create(wait_once, &params, NULL);
    }
    (void)task("poster", 9, post_one_by_one);
    BIOS_start();
    return 0;
}

TEST_CASE(0)
TEST_CASE(1)
void test_plain_semaphores_serve_the_longest_waiting_task(int m)
{
    mode = m == 0 ? Semaphore_Mode_COUNTING : Semaphore_Mode_BINARY;
    boot_and_run_ms(served_main, 20);
    TEST_ASSERT_EQUAL_STRING("low1@5000 high1@6000 low2@7000 high2@8000 ", trace);
}

TEST_CASE(0)
TEST_CASE(1)
void test_priority_semaphores_serve_the_highest_task_and_fifo_among_equals(int m)
{
    mode = m == 0 ? Semaphore_Mode_COUNTING_PRIORITY : Semaphore_Mode_BINARY_PRIORITY;
    boot_and_run_ms(served_main, 20);
    TEST_ASSERT_EQUAL_STRING("high1@5000 high2@6000 low1@7000 low2@8000 ", trace);
}

static int all_at_once_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("low", 2, sem);
    waiter("high", 4, sem);
    waiter("high_b", 4, sem_b);
    (void)task("poster", 9, post_four);
    BIOS_start();
    return 0;
}

/* Under Task_disable the posts go to the queues first (sem: low, high, then count 2), the tasks run afterwards by priority:
 * high was released before high_b; each finds the left counts. */
void test_posts_under_task_disable_release_first_and_run_afterwards(void)
{
    boot_and_run_ms(all_at_once_main, 10);
    TEST_ASSERT_EQUAL_STRING("high@5000 high@5000 high@5000 high_b@5000 high_b@5000 high_b@5000 high_b@5000 low@5000 ",
                             trace);
}

/* ---- events ---- */

static const struct {
    UInt posted, and_mask, or_mask;
    UInt matched, left;
} event_cases[] = {
    {0x0, 0x1, 0x0, 0x0, 0x0},
    {0x1, 0x1, 0x0, 0x1, 0x0},
    {0x1, 0x3, 0x0, 0x0, 0x1},          /* half of an and-mask is not consumed */
    {0x3, 0x3, 0x0, 0x3, 0x0},
    {0x7, 0x3, 0x0, 0x3, 0x4},          /* what was not asked for stays */
    {0x6, 0x0, 0x3, 0x2, 0x4},
    {0x7, 0x0, 0x3, 0x3, 0x4},          /* all of the or-mask that is there */
    {0x4, 0x3, 0x4, 0x4, 0x0},
    {0x5, 0x3, 0x4, 0x4, 0x1},          /* or matches, and does not: its half stays */
    {0x7, 0x3, 0x4, 0x7, 0x0},
    {0x8001, 0x8000, 0x1, 0x8001, 0x0}, /* sixteen events */
    {0xFFFF, 0x0, 0xFFFF, 0xFFFF, 0x0},
};
#define EVENT_CASES (sizeof event_cases / sizeof event_cases[0])

static UInt matched;
static size_t event_case;
static bool event_wait;

static Void post_case(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    if (event_cases[event_case].posted != 0) {
        Event_post(event, event_cases[event_case].posted);
    }
}

static Void event_waiter(UArg a0, UArg a1)
{
    if (!event_wait) {
        post_case(a0, a1);
    }
    matched = Event_pend(event, event_cases[event_case].and_mask, event_cases[event_case].or_mask,
                         event_wait ? 5 : BIOS_NO_WAIT);
}

static int event_main(void)
{
    event = Event_create(NULL, NULL);
    (void)task("waiter", 5, event_waiter);
    if (event_wait) {
        (void)task("poster", 4, post_case);
    }
    BIOS_start();
    return 0;
}

TEST_CASE(false)
TEST_CASE(true)
void test_event_masks_match_and_consume_as_documented(bool wait)
{
    event_wait = wait;
    for (event_case = 0; event_case < EVENT_CASES; event_case++) {
        char message[32];

        (void)snprintf(message, sizeof message, "case %zu", event_case);
        timeline_reset();
        matched = 0xDEAD;
        boot_and_run_ms(event_main, 10);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(event_cases[event_case].matched, matched, message);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(event_cases[event_case].left, Event_getPostedEvents(event), message);
    }
}

static Void event_sequence(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("%x", Event_pend(event, Event_Id_00 | Event_Id_01, Event_Id_NONE, BIOS_WAIT_FOREVER));
    say("%x", Event_pend(event, Event_Id_NONE, Event_Id_02, 2));
    say("%x", Event_pend(event, Event_Id_NONE, Event_Id_15, 9));
}

static Void post_event(UArg number)
{
    Event_post(event, (UInt)1 << (number - 96));
}

static int event_sequence_main(void)
{
    event = Event_create(NULL, NULL);
    for (Int number = 96; number < 96 + 16; number++) {
        hwi(number, post_event);
    }
    (void)task("waiter", 5, event_sequence);
    BIOS_start();
    return 0;
}

/* The and-mask is complete at 1.7 ms; then two ticks from 1.7 end at 3.0; event 15 at 4.2. */
void test_event_pend_waits_for_the_whole_and_mask_and_times_out_with_0(void)
{
    raise_at_us(300, 96);
    raise_at_us(900, 96);
    raise_at_us(1700, 97);
    raise_at_us(4200, 111);
    boot_and_run_ms(event_sequence_main, 10);
    TEST_ASSERT_EQUAL_STRING("3@1700 0@3000 8000@4200 ", trace);
}

/* ---- Swis ---- */

static Void swi_low_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("low begins");
    Swi_post(swi_high);
    Swi_post(swi_high);
    say("low goes on");
}

static Void swi_mid_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("mid begins");
    Swi_post(swi_low);
    Swi_post(swi_low);
    Semaphore_post(sem);
    say("mid ends");
}

static Void swi_high_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("high");
}

static Void swi_task(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("task");
    Swi_post(swi_mid);
    say("task goes on");
}

static int swi_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    swi_low = swi("low", 0, swi_low_function);
    swi_mid = swi("mid", 7, swi_mid_function);
    swi_high = swi("high", ~(0U), swi_high_function);
    (void)task("task", 5, swi_task);
    waiter("waiter", 9, sem);
    BIOS_start();
    return 0;
}

/* Twice posted before it begins is once run; the two posts of high are two runs, because the first had run already. A task
 * released by a Swi waits for all Swis. */
void test_swis_preempt_tasks_and_lower_swis_and_run_once_per_post(void)
{
    boot_and_run_ms(swi_main, 1);
    TEST_ASSERT_EQUAL_STRING("task@0 mid begins@0 mid ends@0 low begins@0 high@0 high@0 low goes on@0 waiter@0 "
                             "task goes on@0 ",
                             trace);
}

static int runs;

static Void reposting(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("run");
    if (++runs < 3) {
        Swi_post(swi_low);
        Swi_post(swi_low);
        say("posted");
    }
}

static Void equal_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("equal");
}

static int repost_main(void)
{
    runs = 0;
    swi_low = swi("s", 3, reposting);
    swi_mid = swi("t", 3, equal_swi);
    Swi_post(swi_low);
    Swi_post(swi_mid);
    say("main");
    BIOS_start();
    return 0;
}

void test_a_swi_posted_while_it_runs_runs_again_behind_its_equals(void)
{
    boot_and_run_ms(repost_main, 1);
    TEST_ASSERT_EQUAL_STRING("main@0 run@0 posted@0 equal@0 run@0 posted@0 run@0 ", trace);
}

static Void lock_swis(UArg a0, UArg a1)
{
    UInt key = Swi_disable();
    UInt inner = Swi_disable();

    (void)a0;
    (void)a1;
    Swi_post(swi_high);
    Semaphore_post(sem);
    say("locked");
    kernel_raise(96);
    Swi_restore(inner); /* an interrupt goes through the lock at the next call */
    Semaphore_post(sem_b);
    say("still locked");
    Swi_restore(key);
    say("open");
}

static Void hwi_function(UArg number)
{
    say("hwi %d", (int)number);
}

static int lock_swis_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    swi_high = swi("high", 15, swi_high_function);
    hwi(96, hwi_function);
    waiter("waiter", 9, sem);
    (void)task("locker", 5, lock_swis);
    BIOS_start();
    return 0;
}

void test_swi_disable_holds_back_swis_and_tasks_but_not_hwis(void)
{
    boot_and_run_ms(lock_swis_main, 1);
    TEST_ASSERT_EQUAL_STRING("locked@0 hwi 96@0 still locked@0 high@0 waiter@0 open@0 ", trace);
}

static Void leaves_lock(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Swi_disable();
    say("key %u", Hwi_disable());
    Swi_post(swi_high);
    say("locked");
}

static Void post_again(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("task");
    Swi_post(swi_low);
}

static int leaves_lock_main(void)
{
    swi_low = swi("low", 1, leaves_lock);
    swi_high = swi("high", 9, swi_high_function);
    (void)task("task", 1, post_again);
    Swi_post(swi_low);
    BIOS_start();
    return 0;
}

void test_the_locks_that_a_swi_leaves_behind_end_with_it(void)
{
    boot_and_run_ms(leaves_lock_main, 1);
    TEST_ASSERT_EQUAL_STRING("key 0@0 locked@0 high@0 task@0 key 0@0 locked@0 high@0 ", trace);
}

/* ---- Hwis ---- */

static Void hwi_posts_all(UArg number)
{
    say("hwi %d", (int)number);
    Semaphore_post(sem);
    Swi_post(swi_low);
    Swi_post(swi_high);
    say("hwi ends");
}

static int hwi_order_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    swi_low = swi("low", 1, equal_swi);
    swi_high = swi("high", 2, swi_high_function);
    for (Int number = 92; number < 100; number++) {
        hwi(number, number == 92 ? hwi_posts_all : hwi_function);
    }
    hwi(1, hwi_function);
    hwi(15, hwi_function);
    hwi(32, hwi_function);
    hwi(223, hwi_function);
    waiter("task", 15, sem);
    BIOS_start();
    return 0;
}

void test_waiting_hwis_go_by_number_then_swis_then_tasks(void)
{
    const int numbers[] = {98, 97, 223, 92, 15, 97, 1, 32, 92};

    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        raise_at_us(500, numbers[i]); /* 97 and 92 twice: latched once */
    }
    boot_and_run_ms(hwi_order_main, 1);
    TEST_ASSERT_EQUAL_STRING("hwi 1@500 hwi 15@500 hwi 32@500 hwi 92@500 hwi ends@500 hwi 97@500 hwi 98@500 hwi 223@500 "
                             "high@500 equal@500 task@500 ",
                             trace);
}

static int early_main(void)
{
    Hwi_Params params;

    kernel_raise(97); /* before it exists */
    hwi(96, hwi_function);
    hwi(97, hwi_function);
    Hwi_Params_init(&params);
    params.enableInt = FALSE;
    params.arg = 98;
    (void)Hwi_create(98, hwi_function, &params, NULL);
    kernel_raise(98);
    kernel_raise(96);
    say("main");
    BIOS_start();
    return 0;
}

void test_interrupts_wait_for_bios_start(void)
{
    boot_and_run_ms(early_main, 1);
    TEST_ASSERT_EQUAL_STRING("main@0 hwi 96@0 hwi 97@0 ", trace);
}

static Void enabler(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(2);
    UInt was = Hwi_enableInterrupt(98); /* the Hwi runs inside */

    say("was %u", was);
    say("was %u", Hwi_enableInterrupt(98));
}

static int enable_main(void)
{
    Hwi_Params params;

    Hwi_Params_init(&params);
    params.enableInt = FALSE;
    params.arg = 98;
    (void)Hwi_create(98, hwi_function, &params, NULL);
    (void)task("enabler", 3, enabler);
    BIOS_start();
    return 0;
}

void test_an_interrupt_is_remembered_once_while_it_is_not_enabled(void)
{
    raise_at_us(300, 98);
    raise_at_us(400, 98);
    raise_at_us(2500, 98);
    boot_and_run_ms(enable_main, 5);
    TEST_ASSERT_EQUAL_STRING("hwi 98@2000 was 0@2000 was 1@2000 hwi 98@2500 ", trace);
}

static Void shut_out(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    UInt key = Hwi_disable();
    UInt inner = Hwi_disable();

    kernel_raise(96);
    kernel_raise(96);
    Semaphore_post(sem_b);
    Hwi_restore(inner);
    say("shut");
    Hwi_restore(key);
    say("open");
    kernel_raise(96);
    say("raised");
    Semaphore_post(sem_b);
    kernel_raise(96);
    say("raised");
    Event_post(event, 1);
    say("end");
}

static int shut_main(void)
{
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    event = Event_create(NULL, NULL);
    hwi(96, hwi_function);
    (void)task("t", 3, shut_out);
    BIOS_start();
    return 0;
}

/* An interrupt that the task's own code provokes is taken at the next kernel call. */
void test_hwi_disable_nests_and_shuts_out_interrupts_until_restored(void)
{
    boot_and_run_ms(shut_main, 1);
    TEST_ASSERT_EQUAL_STRING("shut@0 hwi 96@0 open@0 raised@0 hwi 96@0 raised@0 hwi 96@0 end@0 ", trace);
}

static Void hands_over_shut(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    UInt key = Hwi_disable();

    kernel_raise(96);
    Semaphore_post(sem); /* the waiter runs with its own interrupts on */
    say("back");
    Hwi_restore(key);
    say("end");
}

static int shut_switch_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    hwi(96, hwi_function);
    waiter("waiter", 9, sem);
    (void)task("t", 3, hands_over_shut);
    BIOS_start();
    return 0;
}

void test_interrupts_off_belong_to_the_thread_that_turned_them_off(void)
{
    boot_and_run_ms(shut_switch_main, 1);
    TEST_ASSERT_EQUAL_STRING("hwi 96@0 waiter@0 back@0 end@0 ", trace);
}

static Void raising_swi(UArg a0, UArg a1)
{
    UInt key = Hwi_disable();

    (void)a0;
    (void)a1;
    kernel_raise(96);
    say("swi");
    Hwi_restore(key);
    say("swi ends");
}

static int hwi_in_swi_main(void)
{
    swi_low = swi("s", 3, raising_swi);
    hwi(96, hwi_function);
    Swi_post(swi_low);
    BIOS_start();
    return 0;
}

void test_a_hwi_preempts_a_swi_where_the_swi_lets_it_in(void)
{
    boot_and_run_ms(hwi_in_swi_main, 1);
    TEST_ASSERT_EQUAL_STRING("swi@0 hwi 96@0 swi ends@0 ", trace);
}

static Void locks_in_hwi(UArg number)
{
    UInt task_key = Task_disable();
    UInt swi_key = Swi_disable();
    UInt hwi_key = Hwi_disable();

    Semaphore_post(sem);
    Hwi_restore(hwi_key);
    Swi_restore(swi_key);
    Task_restore(task_key);
    (void)Task_disable(); /* not restored: a Hwi leaves no lock behind */
    (void)Swi_disable();
    (void)Hwi_disable();
    say("hwi %d", (int)number);
}

static int locks_in_hwi_main(void)
{
    (void)Task_disable();
    (void)Swi_disable();
    (void)Hwi_disable();
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    hwi(96, locks_in_hwi);
    waiter("waiter", 9, sem);
    BIOS_start();
    return 0;
}

void test_locks_taken_in_main_or_in_a_hwi_end_with_it(void)
{
    raise_at_us(200, 96);
    raise_at_us(300, 96);
    boot_and_run_ms(locks_in_hwi_main, 1);
    TEST_ASSERT_EQUAL_STRING("hwi 96@200 waiter@200 hwi 96@300 waiter@300 ", trace);
}

/* ---- Clock ---- */

static Void clock_says(UArg name)
{
    say("%s", (const char *)name);
}

static int clock_main(void)
{
    (void)clock_object(clock_says, 3, 2, TRUE, (UArg) "periodic");
    (void)clock_object(clock_says, 3, 0, TRUE, (UArg) "once");
    (void)clock_object(clock_says, 1, 1, FALSE, (UArg) "never");
    BIOS_start();
    return 0;
}

void test_clock_functions_run_once_or_periodically_in_order_of_creation(void)
{
    boot_and_run_ms(clock_main, 7);
    TEST_ASSERT_EQUAL_STRING("periodic@3000 once@3000 periodic@5000 periodic@7000 ", trace);
}

static Void clock_driver(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(5);
    Clock_start(clk); /* 2 from now, then every 3: 7, 10 */
    Task_sleep(6);    /* 11 */
    Clock_start(clk); /* anew: 13 */
    Task_sleep(1);
    Clock_setPeriod(clk, 1); /* from the expiry at 13 on: 14, 15 */
    Task_sleep(3);           /* 15, behind the clock in the same tick */
    Clock_stop(clk);
    Clock_setTimeout(clk, 4);
    Clock_setPeriod(clk, 0);
    Task_sleep(5); /* 20 */
    Clock_start(clk); /* 24 */
}

static int clock_control_main(void)
{
    clk = clock_object(clock_says, 2, 3, FALSE, (UArg) "tick");
    (void)task("driver", 1, clock_driver);
    BIOS_start();
    return 0;
}

void test_clocks_can_be_started_anew_stopped_and_changed(void)
{
    boot_and_run_ms(clock_control_main, 40);
    TEST_ASSERT_EQUAL_STRING("tick@7000 tick@10000 tick@13000 tick@14000 tick@15000 tick@24000 ", trace);
}

static int clock_main_start_main(void)
{
    clk = clock_object(clock_says, 65535, 0, FALSE, (UArg) "tick");
    Clock_start(clk);
    BIOS_start();
    return 0;
}

void test_a_clock_started_in_main_counts_from_bios_start(void)
{
    boot_and_run_ms(clock_main_start_main, 65534);
    TEST_ASSERT_EQUAL_STRING("", trace);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("tick@65535000 ", trace);
}

static Void clock_stops_itself(UArg unused)
{
    (void)unused;
    say("tick");
    Swi_post(swi_high);
    Semaphore_post(sem);
    say("ticks %lu", (unsigned long)Clock_getTicks());
    if (Clock_getTicks() == 4) {
        Clock_stop(clk);
    }
}

static int clock_self_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    swi_high = swi("high", 15, swi_high_function);
    waiter("task", 15, sem);
    clk = clock_object(clock_stops_itself, 2, 2, TRUE, 0);
    BIOS_start();
    return 0;
}

void test_clock_functions_run_at_the_highest_swi_priority_and_may_stop_themselves(void)
{
    boot_and_run_ms(clock_self_main, 10);
    TEST_ASSERT_EQUAL_STRING("tick@2000 ticks 2@2000 high@2000 task@2000 tick@4000 ticks 4@4000 high@4000 task@4000 ",
                             trace);
}

/* ---- gates ---- */

static Void gate_user(UArg name, UArg delay)
{
    Task_sleep((UInt32)delay);
    IArg key = GateMutexPri_enter(gate);

    say("%s in", (const char *)name);
    if (delay == 0) {
        Task_sleep(5);
    }
    GateMutexPri_leave(gate, key);
    say("%s out", (const char *)name);
}

static void gate_task(const char *name, Int priority, UArg delay)
{
    Task_Params params;

    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    params.arg0 = (UArg)name;
    params.arg1 = delay;
    (void)Task_create(gate_user, &params, NULL);
}

static int gate_order_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    gate_task("holder", 1, 0);
    gate_task("low1", 2, 1);
    gate_task("low2", 2, 2);
    gate_task("high", 9, 3);
    gate_task("mid", 4, 4);
    BIOS_start();
    return 0;
}

void test_a_gate_goes_to_the_highest_waiting_task_fifo_among_equals(void)
{
    boot_and_run_ms(gate_order_main, 10);
    TEST_ASSERT_EQUAL_STRING("holder in@0 high in@5000 high out@5000 mid in@5000 mid out@5000 low1 in@5000 low1 out@5000 "
                             "low2 in@5000 low2 out@5000 holder out@5000 ",
                             trace);
}

static Void nested_user(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    IArg outer = GateMutexPri_enter(gate);
    IArg inner = GateMutexPri_enter(gate);
    IArg innermost = GateMutexPri_enter(gate);

    say("keys %d %d %d", (int)outer, (int)inner, (int)innermost);
    GateMutexPri_leave(gate, innermost);
    GateMutexPri_leave(gate, inner);
    Semaphore_post(sem); /* the gate is still held */
    say("inner left");
    GateMutexPri_leave(gate, outer);
    say("outer left");
}

static Void gate_contender(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("wants");
    IArg key = GateMutexPri_enter(gate);

    say("has");
    GateMutexPri_leave(gate, key);
}

static int nested_main(void)
{
    GateMutexPri_Params params;

    GateMutexPri_Params_init(&params);
    params.instance->name = "gate";
    gate = GateMutexPri_create(&params, NULL);
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    (void)task("contender", 9, gate_contender);
    (void)task("user", 2, nested_user);
    IArg key = GateMutexPri_enter(gate); /* main() has it for the asking */

    GateMutexPri_leave(gate, key);
    BIOS_start();
    return 0;
}

void test_the_owner_may_enter_again_and_only_the_last_leave_opens(void)
{
    boot_and_run_ms(nested_main, 1);
    TEST_ASSERT_EQUAL_STRING("keys 0 1 1@0 wants@0 inner left@0 has@0 outer left@0 ", trace);
}

static Void inherit_low(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    IArg key = GateMutexPri_enter(gate);

    Task_sleep(3);
    say("low");
    GateMutexPri_leave(gate, key);
    say("low again low");
}

static Void inherit_mid(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(3);
    say("mid");
}

static Void inherit_high(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(2);
    IArg key = GateMutexPri_enter(gate);

    say("high");
    GateMutexPri_leave(gate, key);
}

static void observe_priorities(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_PRIORITY && detail > job->priority) {
        say("[%s %d]", job->name, detail);
    }
}

static void observe_changes(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_PRIORITY) {
        say("[%s %d of %d]", job->name, detail, job->priority);
    }
}

static int inherit_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    (void)task("mid", 5, inherit_mid); /* its time-out is served first at tick 3 */
    (void)task("low", 1, inherit_low);
    (void)task("high", 9, inherit_high);
    BIOS_start();
    return 0;
}

void test_the_observer_sees_a_priority_inherited_and_given_back(void)
{
    kernel_observe(observe_changes, NULL);
    boot_and_run_ms(inherit_main, 5);
    TEST_ASSERT_EQUAL_STRING("[low 9 of 1]@2000 low@3000 [low 1 of 1]@3000 high@3000 mid@3000 low again low@3000 ", trace);
}

void test_the_observer_sees_a_priority_set(void)
{
    kernel_observe(observe_changes, NULL);
    boot_and_run_ms(pri_main, 1);
    TEST_ASSERT_EQUAL_STRING("[b 9 of 9]@0 b@0 was 2@0 raised b@0 [a 1 of 1]@0 c@0 was 5@0 lowered a@0 d@0 ", trace);
}

void test_the_owner_inherits_the_priority_of_the_waiting_task_until_it_leaves(void)
{
    kernel_observe(observe_priorities, NULL);
    boot_and_run_ms(inherit_main, 5);
    TEST_ASSERT_EQUAL_STRING("[low 9]@2000 low@3000 high@3000 mid@3000 low again low@3000 ", trace);
}

static Void served_high(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    IArg key = GateMutexPri_enter(gate); /* waits until 3 */

    (void)Task_setPri(task_a, 10);
    GateMutexPri_leave(gate, key);
    (void)Task_setPri(task_a, 11);
    say("served");
    Task_sleep(20);
    say("slept");
}

static Void enters_again(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (int i = 0; i < 2; i++) {
        IArg key = GateMutexPri_enter(gate);

        Task_sleep(3);
        GateMutexPri_leave(gate, key);
        say("left");
    }
}

static int served_gate_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    task_a = task("high", 9, served_high);
    (void)task("low", 1, enters_again);
    BIOS_start();
    return 0;
}

void test_a_task_that_got_its_gate_no_longer_counts_as_waiting_for_it(void)
{
    boot_and_run_ms(served_gate_main, 30);
    TEST_ASSERT_EQUAL_STRING("served@3000 left@3000 left@6000 slept@23000 ", trace);
}

static Void chain_c(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    IArg key = GateMutexPri_enter(gate);

    Task_sleep(4);
    say("c");
    GateMutexPri_leave(gate, key);
    say("c out");
}

static Void chain_b(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    IArg key_b = GateMutexPri_enter(gate_b);
    IArg key = GateMutexPri_enter(gate);

    say("b");
    GateMutexPri_leave(gate, key);
    say("b left one"); /* still 9: a waits for the other */
    GateMutexPri_leave(gate_b, key_b);
    say("b out");
}

static Void chain_a(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(2);
    IArg key = GateMutexPri_enter(gate_b);

    say("a");
    GateMutexPri_leave(gate_b, key);
    say("a out");
}

static Void chain_mid(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(4);
    say("mid");
}

static int chain_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    gate_b = GateMutexPri_create(NULL, NULL);
    (void)task("mid", 5, chain_mid);
    (void)task("c", 1, chain_c);
    (void)task("b", 2, chain_b);
    (void)task("a", 9, chain_a);
    BIOS_start();
    return 0;
}

/* a (9) waits for b (2), which waits for c (1): c runs at 9 although only b waits for it. */
void test_priority_is_inherited_along_a_chain_of_three(void)
{
    kernel_observe(observe_priorities, NULL);
    boot_and_run_ms(chain_main, 10);
    TEST_ASSERT_EQUAL_STRING("[c 2]@1000 [b 9]@2000 [c 9]@2000 c@4000 b@4000 b left one@4000 a@4000 a out@4000 mid@4000 "
                             "b out@4000 c out@4000 ",
                             trace);
}

static Void raise_waiter(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(4);
    (void)Task_setPri(task_b, 12); /* it passes the first, and the owner inherits */
    say("set");
}

static int requeue_main(void)
{
    Task_Params params;

    gate = GateMutexPri_create(NULL, NULL);
    gate_task("holder", 1, 0);
    gate_task("first", 3, 1);
    Task_Params_init(&params);
    params.instance->name = "second";
    params.priority = 2;
    params.arg0 = (UArg) "second";
    params.arg1 = 2;
    task_b = Task_create(gate_user, &params, NULL);
    (void)task("setter", 15, raise_waiter);
    BIOS_start();
    return 0;
}

void test_a_change_of_a_waiting_tasks_priority_reaches_queue_and_owner(void)
{
    kernel_observe(observe_priorities, NULL);
    boot_and_run_ms(requeue_main, 10);
    TEST_ASSERT_EQUAL_STRING("holder in@0 [holder 3]@1000 [holder 12]@4000 set@4000 second in@5000 second out@5000 "
                             "first in@5000 first out@5000 holder out@5000 ",
                             trace);
}

static Void two_gates_low(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    IArg key = GateMutexPri_enter(gate);
    IArg key_b = GateMutexPri_enter(gate_b);

    Semaphore_post(sem); /* the contender waits for `gate` */
    GateMutexPri_leave(gate_b, key_b);
    Semaphore_post(sem_b); /* mid is ready, below the inherited priority */
    say("low");
    GateMutexPri_leave(gate, key);
    say("low out");
}

static int two_gates_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    gate_b = GateMutexPri_create(NULL, NULL);
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    (void)task("contender", 9, gate_contender);
    waiter("mid", 5, sem_b);
    (void)task("low", 1, two_gates_low);
    BIOS_start();
    return 0;
}

/* TI's gate restores the priority that its owner had on entering it, whoever waits for another gate of the owner's. */
void test_leaving_an_inner_gate_loses_what_is_inherited_through_the_outer_one(void)
{
    boot_and_run_ms(two_gates_main, 1);
    TEST_ASSERT_EQUAL_STRING("wants@0 mid@0 low@0 has@0 low out@0 ", trace);
}

/* ---- costs: virtual times computed by hand ---- */

static Void post_sem_b(UArg unused)
{
    (void)unused;
    say("hwi b");
    Semaphore_post(sem_b);
}

static Void swi_posts_sem(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("swi");
    Semaphore_post(sem);
}

static Void post_swi_low(UArg unused)
{
    (void)unused;
    say("hwi");
    Swi_post(swi_low);
}

static const kernel_cost_t preemption_jobs[] = {
    {"Low", -1, 1000 * SIM_US},
    {"High", -1, 300 * SIM_US},
    {"Swi", -1, 50 * SIM_US},
    {NULL, 38, 4 * SIM_US},
    {NULL, 96, 20 * SIM_US},
    {NULL, 97, 10 * SIM_US},
};
static const kernel_costs_t preemption_costs = {preemption_jobs, 6, 0, 57 * SIM_US};

static int preemption_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("Low", 3, sem);
    waiter("High", 5, sem_b);
    swi_low = swi("Swi", 3, swi_posts_sem);
    hwi(96, post_swi_low);
    hwi(97, post_sem_b);
    BIOS_start();
    return 0;
}

/* 1500 Hwi 96 is raised, done 1520. Swi until 1570. Low needs 57 + 1000 = 1057; 430 done at 2000, when the tick takes 4.
 * 2004 Low; 96 more = 526 done at 2100. Hwi 97 until 2110. High needs 57 + 300 = 357: done at 2467. Low's last 531: done at
 * 2998, before the next tick. */
void test_costs_are_consumed_preemptibly_before_the_code_runs(void)
{
    raise_at_us(1500, 96);
    raise_at_us(2100, 97);
    kernel_boot(preemption_main, &preemption_costs);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("hwi@1520 swi@1570 hwi b@2110 High@2467 Low@2998 ", trace);
}

static const char *const event_names[] = {"R", "D", "P", "F", "B", "E", "L", "N"};

static void observe_all(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)detail;
    TEST_ASSERT_EQUAL_INT64(timeline_now(), when);
    if (strncmp(job->name, "Clock", 5) != 0) {
        say("%s:%s", event_names[what], job->name);
    }
}

void test_the_observer_sees_releases_dispatches_preemptions_and_ends(void)
{
    raise_at_us(1500, 96);
    raise_at_us(2100, 97);
    kernel_boot(preemption_main, &preemption_costs);
    (void)kernel_run_until(1 * SIM_MS);
    trace[0] = '\0';
    kernel_observe(observe_all, NULL);
    run_ms(4);
    TEST_ASSERT_EQUAL_STRING("R:hwi@1500 D:hwi@1500 hwi@1520 R:Swi@1520 F:hwi@1520 D:Swi@1520 swi@1570 R:Low@1570 "
                             "F:Swi@1570 D:Low@1570 P:Low@2000 D:Low@2004 R:hwi@2100 P:Low@2100 D:hwi@2100 hwi b@2110 "
                             "R:High@2110 F:hwi@2110 D:High@2110 High@2467 F:High@2467 D:Low@2467 Low@2998 F:Low@2998 ",
                             trace);
}

static Void takes_what_is_there(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("one");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("two");
}

static int backlog_main(void)
{
    sem = semaphore(2, Semaphore_Mode_COUNTING);
    (void)task("t", 3, takes_what_is_there);
    BIOS_start();
    return 0;
}

void test_the_observer_sees_a_job_for_every_wait_that_returns_at_once(void)
{
    kernel_observe(observe_all, NULL);
    boot_and_run_ms(backlog_main, 1);
    TEST_ASSERT_EQUAL_STRING("R:t@0 D:t@0 F:t@0 R:t@0 D:t@0 one@0 F:t@0 R:t@0 D:t@0 two@0 F:t@0 ", trace);
}

static void observe_responses(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)detail;
    if (what == KERNEL_FINISHED && strncmp(job->name, "Clock", 5) != 0) {
        say("%s%d %" PRId64, job->name, job->number, (when - job->released) / SIM_US);
    }
}

static const kernel_cost_t response_jobs[] = {
    {"t", -1, 400 * SIM_US}, {"s", -1, 100 * SIM_US}, {NULL, 96, 10 * SIM_US}, {NULL, 97, 20 * SIM_US},
    {NULL, 98, 30 * SIM_US},
};
static const kernel_costs_t response_costs = {response_jobs, 5, 0, 0};

static Void pends_semaphore(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    }
}

static Void pends_event(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        (void)Event_pend(event, Event_Id_NONE, Event_Id_00 | Event_Id_01, BIOS_WAIT_FOREVER);
    }
}

static Void quiet_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Semaphore_post(sem);
    Event_post(event, Event_Id_01);
    Event_post(event, Event_Id_02); /* nobody waits for this one */
}

static Void quiet_hwi(UArg number)
{
    Swi_post(swi_low);
    for (int i = 0; number == 98 && i < 3; i++) {
        Semaphore_post(sem);
    }
}

static Semaphore_Mode response_mode;
static Task_FuncPtr response_task;

static int response_main(void)
{
    sem = semaphore(0, response_mode);
    event = Event_create(NULL, NULL);
    (void)task("t", 3, response_task);
    swi_low = swi("s", 3, quiet_swi);
    hwi(96, quiet_hwi);
    hwi(97, quiet_hwi);
    hwi(98, quiet_hwi);
    BIOS_start();
    return 0;
}

static void observe_responses_from_100_us(void)
{
    kernel_boot(response_main, &response_costs);
    (void)kernel_run_until(100 * SIM_US);
    kernel_observe(observe_responses, NULL);
    run_ms(3);
}

/* 200 Hwi 96; the Swi has done 90 of 100 when Hwi 97 comes at 300 and posts it anew at 320; it ends at 330 and again at
 * 430. The task is released at 330 and, with nothing done, at 430: jobs of 400 end at 830 and 1230. */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
void test_a_response_counts_from_the_release_also_when_the_job_found_it_waiting(int kind)
{
    response_mode = kind == 0 ? Semaphore_Mode_BINARY : Semaphore_Mode_COUNTING;
    response_task = kind == 2 ? pends_event : pends_semaphore;
    raise_at_us(200, 96);
    raise_at_us(300, 97);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi96 10@210 hwi97 20@320 s1 120@330 s1 110@430 t0 500@830 t0 800@1230 ", trace);
}

/* Hwi 98 ends at 230 with three posts; the Swi until 330 brings a fourth. Jobs end at 730, 1130, 1530, 1930: released 230,
 * 230 (it waited), 730 (the job ahead of it began), 1130. */
void test_posts_behind_one_another_are_released_when_the_job_ahead_begins(void)
{
    response_mode = Semaphore_Mode_COUNTING;
    response_task = pends_semaphore;
    raise_at_us(200, 98);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi98 30@230 s1 100@330 t0 500@730 t0 900@1130 t0 800@1530 t0 800@1930 ", trace);
}

static const char *const kind_names[] = {"hwi", "swi", "task"};

static void observe_identities(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_DISPATCHED) {
        say("%s:%s:%d:%d:%d", kind_names[job->kind], job->name, job->number, job->priority, detail);
    }
}

static Void pends_in_turn(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        (void)Event_pend(event, Event_Id_NONE, Event_Id_01, BIOS_WAIT_FOREVER);
        (void)Event_pend(event, Event_Id_NONE, Event_Id_02, BIOS_WAIT_FOREVER);
    }
}

/* 200 Hwi 96, Swi until 310: flag 1 ends the wait, and flag 2 is there already, both posted at 310; jobs until 710 and
 * 1110 + 110, because at 800 Hwi 96 and the Swi come again, with both flags at 910. Jobs until 1620 and 2020 for them. */
void test_flags_posted_together_are_released_together(void)
{
    response_task = pends_in_turn;
    raise_at_us(200, 96);
    raise_at_us(800, 96);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi96 10@210 s1 100@310 t0 400@710 hwi96 10@810 s1 100@910 t0 910@1220 t0 710@1620 "
                             "t0 1110@2020 ",
                             trace);
}

static Void pends_late(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    for (;;) {
        (void)Event_pend(event, Event_Id_NONE, Event_Id_01, BIOS_WAIT_FOREVER);
        Task_sleep(1);
        (void)Event_pend(event, Event_Id_NONE, Event_Id_02, BIOS_WAIT_FOREVER);
    }
}

/* Flags 1 and 2 at 310; job until 710; the sleep ends at 1000, job until 1400; flag 2 is older than the sleep's end. */
void test_a_flag_that_nobody_waited_for_releases_when_it_is_asked_for(void)
{
    response_task = pends_late;
    raise_at_us(200, 96);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi96 10@210 s1 100@310 t0 400@710 t0 400@1400 t0 400@1800 ", trace);
}

static const kernel_cost_t label_jobs[] = {
    {"label", 96, 5 * SIM_US}, {"other label", 97, 5 * SIM_US}, {"label", -1, 100 * SIM_US}, {NULL, 98, 5 * SIM_US},
};
static const kernel_costs_t label_costs = {label_jobs, 4, 0, 0};

static Void tick_function(UArg unused)
{
    (void)unused;
}

static int label_main(void)
{
    Hwi_Params params;

    sem = semaphore(0, Semaphore_Mode_COUNTING);
    (void)Hwi_create(96, post_sem, NULL, NULL);
    Hwi_Params_init(&params);
    params.instance->name = "own name";
    (void)Hwi_create(97, hwi_function, &params, NULL);
    (void)Hwi_create(98, hwi_function, NULL, NULL);
    (void)clock_object(tick_function, 1, 0, TRUE, 0);
    (void)task("other", 1, pends_semaphore);
    (void)task("label", 7, pends_semaphore);
    BIOS_start();
    return 0;
}

/* The task "label" costs what its own entry says, not the interrupt's of the same name. */
void test_a_hwi_without_a_name_is_known_by_that_of_its_cost(void)
{
    raise_at_us(500, 96);
    raise_at_us(700, 97);
    raise_at_us(800, 98);
    kernel_boot(label_main, &label_costs);
    (void)kernel_run_until(400 * SIM_US);
    kernel_observe(observe_identities, NULL);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("hwi:label:96:96:96@500 task:label:1:7:7@505 hwi:own name:97:97:97@700 hwi 0@705 "
                             "hwi::98:98:98@800 hwi 0@805 hwi:Clock:38:38:38@1000 swi:Clock_swi:0:15:15@1000 ",
                             trace);
}

static const kernel_cost_t hwi_jobs[] = {
    {NULL, 38, 0}, {NULL, 96, 500 * SIM_US}, {NULL, 97, 100 * SIM_US}, {NULL, 98, 30 * SIM_US},
};
static const kernel_costs_t hwi_costs = {hwi_jobs, 4, 0, 0};

static int hwi_costs_main(void)
{
    hwi(96, hwi_function);
    hwi(97, hwi_function);
    hwi(98, hwi_function);
    BIOS_start();
    return 0;
}

/* 98 begins at 1400 and is not preempted: done 1430. 96 until 1930; in the meantime 97 and 98 rise, and 96 again, twice: one
 * is latched. 96 again until 2430 (its number goes first), 97 until 2530, 98 until 2560. */
void test_hwis_do_not_nest_and_latch_one_deep(void)
{
    raise_at_us(1400, 98);
    raise_at_us(1410, 96);
    raise_at_us(1500, 98);
    raise_at_us(1500, 97);
    raise_at_us(1600, 97);
    raise_at_us(1600, 96);
    raise_at_us(1700, 96);
    kernel_boot(hwi_costs_main, &hwi_costs);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("hwi 98@1430 hwi 96@1930 hwi 96@2430 hwi 97@2530 hwi 98@2560 ", trace);
}

static const kernel_cost_t swi_jobs[] = {
    {"low", -1, 400 * SIM_US}, {"high", -1, 100 * SIM_US}, {NULL, 96, 10 * SIM_US}, {NULL, 97, 10 * SIM_US},
};
static const kernel_costs_t swi_costs = {swi_jobs, 4, 0, 0};

static Void post_swi_high(UArg unused)
{
    (void)unused;
    Swi_post(swi_high);
}

static int swi_costs_main(void)
{
    swi_low = swi("low", 2, equal_swi);
    swi_mid = swi("mid", 2, equal_swi);
    swi_high = swi("high", 9, swi_high_function);
    hwi(96, post_swi_low);
    hwi(97, post_swi_high);
    BIOS_start();
    return 0;
}

/* Hwi 96 until 110, low begins: 400. 200 Hwi 97, high 210 to 310. 320 Hwi 96 posts low again, which has begun, so that it
 * runs once more. low used 90 until 200, 10 from 310 to 320, the last 300 from 330 to 630; again until 1030. */
void test_swi_costs_are_preempted_by_hwis_and_higher_swis(void)
{
    raise_at_us(100, 96);
    raise_at_us(200, 97);
    raise_at_us(320, 96);
    kernel_boot(swi_costs_main, &swi_costs);
    run_ms(2);
    TEST_ASSERT_EQUAL_STRING("hwi@110 high@310 hwi@330 equal@630 equal@1030 ", trace);
}

static const kernel_costs_t gate_costs = {NULL, 0, 100 * SIM_US, 10 * SIM_US};

static Void costly_gate_low(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    IArg key = GateMutexPri_enter(gate);

    say("low in");
    GateMutexPri_leave(gate, key);
    say("low out");
}

static Void costly_gate_high(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
    say("high wants");
    IArg key = GateMutexPri_enter(gate);

    say("high in");
    GateMutexPri_leave(gate, key);
}

static int costly_gate_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(0, Semaphore_Mode_COUNTING);
    (void)task("low", 1, costly_gate_low);
    (void)task("high", 9, costly_gate_high);
    waiter("mid", 5, sem_b);
    hwi(96, post_sem);
    hwi(97, post_sem_b);
    BIOS_start();
    return 0;
}

/* Low is released at 1000, switches 10, enters at 1010 and pays 100 with the gate held; 40 of it at 1050. High switches 10
 * and finds the gate taken at 1060. Mid is ready at 1065. Low, at 9 now, pays its last 60: in at 1120, and leaves. High
 * switches again and pays its access: 1230. Mid 1240, then low. */
void test_gate_access_costs_time_while_the_gate_is_held_and_a_blocking_costs_two_switches(void)
{
    raise_at_us(1050, 96);
    raise_at_us(1065, 97);
    kernel_boot(costly_gate_main, &gate_costs);
    kernel_observe(observe_priorities, NULL);
    run_ms(3);
    TEST_ASSERT_EQUAL_STRING("high wants@1060 [low 9]@1060 hwi b@1065 low in@1120 high in@1230 mid@1240 low out@1240 ", trace);
}

static void observe_gates(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)when;
    if (what == KERNEL_GATE_BLOCKED || what == KERNEL_GATE_ENTERED || what == KERNEL_GATE_LEFT) {
        say("%s:%s:%d", event_names[what], job->name, detail);
    }
}

void test_the_observer_sees_gates_blocked_entered_and_left(void)
{
    raise_at_us(1050, 96);
    kernel_observe(observe_gates, NULL);
    kernel_boot(costly_gate_main, &gate_costs);
    run_ms(3);
    TEST_ASSERT_EQUAL_STRING("E:low:0@1010 high wants@1060 B:high:0@1060 low in@1120 L:low:0@1120 E:high:0@1120 "
                             "high in@1230 L:high:0@1230 low out@1230 ",
                             trace);
}

static int named_gates_main(void)
{
    GateMutexPri_Params params;

    GateMutexPri_Params_init(&params);
    params.instance->name = "first";
    (void)GateMutexPri_create(&params, NULL);
    (void)GateMutexPri_create(NULL, NULL);
    GateMutexPri_Params_init(&params);
    (void)GateMutexPri_create(&params, NULL);
    BIOS_start();
    return 0;
}

void test_gates_are_known_by_number_and_name(void)
{
    boot_and_run_ms(named_gates_main, 1);
    TEST_ASSERT_EQUAL_STRING("first", kernel_gate_name(0));
    TEST_ASSERT_EQUAL_STRING("", kernel_gate_name(1));
    TEST_ASSERT_EQUAL_STRING("", kernel_gate_name(2));
}

static Void nested_access(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    IArg outer = GateMutexPri_enter(gate);
    IArg inner = GateMutexPri_enter(gate);

    say("in");
    GateMutexPri_leave(gate, inner);
    GateMutexPri_leave(gate, outer);
    say("out");
}

static int nested_access_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    (void)task("t", 1, nested_access);
    BIOS_start();
    return 0;
}

void test_every_enter_costs_its_access_also_a_nested_one(void)
{
    kernel_boot(nested_access_main, &gate_costs);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("in@200 out@200 ", trace);
}

static const kernel_cost_t wait_jobs[] = {{"t", -1, 200 * SIM_US}};
static const kernel_costs_t wait_costs = {wait_jobs, 1, 0, 50 * SIM_US};

static Void waits_of_all_kinds(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("start"); /* the first run is no job */
    Task_sleep(1);
    say("slept");
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); /* count 2: at once, and a job of its own */
    say("pended");
    (void)Event_pend(event, 1, 0, BIOS_WAIT_FOREVER); /* posted in main() */
    say("event");
    (void)Semaphore_pend(sem, BIOS_NO_WAIT); /* polls cost nothing */
    (void)Event_pend(event, 1, 0, BIOS_NO_WAIT);
    (void)Semaphore_pend(sem, BIOS_NO_WAIT);
    say("polled");
    say("%d", Semaphore_pend(sem, 1)); /* until tick 2 */
    say("%d", (int)Event_pend(event, 1, 0, 1)); /* until tick 3 */
}

static int waits_main(void)
{
    sem = semaphore(2, Semaphore_Mode_COUNTING);
    event = Event_create(NULL, NULL);
    Event_post(event, 1);
    (void)task("t", 5, waits_of_all_kinds);
    BIOS_start();
    return 0;
}

/* Each job 200 + 50. */
void test_every_wait_that_returns_begins_a_job_and_a_poll_does_not(void)
{
    kernel_boot(waits_main, &wait_costs);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("start@0 slept@1250 pended@1500 event@1750 polled@1750 0@2250 0@3250 ", trace);
}

static Void slow_shut(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    UInt key = Hwi_disable();
    IArg gate_key = GateMutexPri_enter(gate); /* 4.5 ms with interrupts off: ticks 2 to 5 */

    GateMutexPri_leave(gate, gate_key);
    say("shut, ticks %lu", (unsigned long)Clock_getTicks());
    Hwi_restore(key);
    say("open, ticks %lu", (unsigned long)Clock_getTicks());
}

static int slow_shut_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    (void)task("t", 5, slow_shut);
    BIOS_start();
    return 0;
}

void test_ticks_are_lost_while_interrupts_stay_off(void)
{
    const kernel_costs_t slow = {NULL, 0, 4500 * SIM_US, 0};

    kernel_boot(slow_shut_main, &slow);
    run_ms(10);
    TEST_ASSERT_EQUAL_STRING("shut, ticks 1@5500 open, ticks 2@5500 ", trace);
}

static Void slow_locked(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    UInt key = Swi_disable();
    IArg gate_key = GateMutexPri_enter(gate); /* the Clock Swi is held back over ticks 2 to 5 */

    GateMutexPri_leave(gate, gate_key);
    say("ticks %lu", (unsigned long)Clock_getTicks());
    Swi_restore(key);
    say("open");
}

static int slow_locked_main(void)
{
    gate = GateMutexPri_create(NULL, NULL);
    (void)clock_object(clock_says, 1, 1, TRUE, (UArg) "a");
    (void)clock_object(clock_says, 2, 2, TRUE, (UArg) "b");
    (void)task("t", 5, slow_locked);
    BIOS_start();
    return 0;
}

void test_a_delayed_clock_swi_makes_up_for_every_tick_in_order(void)
{
    const kernel_costs_t slow = {NULL, 0, 4500 * SIM_US, 0};

    kernel_boot(slow_locked_main, &slow);
    run_ms(6);
    TEST_ASSERT_EQUAL_STRING("a@1000 ticks 5@5500 a@5500 b@5500 a@5500 a@5500 b@5500 a@5500 open@5500 a@6000 b@6000 ",
                             trace);
}

static const kernel_cost_t slice_jobs[] = {{"one", -1, 5000 * SIM_US}, {"two", -1, 5000 * SIM_US}};
static const kernel_costs_t slice_costs = {slice_jobs, 2, 0, 0};

static Void yield_in_swi(UArg unused)
{
    (void)unused;
    Task_yield();
}

static int slice_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    waiter("one", 3, sem);
    waiter("two", 3, sem);
    hwi(96, post_sem);
    (void)clock_object(yield_in_swi, 2, 2, TRUE, 0);
    BIOS_start();
    return 0;
}

/* Released at 1500 and 1600. one 1.5-2, two 2-4, one 4-6, two 6-8, one 8-10 (4.5 done), two 10-11 (5 done), one 11-11.5. */
void test_yield_from_a_clock_function_slices_time_between_equals(void)
{
    raise_at_us(1500, 96);
    raise_at_us(1600, 96);
    kernel_boot(slice_main, &slice_costs);
    run_ms(15);
    TEST_ASSERT_EQUAL_STRING("two@11000 one@11500 ", trace);
}

/* ---- rules broken ---- */

enum where { IN_MAIN, IN_TASK, IN_SWI, IN_HWI, IN_CLOCK };

static void (*offence)(void);
static enum where offence_where;

static Void offend_task(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Task_sleep(1);
    offence();
    say("survived");
}

static Void offend_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    offence();
    say("survived");
}

static Void offend_hwi(UArg unused)
{
    (void)unused;
    offence();
    say("survived");
}

static Void idle_function(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
}

static Void event_user(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Event_pend(event, 1, 0, BIOS_WAIT_FOREVER);
}

static Void gate_holder(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)GateMutexPri_enter(gate_b);
    Task_sleep(100);
}

static int offending_main(void)
{
    sem = semaphore(0, Semaphore_Mode_COUNTING);
    sem_b = semaphore(1, Semaphore_Mode_COUNTING);
    event = Event_create(NULL, NULL);
    gate = GateMutexPri_create(NULL, NULL);
    gate_b = GateMutexPri_create(NULL, NULL);
    clk = clock_object(clock_says, 0, 0, FALSE, (UArg) "zero");
    swi_low = swi("offender", 1, offend_swi);
    hwi(96, offend_hwi);
    (void)task("event user", 9, event_user);
    (void)task("gate holder", 9, gate_holder);
    task_a = task("victim", 2, idle_function);
    if (offence_where == IN_MAIN) {
        offence();
        say("survived");
    } else if (offence_where == IN_TASK) {
        (void)task("offender", 5, offend_task);
    } else if (offence_where == IN_SWI) {
        Swi_post(swi_low);
    } else if (offence_where == IN_CLOCK) {
        (void)clock_object(offend_hwi, 1, 0, TRUE, 0);
    }
    BIOS_start();
    return 0;
}

static void pend_forever(void) { (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER); }
static void pend_available(void) { (void)Semaphore_pend(sem_b, 5); }
static void pend_65535(void) { (void)Semaphore_pend(sem_b, 65535); }
static void pend_too_long(void) { (void)Semaphore_pend(sem, 0xFFFFFFFEu); }
static void event_forever(void) { (void)Event_pend(event, 2, 0, BIOS_WAIT_FOREVER); }
static void event_65535(void) { (void)Event_pend(event, 2, 0, 65535); }
static void event_in_use(void) { (void)Event_pend(event, 2, 0, 5); }
static void event_no_mask(void) { (void)Event_pend(event, 0, 0, 5); }
static void event_wide_mask(void) { (void)Event_pend(event, 0, 0x10000, BIOS_NO_WAIT); }
static void event_post_none(void) { Event_post(event, Event_Id_NONE); }
static void event_post_wide(void) { Event_post(event, 0x10000); }
static void sleep_1(void) { Task_sleep(1); }
static void sleep_65535(void) { Task_sleep(65535); }
static void sleep_forever(void) { Task_sleep(BIOS_WAIT_FOREVER); }
static void enter_gate(void) { (void)GateMutexPri_enter(gate); }
static void leave_gate(void) { GateMutexPri_leave(gate, 0); }
static void leave_foreign_gate(void) { GateMutexPri_leave(gate_b, 0); }
static void start_zero_clock(void) { Clock_start(clk); }
static void create_started_zero_clock(void) { (void)clock_object(clock_says, 0, 5, TRUE, 0); }
static void create_long_clock(void) { (void)clock_object(clock_says, 65536, 0, FALSE, 0); }
static void create_task(void) { (void)task("new", 1, idle_function); }
static void create_task_0(void) { (void)task("new", 0, idle_function); }
static void create_task_16(void) { (void)task("new", 16, idle_function); }
static void create_swi(void) { (void)swi("new", 1, offend_swi); }
static void create_swi_16(void) { (void)swi("new", 16, offend_swi); }
static void create_hwi(void) { hwi(97, hwi_function); }
static void create_hwi_0(void) { hwi(0, hwi_function); }
static void create_hwi_16(void) { hwi(16, hwi_function); }
static void create_hwi_31(void) { hwi(31, hwi_function); }
static void create_hwi_224(void) { hwi(224, hwi_function); }
static void create_hwi_negative(void) { hwi(-1, hwi_function); }
static void create_hwi_again(void) { hwi(96, hwi_function); }
static void create_hwi_tick(void) { hwi(38, hwi_function); }
static void create_semaphore(void) { (void)semaphore(0, Semaphore_Mode_BINARY); }
static void create_semaphore_negative(void) { (void)semaphore(-1, Semaphore_Mode_COUNTING); }
static void create_semaphore_32768(void) { (void)semaphore(32768, Semaphore_Mode_COUNTING); }
static void create_event(void) { (void)Event_create(NULL, NULL); }
static void create_clock(void) { (void)clock_object(clock_says, 1, 0, FALSE, 0); }
static void create_gate(void) { (void)GateMutexPri_create(NULL, NULL); }
static void enable_nothing(void) { (void)Hwi_enableInterrupt(97); }
static void enable_out_of_range(void) { (void)Hwi_enableInterrupt(0x600901); } /* INT_SCIA_RX without the shift */
static void plug(void) { Hwi_plug(96, NULL); }
static void enable_ier(void) { (void)Hwi_enableIER(1); }
static void enable_pieier(void) { (void)Hwi_enablePIEIER(9, 1); }
static void pri_0(void) { (void)Task_setPri(task_a, 0); }
static void pri_16(void) { (void)Task_setPri(task_a, 16); }
static void reset_negative(void) { Semaphore_reset(sem, -1); }
static void start_again(void) { BIOS_start(); }
static void raise_nonsense(void) { kernel_raise(224); }
static void system_abort(void) { System_abort("the reason"); }
static void system_exit(void) { System_exit(3); }

static void pend_task_disabled(void)
{
    (void)Task_disable();
    pend_forever();
}

static void pend_swi_disabled(void)
{
    (void)Swi_disable();
    pend_forever();
}

static void event_task_disabled(void)
{
    (void)Task_disable();
    event_forever();
}

static void sleep_task_disabled(void)
{
    (void)Task_disable();
    sleep_1();
}

static void enter_task_disabled(void)
{
    (void)Task_disable();
    (void)GateMutexPri_enter(gate_b);
}

static void leave_twice(void)
{
    IArg key = GateMutexPri_enter(gate);

    GateMutexPri_leave(gate, key);
    GateMutexPri_leave(gate, key);
}

static void leave_out_of_order(void)
{
    IArg key = GateMutexPri_enter(gate);

    (void)GateMutexPri_enter(gate);
    GateMutexPri_leave(gate, key);
}

static void leave_with_a_wrong_key(void)
{
    (void)GateMutexPri_enter(gate);
    GateMutexPri_leave(gate, 1);
}

static void overflow_semaphore(void)
{
    Semaphore_reset(sem, 32767);
    for (long i = 32767; i <= 65535; i++) {
        Semaphore_post(sem);
    }
}

static void create_too_many(void)
{
    for (int i = 0; i < 1000; i++) {
        create_gate();
    }
}

static const struct {
    enum where where;
    void (*offence)(void);
    const char *reason;
} offences[] = {
    {IN_MAIN, pend_forever, "Semaphore_pend: waits outside a Task"},
    {IN_SWI, pend_forever, "Semaphore_pend: with a timeout only from a Task"},
    {IN_HWI, pend_forever, "Semaphore_pend: with a timeout only from a Task"},
    {IN_CLOCK, pend_available, "Semaphore_pend: with a timeout only from a Task"},
    {IN_HWI, pend_available, "Semaphore_pend: with a timeout only from a Task"},
    {IN_TASK, pend_65535, "Semaphore_pend: timeout of 65535 ticks"},
    {IN_TASK, pend_too_long, "Semaphore_pend: timeout of 4294967294 ticks"},
    {IN_TASK, pend_task_disabled, "Semaphore_pend: waits with the scheduler disabled"},
    {IN_TASK, pend_swi_disabled, "Semaphore_pend: waits with the scheduler disabled"},
    {IN_MAIN, event_forever, "Event_pend: waits outside a Task"},
    {IN_SWI, event_forever, "Event_pend: with a timeout only from a Task"},
    {IN_HWI, event_forever, "Event_pend: with a timeout only from a Task"},
    {IN_TASK, event_65535, "Event_pend: timeout of 65535 ticks"},
    {IN_TASK, event_task_disabled, "Event_pend: waits with the scheduler disabled"},
    {IN_TASK, event_in_use, "Event_pend: another task is waiting"},
    {IN_TASK, event_no_mask, "Event_pend: both masks are 0"},
    {IN_TASK, event_wide_mask, "Event_pend: mask does not fit 16 bits"},
    {IN_HWI, event_post_none, "Event_post: no event"},
    {IN_TASK, event_post_wide, "Event_post: mask does not fit 16 bits"},
    {IN_MAIN, sleep_1, "Task_sleep: waits outside a Task"},
    {IN_SWI, sleep_1, "Task_sleep: with a timeout only from a Task"},
    {IN_HWI, sleep_1, "Task_sleep: with a timeout only from a Task"},
    {IN_TASK, sleep_65535, "Task_sleep: timeout of 65535 ticks"},
    {IN_TASK, sleep_forever, "Task_sleep: forever"},
    {IN_TASK, sleep_task_disabled, "Task_sleep: waits with the scheduler disabled"},
    {IN_SWI, enter_gate, "GateMutexPri_enter: not from a Hwi or Swi"},
    {IN_HWI, enter_gate, "GateMutexPri_enter: not from a Hwi or Swi"},
    {IN_SWI, leave_gate, "GateMutexPri_leave: not from a Hwi or Swi"},
    {IN_TASK, leave_gate, "GateMutexPri_leave: the caller does not hold the gate"},
    {IN_TASK, leave_foreign_gate, "GateMutexPri_leave: the caller does not hold the gate"},
    {IN_TASK, leave_twice, "GateMutexPri_leave: the caller does not hold the gate"},
    {IN_TASK, leave_out_of_order, "GateMutexPri_leave: out of order"},
    {IN_TASK, leave_with_a_wrong_key, "GateMutexPri_leave: out of order"},
    {IN_TASK, enter_task_disabled, "GateMutexPri_enter: waits with the scheduler disabled"},
    {IN_TASK, start_zero_clock, "Clock_start: a timeout of 0"},
    {IN_MAIN, create_started_zero_clock, "Clock_create: started with a timeout of 0"},
    {IN_MAIN, create_long_clock, "Clock_create: timeout does not fit 16 bits"},
    {IN_SWI, create_task, "Task_create: not from a Hwi or Swi"},
    {IN_HWI, create_task, "Task_create: not from a Hwi or Swi"},
    {IN_HWI, create_swi, "Swi_create: not from a Hwi or Swi"},
    {IN_SWI, create_hwi, "Hwi_create: not from a Hwi or Swi"},
    {IN_HWI, create_semaphore, "Semaphore_create: not from a Hwi or Swi"},
    {IN_CLOCK, create_event, "Event_create: not from a Hwi or Swi"},
    {IN_HWI, create_clock, "Clock_create: not from a Hwi or Swi"},
    {IN_SWI, create_gate, "GateMutexPri_create: not from a Hwi or Swi"},
    {IN_MAIN, create_task_0, "Task_create: priority out of range"},
    {IN_MAIN, create_task_16, "Task_create: priority out of range"},
    {IN_MAIN, create_swi_16, "Swi_create: priority out of range"},
    {IN_MAIN, create_hwi_0, "Hwi_create: interrupt number out of range"},
    {IN_MAIN, create_hwi_16, "Hwi_create: interrupt number out of range"},
    {IN_MAIN, create_hwi_31, "Hwi_create: interrupt number out of range"},
    {IN_MAIN, create_hwi_224, "Hwi_create: interrupt number out of range"},
    {IN_MAIN, create_hwi_negative, "Hwi_create: interrupt number out of range"},
    {IN_MAIN, create_hwi_again, "Hwi_create: interrupt number already taken"},
    {IN_TASK, create_hwi_tick, "Hwi_create: interrupt number already taken"},
    {IN_MAIN, create_semaphore_negative, "Semaphore_create: count out of range"},
    {IN_MAIN, create_semaphore_32768, "Semaphore_create: count out of range"},
    {IN_TASK, create_too_many, "GateMutexPri_create: no memory"},
    {IN_TASK, enable_nothing, "Hwi_enableInterrupt: no Hwi of this number"},
    {IN_TASK, enable_out_of_range, "Hwi_enableInterrupt: interrupt number out of range"},
    {IN_TASK, plug, "Hwi_plug"},
    {IN_TASK, enable_ier, "Hwi_enableIER"},
    {IN_TASK, enable_pieier, "Hwi_enablePIEIER"},
    {IN_TASK, pri_0, "Task_setPri: priority out of range"},
    {IN_TASK, pri_16, "Task_setPri: priority out of range"},
    {IN_TASK, reset_negative, "Semaphore_reset: count out of range"},
    {IN_TASK, overflow_semaphore, "Semaphore_post: count past 65535"},
    {IN_TASK, start_again, "BIOS_start: only from main()"},
    {IN_HWI, raise_nonsense, "kernel_raise: no such interrupt"},
    {IN_MAIN, system_abort, "System_abort: the reason"},
    {IN_TASK, system_abort, "System_abort: the reason"},
    {IN_SWI, system_abort, "System_abort: the reason"},
    {IN_HWI, system_abort, "System_abort: the reason"},
    {IN_TASK, system_exit, "System_exit: 3"},
};

void test_every_broken_rule_halts_the_system_and_says_why(void)
{
    for (size_t i = 0; i < sizeof offences / sizeof offences[0]; i++) {
        char message[120];

        (void)snprintf(message, sizeof message, "case %zu: %s", i, offences[i].reason);
        setUp();
        offence = offences[i].offence;
        offence_where = offences[i].where;
        if (offence_where == IN_HWI) {
            raise_at_us(1500, 96);
        }
        kernel_boot(offending_main, NULL);
        TEST_ASSERT_FALSE_MESSAGE(kernel_run_until(10 * SIM_MS), message);
        TEST_ASSERT_EQUAL_INT64(10 * SIM_MS, timeline_now());
        TEST_ASSERT_NOT_NULL_MESSAGE(kernel_halt_reason(), message);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(offences[i].reason, kernel_halt_reason(), strlen(offences[i].reason),
                                             message);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", trace, message);
    }
}

static void legal_in_hwi(void)
{
    (void)Semaphore_pend(sem, BIOS_NO_WAIT);
    (void)Semaphore_pend(sem_b, BIOS_NO_WAIT);
    (void)Event_pend(event, 2, 0, BIOS_NO_WAIT);
    Event_post(event, 0x8000);
    Semaphore_post(sem);
    Task_yield();
    Task_sleep(0);
    Clock_stop(clk);
    Clock_setTimeout(clk, 70000);
    Clock_start(clk);
}

static void legal_in_task(void)
{
    UInt key = Task_disable();

    (void)Semaphore_pend(sem_b, 65534); /* available: does not wait */
    (void)GateMutexPri_enter(gate);     /* free */
    Task_restore(key);
    Clock_setTimeout(clk, 65536);       /* UInt32 in this call */
    create_task();
    create_swi();
    create_hwi();
    hwi(1, hwi_function);
    hwi(15, hwi_function);
    hwi(32, hwi_function);
    hwi(223, hwi_function);
}

static void legal_in_main(void)
{
    (void)Semaphore_pend(sem_b, BIOS_WAIT_FOREVER);
    Semaphore_post(sem);
    Event_post(event, 2);
    Swi_post(swi_low);
    Clock_setTimeout(clk, 1);
    Clock_start(clk);
    GateMutexPri_leave(gate, GateMutexPri_enter(gate));
    Task_yield();
    Task_restore(Task_disable());
    Swi_restore(Swi_disable());
    Hwi_restore(Hwi_disable());
}

void test_what_is_allowed_near_the_rules_does_not_halt(void)
{
    const struct {
        enum where where;
        void (*call)(void);
    } calls[] = {{IN_HWI, legal_in_hwi}, {IN_SWI, legal_in_hwi}, {IN_CLOCK, legal_in_hwi}, {IN_TASK, legal_in_task}};

    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
        setUp();
        offence = calls[i].call;
        offence_where = calls[i].where;
        if (offence_where == IN_HWI) {
            raise_at_us(1500, 96);
        }
        kernel_boot(offending_main, NULL);
        run_ms(10);
        TEST_ASSERT_NOT_NULL(strstr(trace, "survived"));
    }
}

static bool first_call;

static void legal_once(void)
{
    if (first_call) {
        first_call = false;
        legal_in_main();
    }
}

void test_main_may_prepare_everything_that_needs_no_scheduler(void)
{
    first_call = true;
    offence = legal_once;
    offence_where = IN_MAIN;
    kernel_boot(offending_main, NULL);
    TEST_ASSERT_EQUAL_STRING("survived@0 ", trace);
    run_ms(3);
    TEST_ASSERT_EQUAL_STRING("survived@0 survived@0 zero@1000 ", trace); /* the Swi posted in main(), then the clock */
}

static int failing_main(void)
{
    Error_Block eb;
    int created = 0;

    Error_init(&eb);
    say("error %d", Error_check(&eb));
    hwi(96, hwi_function);
    say("%d", Hwi_create(96, hwi_function, NULL, &eb) == NULL);
    say("error %d", Error_check(&eb));
    Error_init(&eb);
    while (Semaphore_create(0, NULL, &eb) != NULL) {
        created++;
    }
    say("error %d", Error_check(&eb));
    (void)printf("%d semaphores\n", created);
    Error_init(&eb);
    while (Task_create(idle_function, NULL, &eb) != NULL) {
    }
    say("error %d", Error_check(&eb));
    Error_init(&eb);
    while (Swi_create(offend_swi, NULL, &eb) != NULL) {
    }
    say("error %d", Error_check(&eb));
    Error_init(&eb);
    while (Event_create(NULL, &eb) != NULL) {
    }
    say("error %d", Error_check(&eb));
    Error_init(&eb);
    while (Clock_create(clock_says, 1, NULL, &eb) != NULL) {
    }
    say("error %d", Error_check(&eb));
    BIOS_start();
    return 0;
}

void test_a_failing_create_returns_null_to_a_caller_that_gave_an_error_block(void)
{
    boot_and_run_ms(failing_main, 2);
    TEST_ASSERT_EQUAL_STRING("error 0@0 1@0 error 1@0 error 1@0 error 1@0 error 1@0 error 1@0 error 1@0 ", trace);
}

static int returning_main(void)
{
    return 5;
}

void test_a_main_that_returns_has_halted(void)
{
    kernel_boot(returning_main, NULL);
    TEST_ASSERT_EQUAL_STRING("main() returned 5 without BIOS_start()", kernel_halt_reason());
    TEST_ASSERT_FALSE(kernel_run_until(1 * SIM_MS));
}

static Void ends_locked(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    (void)Task_disable();
}

static int ends_locked_main(void)
{
    (void)task("bad", 3, ends_locked);
    BIOS_start();
    return 0;
}

void test_a_task_that_ends_with_the_scheduler_disabled_halts(void)
{
    kernel_boot(ends_locked_main, NULL);
    TEST_ASSERT_FALSE(kernel_run_until(1 * SIM_MS));
    TEST_ASSERT_EQUAL_STRING("Task \"bad\" ended with the scheduler disabled", kernel_halt_reason());
}

static void world(void *word)
{
    say("%s", (const char *)word);
    kernel_raise(96);
}

void test_after_a_halt_the_world_goes_on_and_the_first_reason_stays(void)
{
    static char name[] = "world";

    (void)timeline_at(1600 * SIM_US, world, name);
    (void)timeline_at(8 * SIM_MS, world, name);
    raise_at_us(1500, 96);
    offence = system_abort;
    offence_where = IN_HWI;
    kernel_boot(offending_main, NULL);
    TEST_ASSERT_TRUE(kernel_run_until(1499 * SIM_US));
    TEST_ASSERT_NULL(kernel_halt_reason());
    TEST_ASSERT_FALSE(kernel_run_until(5 * SIM_MS));
    TEST_ASSERT_FALSE(kernel_run_until(9 * SIM_MS));
    TEST_ASSERT_EQUAL_INT64(9 * SIM_MS, timeline_now());
    TEST_ASSERT_EQUAL_STRING("world@1600 world@8000 ", trace);
    TEST_ASSERT_EQUAL_STRING("System_abort: the reason", kernel_halt_reason());
}

static int fault_calls;

static void fault_hook(void)
{
    fault_calls++;
    say("fault: %s", kernel_halt_reason());
}

TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
TEST_CASE(4)
void test_the_fault_hook_runs_once_at_the_halt_wherever_it_happens(int where)
{
    static const char *const when[] = {"0", "1000", "0", "1500", "1000"};
    char expected[60];

    fault_calls = 0;
    offence = system_abort;
    offence_where = (enum where)where;
    raise_at_us(1500, 96);
    kernel_set_fault_hook(fault_hook);
    kernel_boot(offending_main, NULL);
    TEST_ASSERT_FALSE(kernel_run_until(3 * SIM_MS));
    TEST_ASSERT_FALSE(kernel_run_until(6 * SIM_MS));
    (void)snprintf(expected, sizeof expected, "fault: System_abort: the reason@%s ", when[where]);
    TEST_ASSERT_EQUAL_STRING(expected, trace);
    TEST_ASSERT_EQUAL_INT(1, fault_calls);
}

static void abort_in_gate(void)
{
    (void)GateMutexPri_enter(gate);
    (void)Semaphore_pend(sem, 65535);
}

void test_the_fault_hook_hears_of_a_broken_rule_and_outlives_a_boot(void)
{
    fault_calls = 0;
    offence = abort_in_gate;
    offence_where = IN_TASK;
    kernel_set_fault_hook(fault_hook);
    for (int i = 0; i < 2; i++) {
        kernel_boot(offending_main, NULL);
        TEST_ASSERT_EQUAL_INT(i, fault_calls);
        TEST_ASSERT_FALSE(kernel_run_until(timeline_now() + 3 * SIM_MS));
    }
    TEST_ASSERT_EQUAL_INT(2, fault_calls);
    TEST_ASSERT_NOT_NULL(strstr(trace, "fault: Semaphore_pend: timeout of 65535 ticks"));
}

static void busy_fault_hook(void)
{
    UInt key = Hwi_disable();

    fault_calls++;
    Swi_post(swi_low);
    Semaphore_post(sem_b);
    Hwi_restore(key);
    say("hook");
    System_abort("again");
}

TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
TEST_CASE(4)
void test_a_fault_hook_that_calls_the_kernel_gets_to_its_end_and_wakes_nobody(int where)
{
    fault_calls = 0;
    offence = system_abort;
    offence_where = (enum where)where;
    raise_at_us(1500, 96);
    kernel_set_fault_hook(busy_fault_hook);
    kernel_boot(offending_main, NULL);
    TEST_ASSERT_FALSE(kernel_run_until(6 * SIM_MS));
    TEST_ASSERT_EQUAL_INT(1, fault_calls);
    TEST_ASSERT_EQUAL_STRING_LEN("hook@", trace, 5);
    TEST_ASSERT_NULL(strchr(trace + 5, '@'));
    TEST_ASSERT_EQUAL_STRING("System_abort: the reason", kernel_halt_reason());
}

void test_the_observer_sees_nothing_after_a_halt(void)
{
    raise_at_us(1500, 96);
    raise_at_us(1700, 96);
    offence = system_abort;
    offence_where = IN_HWI;
    kernel_boot(offending_main, NULL);
    (void)kernel_run_until(1400 * SIM_US);
    kernel_observe(observe_all, NULL);
    TEST_ASSERT_FALSE(kernel_run_until(6 * SIM_MS));
    TEST_ASSERT_EQUAL_STRING("R:hwi@1500 D:hwi@1500 ", trace);
}

static int printing_main(void)
{
    say("%d", System_printf("%s %u\n", "printed by the firmware:", 42u));
    System_flush();
    BIOS_start();
    return 0;
}

void test_printf_returns_the_length_and_goes_on(void)
{
    boot_and_run_ms(printing_main, 1);
    TEST_ASSERT_EQUAL_STRING("28@0 ", trace);
}

/* ---- misuse by the board itself ---- */

static bool aborts(void (*misuse)(void))
{
    int status = 0;

    (void)fflush(NULL);
    pid_t child = fork();

    if (child == 0) {
        (void)fclose(stderr);
        (void)signal(SIGABRT, SIG_DFL);
        misuse();
        _exit(0);
    }
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

static void boot_inside(void)
{
    kernel_boot(returning_main, NULL);
}

static void boot_from_a_task(void)
{
    offence = boot_inside;
    offence_where = IN_TASK;
    kernel_boot(offending_main, NULL);
    (void)kernel_run_until(5 * SIM_MS);
}

static void create_from_outside(void)
{
    kernel_boot(returning_main, NULL);
    (void)semaphore(0, Semaphore_Mode_COUNTING);
}

void test_a_board_that_breaks_the_rules_aborts_the_program(void)
{
    TEST_ASSERT_TRUE(aborts(boot_from_a_task));
    TEST_ASSERT_TRUE(aborts(create_from_outside));
    TEST_ASSERT_FALSE(aborts(boot_inside));
}

/* ---- boot ---- */

static int boots_main(void)
{
    (void)clock_object(clock_says, 1, 1, TRUE, (UArg) "tick");
    hwi(96, hwi_function);
    BIOS_start();
    return 0;
}

static void boot_again(void *unused)
{
    (void)unused;
    say("reset");
    kernel_boot(boots_main, NULL);
}

/* As after a watchdog reset: the board boots from an event while virtual time and the world go on. */
void test_a_boot_from_an_event_starts_everything_anew(void)
{
    kernel_boot(boots_main, NULL);
    (void)timeline_at(2500 * SIM_US, boot_again, NULL);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("tick@1000 tick@2000 reset@2500 tick@3500 tick@4500 ", trace);
    TEST_ASSERT_EQUAL_UINT32(2, Clock_getTicks());
}

void test_a_boot_after_a_halt_runs_again_and_forgets_raised_interrupts(void)
{
    for (int i = 0; i < 30; i++) {
        setUp();
        raise_at_us(1500, 96);
        offence = i % 2 == 0 ? system_abort : pend_forever;
        offence_where = i % 3 == 0 ? IN_HWI : IN_TASK;
        kernel_boot(offending_main, NULL);
        (void)kernel_run_until(3 * SIM_MS);
        kernel_raise(96);
        kernel_raise(38);
        kernel_boot(boots_main, NULL);
        TEST_ASSERT_NULL(kernel_halt_reason());
        trace[0] = '\0';
        run_ms(2);
        TEST_ASSERT_EQUAL_STRING("tick@4000 tick@5000 ", trace);
    }
}

/* ---- time ---- */

static int empty_main(void)
{
    BIOS_start();
    return 0;
}

void test_an_idle_system_reaches_the_very_end(void)
{
    kernel_boot(empty_main, NULL);
    TEST_ASSERT_TRUE(kernel_run_until(1234567));
    TEST_ASSERT_EQUAL_INT64(1234567, timeline_now());
    TEST_ASSERT_TRUE(kernel_run_until(1000000)); /* the past: nothing */
    TEST_ASSERT_EQUAL_INT64(1234567, timeline_now());
    TEST_ASSERT_TRUE(kernel_run_until(1234567));
}

static sim_time_t paced[8];
static int paced_count;

static void record_pace(sim_time_t next)
{
    if (paced_count < 8) {
        paced[paced_count++] = next;
    }
    if (next == 1 * SIM_MS && timeline_now() == 0) {
        raise_at_us(400, 96); /* something came in from outside while it waited */
    }
}

void test_the_pacer_is_asked_before_every_move_and_may_add_earlier_events(void)
{
    const sim_time_t expected[] = {1 * SIM_MS, 400 * SIM_US, 900 * SIM_US, 1 * SIM_MS, 1500 * SIM_US};

    paced_count = 0;
    kernel_set_pacer(record_pace);
    kernel_boot(hwi_costs_main, &hwi_costs); /* Hwi 96 takes 500 us */
    TEST_ASSERT_TRUE(kernel_run_until(1500 * SIM_US));
    TEST_ASSERT_EQUAL_INT(5, paced_count);
    TEST_ASSERT_EQUAL_INT64_ARRAY(expected, paced, 5);
    TEST_ASSERT_EQUAL_STRING("hwi 96@900 ", trace);
}

/* ---- a busy system: the same twice, the same in pieces, and never two tasks in one gate ---- */

static noise_t dice;
static uint64_t hash;
static long observed;
static int inside[2], overlaps;
static GateMutexPri_Handle busy_gates[2];
static Semaphore_Handle busy_sems[3];

static void observe_hash(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    (void)context;
    hash = (hash ^ (uint64_t)when) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)what) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)(unsigned char)job->name[0]) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)detail) * 0x100000001B3u;
    observed++;
}

static void use_gate(uint64_t which)
{
    IArg key = GateMutexPri_enter(busy_gates[which]);

    overlaps += inside[which]++ != 0;
    if (noise_bits(&dice) % 4 == 0) {
        IArg nested = GateMutexPri_enter(busy_gates[which]);

        GateMutexPri_leave(busy_gates[which], nested);
    }
    if (which == 0 && noise_bits(&dice) % 4 == 0) { /* always in this order: no deadlock */
        use_gate(1);
    }
    overlaps += --inside[which] != 0;
    GateMutexPri_leave(busy_gates[which], key);
}

static Void busy_task(UArg a0, UArg a1)
{
    (void)a1;
    for (;;) {
        switch (noise_bits(&dice) % 6) {
        case 0:
            Task_sleep((UInt32)(1 + noise_bits(&dice) % 4));
            break;
        case 1:
            (void)Semaphore_pend(busy_sems[a0 % 3], (UInt32)(1 + noise_bits(&dice) % 5));
            break;
        case 2:
            Semaphore_post(busy_sems[noise_bits(&dice) % 3]);
            break;
        case 3:
            use_gate(noise_bits(&dice) % 2);
            break;
        case 4:
            Swi_post(noise_bits(&dice) % 2 == 0 ? swi_low : swi_high);
            break;
        default:
            (void)Event_pend(event, 0, (UInt)1 << a0, BIOS_NO_WAIT);
            Task_sleep(1);
            break;
        }
    }
}

static Void busy_hwi(UArg number)
{
    Semaphore_post(busy_sems[number % 3]);
    Swi_post(swi_mid);
}

static Void busy_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Semaphore_post(busy_sems[noise_bits(&dice) % 3]);
    Event_post(event, 1u << (noise_bits(&dice) % 8));
}

static void busy_world(void *unused)
{
    (void)unused;
    kernel_raise((int)(92 + noise_bits(&dice) % 8));
    (void)timeline_after((sim_time_t)(noise_bits(&dice) % 700000), busy_world, NULL);
}

static const kernel_cost_t busy_jobs[] = {
    {"0", -1, 91 * SIM_US}, {"1", -1, 83 * SIM_US}, {"2", -1, 77 * SIM_US}, {"3", -1, 65 * SIM_US},
    {"4", -1, 51 * SIM_US}, {"low", -1, 21 * SIM_US}, {"mid", -1, 13 * SIM_US}, {"high", -1, 7 * SIM_US},
    {NULL, 38, 4 * SIM_US}, {NULL, 92, 11 * SIM_US}, {NULL, 96, 25 * SIM_US}, {NULL, 99, 3 * SIM_US},
};
static const kernel_costs_t busy_costs = {busy_jobs, 12, 9 * SIM_US, 5 * SIM_US};

static int busy_main(void)
{
    static const char *const names[] = {"0", "1", "2", "3", "4"};

    event = Event_create(NULL, NULL);
    for (int i = 0; i < 3; i++) {
        busy_sems[i] = semaphore(0, i == 0 ? Semaphore_Mode_BINARY : Semaphore_Mode_COUNTING_PRIORITY);
    }
    for (int i = 0; i < 2; i++) {
        busy_gates[i] = GateMutexPri_create(NULL, NULL);
        inside[i] = 0;
    }
    swi_low = swi("low", 1, busy_swi);
    swi_mid = swi("mid", 2, busy_swi);
    swi_high = swi("high", 15, busy_swi);
    for (Int number = 92; number < 100; number++) {
        hwi(number, busy_hwi);
    }
    for (int i = 0; i < 5; i++) {
        Task_Params params;

        Task_Params_init(&params);
        params.instance->name = names[i];
        params.priority = i < 2 ? 1 : 2 * i;
        params.arg0 = (UArg)i;
        (void)Task_create(busy_task, &params, NULL);
    }
    BIOS_start();
    return 0;
}

static uint64_t busy_run(uint64_t seed, sim_time_t piece)
{
    setUp();
    noise_init(&dice, seed, "busy");
    hash = 0xCBF29CE484222325u;
    observed = 0;
    overlaps = 0;
    kernel_observe(observe_hash, NULL);
    (void)timeline_at(0, busy_world, NULL);
    kernel_boot(busy_main, &busy_costs);
    for (sim_time_t end = piece; timeline_now() < 2 * SIM_S; end += piece) {
        TEST_ASSERT_TRUE_MESSAGE(kernel_run_until(end < 2 * SIM_S ? end : 2 * SIM_S), kernel_halt_reason());
    }
    return hash;
}

void test_a_busy_system_repeats_itself_and_does_not_depend_on_how_it_is_run(void)
{
    for (uint64_t seed = 1; seed <= 5; seed++) {
        uint64_t first = busy_run(seed, 2 * SIM_S);
        long first_observed = observed;

        TEST_ASSERT_GREATER_THAN(50000, first_observed);
        TEST_ASSERT_EQUAL_INT(0, overlaps);
        TEST_ASSERT_EQUAL_HEX64(first, busy_run(seed, 2 * SIM_S));
        TEST_ASSERT_EQUAL_HEX64(first, busy_run(seed, 333333));
        TEST_ASSERT_EQUAL_INT(first_observed, observed);
    }
    TEST_ASSERT_TRUE(busy_run(1, 2 * SIM_S) != busy_run(2, 2 * SIM_S));
}

/* ---- an independent look at the trace of the busy system ---- */

static struct {
    char name[8];
    sim_time_t used;    /* processor time */
    long released, finished;
} accounts[24];
static int account_count;
static int running_account;
static sim_time_t running_since;
static int holders;

static int account_of(const char *name, int detail, bool is_hwi)
{
    char key[8];

    (void)snprintf(key, sizeof key, is_hwi ? "%.3s%d" : "%.6s", is_hwi ? "h" : name, detail);
    for (int i = 0; i < account_count; i++) {
        if (strcmp(accounts[i].name, key) == 0) {
            return i;
        }
    }
    (void)snprintf(accounts[account_count].name, sizeof accounts[0].name, "%s", key);
    return account_count++;
}

static void observe_accounts(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job, int detail)
{
    int account = account_of(job->name, job->number, strcmp(job->name, "hwi") == 0);

    (void)context;
    (void)detail;
    if (what == KERNEL_RELEASED) {
        accounts[account].released++;
    } else if (what == KERNEL_DISPATCHED) {
        holders += running_account >= 0;
        running_account = account;
        running_since = when;
    } else if (what == KERNEL_PREEMPTED || what == KERNEL_FINISHED || what == KERNEL_GATE_BLOCKED) {
        holders += running_account != account;
        accounts[account].used += when - running_since;
        accounts[account].finished += what == KERNEL_FINISHED;
        running_account = -1;
    }
}

/* At any time one job has the processor, and what Swis and Hwis used is their number of runs times their cost. */
void test_processor_time_is_accounted_for_to_the_nanosecond(void)
{
    static const struct {
        const char *name;
        sim_time_t cost;
    } fixed[] = {{"low", 21 * SIM_US}, {"mid", 13 * SIM_US}, {"high", 7 * SIM_US}, {"h92", 11 * SIM_US},
                 {"h96", 25 * SIM_US}, {"h99", 3 * SIM_US}, {"h97", 0}, {"Clock", 4 * SIM_US}};

    setUp();
    memset(accounts, 0, sizeof accounts);
    account_count = 0;
    running_account = -1;
    holders = 0;
    noise_init(&dice, 99, "busy");
    kernel_observe(observe_accounts, NULL);
    (void)timeline_at(0, busy_world, NULL);
    kernel_boot(busy_main, &busy_costs);
    run_ms(2000);
    kernel_observe(NULL, NULL);
    TEST_ASSERT_EQUAL_INT(0, holders);
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        int account = account_of(fixed[i].name, 0, false);

        TEST_ASSERT_GREATER_THAN_MESSAGE(100, accounts[account].finished, fixed[i].name);
        TEST_ASSERT_INT64_WITHIN_MESSAGE((uint64_t)fixed[i].cost, accounts[account].finished * fixed[i].cost,
                                         accounts[account].used, fixed[i].name); /* one may be under way */
        TEST_ASSERT_INT_WITHIN_MESSAGE(1, accounts[account].released, accounts[account].finished, fixed[i].name);
    }
}
