/* The end of a run, and the pacer. */
#include "tests/sim/sysbios/kernel_helper.h"

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

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
