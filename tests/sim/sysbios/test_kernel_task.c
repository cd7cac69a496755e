/* Tasks: start, order, priority, the lock. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

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

void test_the_observer_sees_a_priority_set(void)
{
    kernel_observe(observe_changes, NULL);
    boot_and_run_ms(pri_main, 1);
    TEST_ASSERT_EQUAL_STRING("[b 9 of 9]@0 b@0 was 2@0 raised b@0 [a 1 of 1]@0 c@0 was 5@0 lowered a@0 d@0 ",
                             trace);
}
