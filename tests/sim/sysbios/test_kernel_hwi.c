/* Hardware interrupts. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

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

/* Each that is taken lets in the next of another group at once: so the last one taken ends first. */
void test_waiting_hwis_are_taken_by_number_and_go_before_swis_and_tasks(void)
{
    const int numbers[] = {98, 97, 223, 92, 15, 97, 1, 32, 92};

    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        raise_at_us(500, numbers[i]); /* 97 and 92 twice: latched once */
    }
    boot_and_run_ms(hwi_order_main, 1);
    TEST_ASSERT_EQUAL_STRING(
        "hwi 223@500 hwi 97@500 hwi 98@500 hwi 92@500 hwi ends@500 hwi 15@500 hwi 1@500 hwi 32@500 "
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

/* 40 is of PIE group 2, 92 of group 8, 96 and 98 of group 9. */
static const kernel_cost_t nesting_jobs[] = {
    {NULL, 40, 100 * SIM_US}, {NULL, 92, 100 * SIM_US}, {NULL, 96, 100 * SIM_US}, {NULL, 98, 100 * SIM_US}};
static const kernel_costs_t nesting_costs = {.jobs = nesting_jobs, .job_count = 4};

static int nesting_main(void)
{
    hwi(40, hwi_function);
    hwi(92, hwi_function);
    hwi(96, hwi_function);
    hwi(98, hwi_function);
    BIOS_start();
    return 0;
}

void test_a_hwi_interrupts_one_of_another_pie_group_whatever_its_number(void)
{
    raise_at_us(200, 92);
    raise_at_us(250, 96); /* group 9 in group 8 */
    raise_at_us(260, 40); /* group 2 in both */
    kernel_boot(nesting_main, &nesting_costs);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("hwi 40@360 hwi 96@450 hwi 92@500 ", trace);
}

void test_a_hwi_waits_for_one_of_its_own_pie_group(void)
{
    raise_at_us(200, 98);
    raise_at_us(250, 96);
    kernel_boot(nesting_main, &nesting_costs);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("hwi 98@300 hwi 96@400 ", trace);
}

void test_of_two_that_are_raised_at_once_the_lower_number_goes_first_and_is_interrupted(void)
{
    raise_at_us(200, 40);
    raise_at_us(200, 96);
    raise_at_us(200, 98);
    kernel_boot(nesting_main, &nesting_costs);
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("hwi 96@300 hwi 98@400 hwi 40@500 ", trace);
}
