/* Gates: order, nesting, inherited priority. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

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
    TEST_ASSERT_EQUAL_STRING(
        "holder in@0 high in@5000 high out@5000 mid in@5000 mid out@5000 low1 in@5000 low1 out@5000 "
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
    TEST_ASSERT_EQUAL_STRING(
        "[low 9 of 1]@2000 low@3000 [low 1 of 1]@3000 high@3000 mid@3000 low again low@3000 ", trace);
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
    TEST_ASSERT_EQUAL_STRING(
        "[c 2]@1000 [b 9]@2000 [c 9]@2000 c@4000 b@4000 b left one@4000 a@4000 a out@4000 mid@4000 "
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
    TEST_ASSERT_EQUAL_STRING(
        "holder in@0 [holder 3]@1000 [holder 12]@4000 set@4000 second in@5000 second out@5000 "
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

/* TI's gate restores the priority that its owner had on entering it, whoever waits for another gate of the
 * owner's. */
void test_leaving_an_inner_gate_loses_what_is_inherited_through_the_outer_one(void)
{
    boot_and_run_ms(two_gates_main, 1);
    TEST_ASSERT_EQUAL_STRING("wants@0 mid@0 low@0 has@0 low out@0 ", trace);
}
