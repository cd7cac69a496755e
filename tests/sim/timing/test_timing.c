#include "sim/timing/timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

static kernel_job_t hwi = {KERNEL_HWI, "SCIA_RX", 96, 96, 0};
static kernel_job_t swi = {KERNEL_SWI, "Laser_SWI", 1, 2, 0};
static kernel_job_t low = {KERNEL_TASK, "low", 0, 1, 0};
static kernel_job_t mid = {KERNEL_TASK, "mid", 1, 4, 0};
static kernel_job_t high = {KERNEL_TASK, "high", 2, 6, 0};

static const timing_limits_t limits[] = {
    {"high", 500 * SIM_US, 1000 * SIM_US, 20 * SIM_US, 1},
    {"low", SIM_NEVER, 3000 * SIM_US, SIM_NEVER, -1},
};
static timing_t timing;

void setUp(void)
{
    timeline_reset();
    timing_init(&timing, limits, 2);
    hwi.released = 0;
    swi.released = 0;
}

void tearDown(void) {}

static void at_us(sim_time_t when, kernel_event_t event, kernel_job_t *job)
{
    if (event == KERNEL_RELEASED) {
        job->released = when * SIM_US;
    }
    timing_observe(&timing, when * SIM_US, event, job, 0);
}

static void conclude_at_us(sim_time_t when)
{
    timeline_move_to(when * SIM_US);
    timing_conclude(&timing);
}

static int broken(char *text, size_t size)
{
    FILE *out = tmpfile();
    int count = timing_print_broken(&timing, out);

    rewind(out);
    text[fread(text, 1, size - 1, out)] = '\0';
    (void)fclose(out);
    return count;
}

static void assert_broken(const char *expected, int count)
{
    char text[400];

    TEST_ASSERT_EQUAL_INT(count, broken(text, sizeof text));
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* low 100-, high released 150, runs 150-400 with a Hwi 200-210 in it, low goes on 400-600. */
static void undisturbed(void)
{
    at_us(100, KERNEL_RELEASED, &low);
    at_us(100, KERNEL_DISPATCHED, &low);
    at_us(150, KERNEL_RELEASED, &high);
    at_us(150, KERNEL_PREEMPTED, &low);
    at_us(150, KERNEL_DISPATCHED, &high);
    at_us(200, KERNEL_RELEASED, &hwi);
    at_us(200, KERNEL_PREEMPTED, &high);
    at_us(200, KERNEL_DISPATCHED, &hwi);
    at_us(210, KERNEL_FINISHED, &hwi);
    at_us(210, KERNEL_DISPATCHED, &high);
    at_us(400, KERNEL_FINISHED, &high);
    at_us(400, KERNEL_DISPATCHED, &low);
    at_us(600, KERNEL_FINISHED, &low);
}

void test_responses_go_from_release_to_finish_and_use_counts_running_alone(void)
{
    undisturbed();
    conclude_at_us(1000);
    TEST_ASSERT_EQUAL_INT64(500 * SIM_US, timing_find(&timing, "low")->longest_response);
    TEST_ASSERT_EQUAL_INT64(100 * SIM_US, timing_find(&timing, "low")->longest_since);
    TEST_ASSERT_EQUAL_INT64(250 * SIM_US, timing_find(&timing, "low")->used);
    TEST_ASSERT_EQUAL_INT64(250 * SIM_US, timing_find(&timing, "high")->longest_response);
    TEST_ASSERT_EQUAL_INT64(240 * SIM_US, timing_find(&timing, "high")->used);
    TEST_ASSERT_EQUAL_INT64(10 * SIM_US, timing_find(&timing, "SCIA_RX")->used);
    TEST_ASSERT_EQUAL_INT(1, timing_find(&timing, "high")->jobs);
    TEST_ASSERT_NULL(timing_find(&timing, "mid"));
    assert_broken("", 0);
}

void test_the_longest_response_is_kept_with_its_release(void)
{
    undisturbed();
    at_us(2000, KERNEL_RELEASED, &high);
    at_us(2000, KERNEL_DISPATCHED, &high);
    at_us(2300, KERNEL_FINISHED, &high);
    at_us(3000, KERNEL_RELEASED, &high);
    at_us(3000, KERNEL_DISPATCHED, &high);
    at_us(3299, KERNEL_FINISHED, &high);
    TEST_ASSERT_EQUAL_INT64(300 * SIM_US, timing_find(&timing, "high")->longest_response);
    TEST_ASSERT_EQUAL_INT64(2000 * SIM_US, timing_find(&timing, "high")->longest_since);
    TEST_ASSERT_EQUAL_INT(3, timing_find(&timing, "high")->jobs);
}

void test_lower_tasks_before_it_are_interference_and_not_inversion_until_released(void)
{
    undisturbed();
    TEST_ASSERT_EQUAL_INT64(0, timing_find(&timing, "high")->longest_inversion);
    TEST_ASSERT_EQUAL_INT64(0, timing_find(&timing, "low")->longest_inversion);
}

/* high waits at a gate that low holds: 110-120 low runs, 120-150 a Hwi, 150-160 low again; then high, 57 for
 * its switches. */
static void one_blocking(void)
{
    at_us(90, KERNEL_RELEASED, &low);
    at_us(90, KERNEL_DISPATCHED, &low);
    at_us(95, KERNEL_GATE_ENTERED, &low);
    at_us(100, KERNEL_RELEASED, &high);
    at_us(100, KERNEL_PREEMPTED, &low);
    at_us(100, KERNEL_DISPATCHED, &high);
    at_us(110, KERNEL_GATE_BLOCKED, &high);
    at_us(110, KERNEL_PRIORITY, &low);
    at_us(110, KERNEL_DISPATCHED, &low);
    at_us(120, KERNEL_RELEASED, &hwi);
    at_us(120, KERNEL_PREEMPTED, &low);
    at_us(120, KERNEL_DISPATCHED, &hwi);
    at_us(150, KERNEL_FINISHED, &hwi);
    at_us(150, KERNEL_DISPATCHED, &low);
    at_us(160, KERNEL_GATE_LEFT, &low);
    at_us(160, KERNEL_GATE_ENTERED, &high);
    at_us(160, KERNEL_PREEMPTED, &low);
    at_us(160, KERNEL_DISPATCHED, &high);
    at_us(217, KERNEL_GATE_LEFT, &high);
    at_us(217, KERNEL_FINISHED, &high);
    at_us(217, KERNEL_DISPATCHED, &low);
}

void test_inversion_is_what_a_lower_task_ran_and_a_gate_wait_is_all_of_it(void)
{
    one_blocking();
    TEST_ASSERT_EQUAL_INT64(20 * SIM_US, timing_find(&timing, "high")->longest_inversion);
    TEST_ASSERT_EQUAL_INT64(50 * SIM_US, timing_find(&timing, "high")->longest_wait);
    TEST_ASSERT_EQUAL_INT(1, timing_find(&timing, "high")->most_blockings);
    TEST_ASSERT_EQUAL_INT(0, timing_find(&timing, "low")->most_blockings);
    assert_broken("", 0);
}

/* Nobody waits at a gate, but low runs at a raised priority while mid is ready. */
void test_inversion_counts_for_every_ready_task_between(void)
{
    at_us(10, KERNEL_RELEASED, &low);
    at_us(10, KERNEL_DISPATCHED, &low);
    at_us(20, KERNEL_RELEASED, &mid);
    at_us(45, KERNEL_PREEMPTED, &low);
    at_us(45, KERNEL_DISPATCHED, &mid);
    at_us(50, KERNEL_FINISHED, &mid);
    TEST_ASSERT_EQUAL_INT64(25 * SIM_US, timing_find(&timing, "mid")->longest_inversion);
}

void test_inversions_of_one_job_add_up_and_the_next_job_begins_with_none(void)
{
    at_us(10, KERNEL_RELEASED, &low);
    at_us(10, KERNEL_DISPATCHED, &low);
    for (int i = 0; i < 2; i++) {
        at_us(100 + 100 * i, KERNEL_RELEASED, &high);
        at_us(115 + 100 * i, KERNEL_PREEMPTED, &low);
        at_us(115 + 100 * i, KERNEL_DISPATCHED, &high);
        at_us(120 + 100 * i, KERNEL_GATE_BLOCKED, &high);
        at_us(120 + 100 * i, KERNEL_DISPATCHED, &low);
        at_us(130 + 100 * i, KERNEL_GATE_ENTERED, &high);
        at_us(130 + 100 * i, KERNEL_PREEMPTED, &low);
        at_us(130 + 100 * i, KERNEL_DISPATCHED, &high);
        at_us(140 + 100 * i, KERNEL_FINISHED, &high);
        at_us(140 + 100 * i, KERNEL_DISPATCHED, &low);
    }
    TEST_ASSERT_EQUAL_INT64(25 * SIM_US, timing_find(&timing, "high")->longest_inversion);
    assert_broken("BROKEN: high: priority inversion of 0.0250 ms, at most 0.0200\n", 1);
}

void test_waits_at_gates_are_counted_within_a_job(void)
{
    at_us(10, KERNEL_RELEASED, &high);
    for (int i = 0; i < 2; i++) {
        at_us(10 + 10 * i, KERNEL_DISPATCHED, &high);
        at_us(11 + 10 * i, KERNEL_GATE_BLOCKED, &high);
        at_us(12 + 10 * i, KERNEL_GATE_ENTERED, &high);
    }
    at_us(40, KERNEL_DISPATCHED, &high);
    at_us(41, KERNEL_FINISHED, &high);
    assert_broken("BROKEN: high: 2 waits at gates in one job, at most 1\n", 1);
}

void test_a_limit_is_kept_up_to_its_very_value(void)
{
    at_us(0, KERNEL_RELEASED, &high);
    at_us(0, KERNEL_DISPATCHED, &high);
    at_us(500, KERNEL_FINISHED, &high);
    assert_broken("", 0);
    at_us(1000, KERNEL_RELEASED, &high);
    at_us(1000, KERNEL_DISPATCHED, &high);
    timing_observe(&timing, 1500 * SIM_US + 1, KERNEL_FINISHED, &high, 0);
    TEST_ASSERT_EQUAL_INT(0, timing_find(&timing, "high")->late);
    assert_broken("BROKEN: high: response of 0.5000 ms, at most 0.5000\n", 1);
}

void test_every_late_job_counts(void)
{
    for (int i = 0; i < 3; i++) {
        at_us(10000 * i, KERNEL_RELEASED, &low);
        at_us(10000 * i, KERNEL_DISPATCHED, &low);
        at_us(10000 * i + 2999 + i, KERNEL_FINISHED, &low); /* 2999, 3000, 3001 of 3000 */
    }
    assert_broken("BROKEN: low: 1 missed deadlines, at most 0\n", 1);
}

void test_a_job_that_never_ends_is_late_at_the_end(void)
{
    at_us(0, KERNEL_RELEASED, &low);
    at_us(2000, KERNEL_RELEASED, &high);
    at_us(2000, KERNEL_DISPATCHED, &high);
    conclude_at_us(3001);
    assert_broken("BROKEN: low: 1 missed deadlines, at most 0\nBROKEN: high: 1 missed deadlines, at most 0\n",
                  2);
    TEST_ASSERT_EQUAL_INT64(1001 * SIM_US, timing_find(&timing, "high")->used);
}

void test_a_job_that_waits_within_its_deadline_at_the_end_is_not_late(void)
{
    at_us(0, KERNEL_RELEASED, &low);
    conclude_at_us(3000);
    assert_broken("", 0);
}

void test_a_swi_that_was_posted_again_counts_from_its_own_release(void)
{
    swi.released = 100 * SIM_US;
    timing_observe(&timing, 100 * SIM_US, KERNEL_RELEASED, &swi, 2);
    timing_observe(&timing, 110 * SIM_US, KERNEL_DISPATCHED, &swi, 2);
    timing_observe(&timing, 150 * SIM_US, KERNEL_RELEASED, &swi, 2); /* the one in hand keeps its own */
    timing_observe(&timing, 160 * SIM_US, KERNEL_FINISHED, &swi, 2);
    TEST_ASSERT_EQUAL_INT64(60 * SIM_US, timing_find(&timing, "Laser_SWI")->longest_response);
}

static void report(char *text, size_t size)
{
    FILE *out = tmpfile();

    timing_print(&timing, out);
    rewind(out);
    text[fread(text, 1, size - 1, out)] = '\0';
    (void)fclose(out);
}

void test_the_report_sorts_by_precedence_and_sums_the_load(void)
{
    char text[2000];

    one_blocking();
    at_us(250, KERNEL_RELEASED, &swi);
    at_us(250, KERNEL_PREEMPTED, &low);
    at_us(250, KERNEL_DISPATCHED, &swi);
    at_us(350, KERNEL_FINISHED, &swi);
    at_us(350, KERNEL_DISPATCHED, &low);
    at_us(400, KERNEL_FINISHED, &low);
    conclude_at_us(1000);
    report(text, sizeof text);
    TEST_ASSERT_EQUAL_STRING(
        "kind name                 jobs  response     bound  deadline  late gate wait inversion   allowed "
        "waits max    load\n"
        "Hwi  SCIA_RX                 1    0.0300         -         -     0         -         -         -    "
        " -   -  0.0300\n"
        "Swi  Laser_SWI               1    0.1000         -         -     0         -         -         -    "
        " -   -  0.1000\n"
        "Task high                    1    0.1170    0.5000    1.0000     0    0.0500    0.0200    0.0200    "
        " 1   1  0.0670\n"
        "Task low                     1    0.3100         -    3.0000     0    0.0000    0.0000         -    "
        " 0   -  0.1130\n"
        "processor load: Hwis 0.0300, Swis 0.1000, tasks with their switches 0.1800, total 0.3100\n"
        "interrupts per second: 1000.0\n",
        text);
}

void test_jobs_of_one_name_are_told_apart_by_kind_and_number(void)
{
    kernel_job_t first = {KERNEL_HWI, "", 92, 92, 0}, second = {KERNEL_HWI, "", 93, 93, 0},
                 task = {KERNEL_TASK, "", 93, 1, 0};

    at_us(1, KERNEL_RELEASED, &first);
    at_us(1, KERNEL_RELEASED, &second);
    at_us(1, KERNEL_RELEASED, &task);
    at_us(2, KERNEL_RELEASED, &first);
    TEST_ASSERT_EQUAL_INT(3, timing.jobs);
}

static int read_limits(const char *text, timing_limits_t read[TIMING_JOBS_MAX])
{
    FILE *in = tmpfile();

    TEST_ASSERT_NOT_NULL(in);
    TEST_ASSERT_TRUE(fputs(text, in) >= 0);
    rewind(in);
    const int count = timing_read_limits(in, read);

    (void)fclose(in);
    return count;
}

void test_limits_are_read_and_a_name_without_any_has_none(void)
{
    timing_limits_t read[TIMING_JOBS_MAX];

    TEST_ASSERT_EQUAL_INT(2, read_limits("TaskIMU,1100401,25000000,9301,1\nFREE,113552302,-1,-1,-1\n", read));
    const timing_limits_t *imu = timing_limits_of(read, 2, "TaskIMU");

    TEST_ASSERT_EQUAL_INT64(1100401, imu->response);
    TEST_ASSERT_EQUAL_INT64(25000000, imu->deadline);
    TEST_ASSERT_EQUAL_INT64(9301, imu->inversion);
    TEST_ASSERT_EQUAL_INT(1, imu->blockings);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timing_limits_of(read, 2, "FREE")->deadline);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timing_limits_of(read, 2, "SCAN")->response);
}

void test_what_are_no_limits_is_refused(void)
{
    static const char *const wrong[] = {"",
                                        "TaskIMU,1,2,3\n",
                                        "TaskIMU,1,2,3,4,5\n",
                                        "TaskIMU,1,2,3,4 x\n",
                                        "TaskIMU,soon,2,3,4\n",
                                        "A,1,2,3,4\nname,kind,priority\n",
                                        "a name of more than 31 characters,1,2,3,4\n"};
    timing_limits_t read[TIMING_JOBS_MAX];

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, read_limits(wrong[i], read), wrong[i]);
    }
}
