/* Rules broken: the system halts and says why. Then the fault hook, misuse by the board, and the next boot.
 */
#include "tests/sim/sysbios/kernel_helper.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <xdc/runtime/Error.h>
#include <xdc/runtime/System.h>

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
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

static void pend_forever(void)
{
    (void)Semaphore_pend(sem, BIOS_WAIT_FOREVER);
}
static void pend_available(void)
{
    (void)Semaphore_pend(sem_b, 5);
}
static void pend_65535(void)
{
    (void)Semaphore_pend(sem_b, 65535);
}
static void pend_too_long(void)
{
    (void)Semaphore_pend(sem, 0xFFFFFFFEu);
}
static void event_forever(void)
{
    (void)Event_pend(event, 2, 0, BIOS_WAIT_FOREVER);
}
static void event_65535(void)
{
    (void)Event_pend(event, 2, 0, 65535);
}
static void event_in_use(void)
{
    (void)Event_pend(event, 2, 0, 5);
}
static void event_no_mask(void)
{
    (void)Event_pend(event, 0, 0, 5);
}
static void event_wide_mask(void)
{
    (void)Event_pend(event, 0, 0x10000, BIOS_NO_WAIT);
}
static void event_post_none(void)
{
    Event_post(event, Event_Id_NONE);
}
static void event_post_wide(void)
{
    Event_post(event, 0x10000);
}
static void sleep_1(void)
{
    Task_sleep(1);
}
static void sleep_65535(void)
{
    Task_sleep(65535);
}
static void sleep_forever(void)
{
    Task_sleep(BIOS_WAIT_FOREVER);
}
static void enter_gate(void)
{
    (void)GateMutexPri_enter(gate);
}
static void leave_gate(void)
{
    GateMutexPri_leave(gate, 0);
}
static void leave_foreign_gate(void)
{
    GateMutexPri_leave(gate_b, 0);
}
static void start_zero_clock(void)
{
    Clock_start(clk);
}
static void create_started_zero_clock(void)
{
    (void)clock_object(clock_says, 0, 5, TRUE, 0);
}
static void create_long_clock(void)
{
    (void)clock_object(clock_says, 65536, 0, FALSE, 0);
}
static void create_task(void)
{
    (void)task("new", 1, idle_function);
}
static void create_task_0(void)
{
    (void)task("new", 0, idle_function);
}
static void create_task_16(void)
{
    (void)task("new", 16, idle_function);
}
static void create_swi(void)
{
    (void)swi("new", 1, offend_swi);
}
static void create_swi_16(void)
{
    (void)swi("new", 16, offend_swi);
}
static void create_hwi(void)
{
    hwi(97, hwi_function);
}
static void create_hwi_0(void)
{
    hwi(0, hwi_function);
}
static void create_hwi_16(void)
{
    hwi(16, hwi_function);
}
static void create_hwi_31(void)
{
    hwi(31, hwi_function);
}
static void create_hwi_224(void)
{
    hwi(224, hwi_function);
}
static void create_hwi_negative(void)
{
    hwi(-1, hwi_function);
}
static void create_hwi_again(void)
{
    hwi(96, hwi_function);
}
static void create_hwi_tick(void)
{
    hwi(38, hwi_function);
}
static void create_semaphore(void)
{
    (void)semaphore(0, Semaphore_Mode_BINARY);
}
static void create_semaphore_negative(void)
{
    (void)semaphore(-1, Semaphore_Mode_COUNTING);
}
static void create_semaphore_32768(void)
{
    (void)semaphore(32768, Semaphore_Mode_COUNTING);
}
static void create_event(void)
{
    (void)Event_create(NULL, NULL);
}
static void create_clock(void)
{
    (void)clock_object(clock_says, 1, 0, FALSE, 0);
}
static void create_gate(void)
{
    (void)GateMutexPri_create(NULL, NULL);
}
static void enable_nothing(void)
{
    (void)Hwi_enableInterrupt(97);
}
static void enable_out_of_range(void)
{
    (void)Hwi_enableInterrupt(0x600901);
} /* INT_SCIA_RX without the shift */
static void plug(void)
{
    Hwi_plug(96, NULL);
}
static void enable_ier(void)
{
    (void)Hwi_enableIER(1);
}
static void enable_pieier(void)
{
    (void)Hwi_enablePIEIER(9, 1);
}
static void pri_0(void)
{
    (void)Task_setPri(task_a, 0);
}
static void pri_16(void)
{
    (void)Task_setPri(task_a, 16);
}
static void reset_negative(void)
{
    Semaphore_reset(sem, -1);
}
static void start_again(void)
{
    BIOS_start();
}
static void raise_nonsense(void)
{
    kernel_raise(224);
}
static void system_abort(void)
{
    System_abort("the reason");
}
static void system_exit(void)
{
    System_exit(3);
}

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
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(offences[i].reason, kernel_halt_reason(),
                                             strlen(offences[i].reason), message);
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
    Clock_setTimeout(clk, 65536); /* UInt32 in this call */
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
    } calls[] = {
        {IN_HWI, legal_in_hwi}, {IN_SWI, legal_in_hwi}, {IN_CLOCK, legal_in_hwi}, {IN_TASK, legal_in_task}};

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
    TEST_ASSERT_EQUAL_STRING("survived@0 survived@0 zero@1000 ",
                             trace); /* the Swi posted in main(), then the clock */
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
    TEST_ASSERT_EQUAL_STRING("error 0@0 1@0 error 1@0 error 1@0 error 1@0 error 1@0 error 1@0 error 1@0 ",
                             trace);
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
