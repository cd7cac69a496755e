/* What a job costs, and what the observer sees of it: virtual times computed by hand. */
#include "tests/sim/sysbios/kernel_helper.h"

#include <inttypes.h>
#include <string.h>

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

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
    {"Low", -1, 1000 * SIM_US}, {"High", -1, 300 * SIM_US}, {"Swi", -1, 50 * SIM_US},
    {NULL, 38, 4 * SIM_US},     {NULL, 96, 20 * SIM_US},    {NULL, 97, 10 * SIM_US},
};
static const kernel_costs_t preemption_costs = {
    preemption_jobs, sizeof preemption_jobs / sizeof preemption_jobs[0], 0, 57 * SIM_US};

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

/* 1500 Hwi 96 is raised, done 1520. Swi until 1570. Low needs 57 + 1000 = 1057; 430 done at 2000, when the
 * tick takes 4. 2004 Low; 96 more = 526 done at 2100. Hwi 97 until 2110. High needs 57 + 300 = 357: done at
 * 2467. Low's last 531: done at 2998, before the next tick. */
void test_costs_are_consumed_preemptibly_before_the_code_runs(void)
{
    raise_at_us(1500, 96);
    raise_at_us(2100, 97);
    kernel_boot(preemption_main, &preemption_costs);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("hwi@1520 swi@1570 hwi b@2110 High@2467 Low@2998 ", trace);
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
    TEST_ASSERT_EQUAL_STRING(
        "R:hwi@1500 D:hwi@1500 hwi@1520 R:Swi@1520 F:hwi@1520 D:Swi@1520 swi@1570 R:Low@1570 "
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

static void observe_responses(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                              int detail)
{
    (void)context;
    (void)detail;
    if (what == KERNEL_FINISHED && strncmp(job->name, "Clock", 5) != 0) {
        say("%s%d %" PRId64, job->name, job->number, (when - job->released) / SIM_US);
    }
}

static const kernel_cost_t response_jobs[] = {
    {"t", -1, 400 * SIM_US}, {"s", -1, 100 * SIM_US}, {NULL, 96, 10 * SIM_US},
    {NULL, 97, 20 * SIM_US}, {NULL, 98, 30 * SIM_US},
};
static const kernel_costs_t response_costs = {response_jobs, sizeof response_jobs / sizeof response_jobs[0],
                                              0, 0};

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

/* 200 Hwi 96; the Swi has done 90 of 100 when Hwi 97 comes at 300 and posts it anew at 320; it ends at 330
 * and again at 430. The task is released at 330 and, with nothing done, at 430: jobs of 400 end at 830 and
 * 1230. */
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
    TEST_ASSERT_EQUAL_STRING("hwi96 10@210 hwi97 20@320 s1 120@330 s1 110@430 t0 500@830 t0 800@1230 ",
                             trace);
}

/* Hwi 98 ends at 230 with three posts; the Swi until 330 brings a fourth. Jobs end at 730, 1130, 1530, 1930:
 * released 230, 230 (it waited), 730 (the job ahead of it began), 1130. */
void test_posts_behind_one_another_are_released_when_the_job_ahead_begins(void)
{
    response_mode = Semaphore_Mode_COUNTING;
    response_task = pends_semaphore;
    raise_at_us(200, 98);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi98 30@230 s1 100@330 t0 500@730 t0 900@1130 t0 800@1530 t0 800@1930 ",
                             trace);
}

static const char *const kind_names[] = {"hwi", "swi", "task"};

static void observe_identities(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                               int detail)
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

/* 200 Hwi 96, Swi until 310: flag 1 ends the wait, and flag 2 is there already, both posted at 310; jobs
 * until 710 and 1110 + 110, because at 800 Hwi 96 and the Swi come again, with both flags at 910. Jobs until
 * 1620 and 2020 for them. */
void test_flags_posted_together_are_released_together(void)
{
    response_task = pends_in_turn;
    raise_at_us(200, 96);
    raise_at_us(800, 96);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING(
        "hwi96 10@210 s1 100@310 t0 400@710 hwi96 10@810 s1 100@910 t0 910@1220 t0 710@1620 "
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

/* Flags 1 and 2 at 310; job until 710; the sleep ends at 1000, job until 1400; flag 2 is older than the
 * sleep's end. */
void test_a_flag_that_nobody_waited_for_releases_when_it_is_asked_for(void)
{
    response_task = pends_late;
    raise_at_us(200, 96);
    observe_responses_from_100_us();
    TEST_ASSERT_EQUAL_STRING("hwi96 10@210 s1 100@310 t0 400@710 t0 400@1400 t0 400@1800 ", trace);
}

static const kernel_cost_t label_jobs[] = {
    {"label", 96, 5 * SIM_US},
    {"other label", 97, 5 * SIM_US},
    {"label", -1, 100 * SIM_US},
    {NULL, 98, 5 * SIM_US},
};
static const kernel_costs_t label_costs = {label_jobs, sizeof label_jobs / sizeof label_jobs[0], 0, 0};

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
    TEST_ASSERT_EQUAL_STRING(
        "hwi:label:96:96:96@500 task:label:1:7:7@505 hwi:own name:97:97:97@700 hwi 0@705 "
        "hwi::98:98:98@800 hwi 0@805 hwi:Clock:38:38:38@1000 swi:Clock_swi:0:15:15@1000 ",
        trace);
}

/* 98 begins at 1400 and is not preempted: done 1430. 96 until 1930; in the meantime 97 and 98 rise, and 96
 * again, twice: one is latched. 96 again until 2430 (its number goes first), 97 until 2530, 98 until 2560. */
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
    {"low", -1, 400 * SIM_US},
    {"high", -1, 100 * SIM_US},
    {NULL, 96, 10 * SIM_US},
    {NULL, 97, 10 * SIM_US},
};
static const kernel_costs_t swi_costs = {swi_jobs, sizeof swi_jobs / sizeof swi_jobs[0], 0, 0};

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

/* Hwi 96 until 110, low begins: 400. 200 Hwi 97, high 210 to 310. 320 Hwi 96 posts low again, which has
 * begun, so that it runs once more. low used 90 until 200, 10 from 310 to 320, the last 300 from 330 to 630;
 * again until 1030. */
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

/* Low is released at 1000, switches 10, enters at 1010 and pays 100 with the gate held; 40 of it at 1050.
 * High switches 10 and finds the gate taken at 1060. Mid is ready at 1065. Low, at 9 now, pays its last 60:
 * in at 1120, and leaves. High switches again and pays its access: 1230. Mid 1240, then low. */
void test_gate_access_costs_time_while_the_gate_is_held_and_a_blocking_costs_two_switches(void)
{
    raise_at_us(1050, 96);
    raise_at_us(1065, 97);
    kernel_boot(costly_gate_main, &gate_costs);
    kernel_observe(observe_priorities, NULL);
    run_ms(3);
    TEST_ASSERT_EQUAL_STRING(
        "high wants@1060 [low 9]@1060 hwi b@1065 low in@1120 high in@1230 mid@1240 low out@1240 ", trace);
}

static void observe_gates(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                          int detail)
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
    TEST_ASSERT_EQUAL_STRING(
        "E:low:0@1010 high wants@1060 B:high:0@1060 low in@1120 L:low:0@1120 E:high:0@1120 "
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
static const kernel_costs_t wait_costs = {wait_jobs, sizeof wait_jobs / sizeof wait_jobs[0], 0, 50 * SIM_US};

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
    say("%d", Semaphore_pend(sem, 1));          /* until tick 2 */
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
    TEST_ASSERT_EQUAL_STRING(
        "a@1000 ticks 5@5500 a@5500 b@5500 a@5500 a@5500 b@5500 a@5500 open@5500 a@6000 b@6000 ", trace);
}

static const kernel_cost_t slice_jobs[] = {{"one", -1, 5000 * SIM_US}, {"two", -1, 5000 * SIM_US}};
static const kernel_costs_t slice_costs = {slice_jobs, sizeof slice_jobs / sizeof slice_jobs[0], 0, 0};

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

/* Released at 1500 and 1600. one 1.5-2, two 2-4, one 4-6, two 6-8, one 8-10 (4.5 done), two 10-11 (5 done),
 * one 11-11.5. */
void test_yield_from_a_clock_function_slices_time_between_equals(void)
{
    raise_at_us(1500, 96);
    raise_at_us(1600, 96);
    kernel_boot(slice_main, &slice_costs);
    run_ms(15);
    TEST_ASSERT_EQUAL_STRING("two@11000 one@11500 ", trace);
}
