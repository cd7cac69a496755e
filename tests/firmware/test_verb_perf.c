/* `#PERF` with the real answer writer; monitor, load and radio are mocked. */
#include "firmware/listing.h"
#include "firmware/verbs.h"

#include <stdio.h>
#include <string.h>

#include "mock_Load.h"
#include "mock_boot.h"
#include "mock_cpu_time.h"
#include "mock_monitor.h"
#include "mock_xbee_port.h"
#include "unity.h"

#define LINES_MAX 30U

static char sent[LINES_MAX][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t sends;
static uint16_t resets;
static monitor_report_t figures[MONITOR_TASKS];
static uint32_t waits[MONITOR_SERVERS];

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_LESS_THAN(LINES_MAX, sends);
    TEST_ASSERT_FALSE(line->overflowed);
    (void)memcpy(sent[sends], line->text, line->length);
    sent[sends][line->length] = '\0';
    sends++;
}

static bool spare(const telemetry_line_t *line, int calls)
{
    radio(line, calls);
    return true;
}

static void report(monitor_task_t task, monitor_report_t *figure, int calls)
{
    (void)calls;
    *figure = figures[task];
}

static uint32_t longest_wait(monitor_server_t server, int calls)
{
    (void)calls;
    return waits[server];
}

static uint32_t cycles_of_cost;

static const char *name_of_cost(cpu_time_job_t job, int calls)
{
    static char name[20];

    (void)calls;
    (void)snprintf(name, sizeof name, "Job%d", (int)job);
    return name;
}

static uint32_t cost(cpu_time_job_t job, int calls)
{
    (void)calls;
    return cycles_of_cost + (uint32_t)job;
}

static uint32_t hold(monitor_server_t server, int calls)
{
    (void)calls;
    return cycles_of_cost + 1000U * (uint32_t)server;
}

static void reset(int calls)
{
    (void)calls;
    resets++;
}

void setUp(void)
{
    sends = resets = 0U;
    for (uint32_t i = 0; i < MONITOR_TASKS; i++) {
        figures[i] = (monitor_report_t){"TaskReceiveLaser", 1000U + i, 20U + i, 300U + i, 512U};
    }
    for (uint32_t i = 0; i < MONITOR_SERVERS; i++) {
        waits[i] = 10U + i;
    }
    xbee_port_answer_Stub(radio);
    xbee_port_spare_Stub(spare);
    monitor_report_Stub(report);
    monitor_longest_wait_us_Stub(longest_wait);
    monitor_reset_Stub(reset);
    cpu_time_name_Stub(name_of_cost);
    cpu_time_longest_Stub(cost);
    monitor_longest_hold_Stub(hold);
    cycles_of_cost = 20U;
    boot_cause_IgnoreAndReturn("POWER");
    Load_getCPULoad_IgnoreAndReturn(7U);
}

void tearDown(void) {}

static bool ask(const char *argument)
{
    static telecommand_t command;
    answer_t answer = {.command = &command};

    command = (telecommand_t){.name = "PERF", .name_length = 4U};
    command.argument_length = (uint16_t)strlen(argument);
    (void)memcpy(command.argument, argument, command.argument_length);
    sends = 0U;
    if (!verb_perf(&answer)) {
        return false;
    }
    TEST_ASSERT_FALSE(listing_more());
    return true;
}

void test_the_run_then_every_task_then_the_waits(void)
{
    TEST_ASSERT_TRUE(ask(""));
    TEST_ASSERT_EQUAL_UINT16(9, sends);
    TEST_ASSERT_EQUAL_STRING("OK PERF reset:POWER load:7\r\n", sent[0]);
    for (unsigned i = 0; i < MONITOR_TASKS; i++) {
        char expected[96];

        (void)snprintf(expected, sizeof expected,
                       "OK PERF TaskReceiveLaser worst_us:%u late:%u stack:%u/512\r\n", 1000U + i, 20U + i,
                       300U + i);
        TEST_ASSERT_EQUAL_STRING(expected, sent[1U + i]);
    }
    TEST_ASSERT_EQUAL_STRING(
        "OK PERF wait_us altitude:10 imu:11 laser:12 reference:13 parameters:14 flight:15\r\n", sent[7]);
    TEST_ASSERT_EQUAL_STRING("OK PERF END lines:8\r\n", sent[8]);
    TEST_ASSERT_EQUAL_UINT16(0, resets);
}

void test_reset_clears_in_either_case_and_answers_once(void)
{
    TEST_ASSERT_TRUE(ask("RESET"));
    TEST_ASSERT_TRUE(ask("reset"));
    TEST_ASSERT_EQUAL_UINT16(2, resets);
    TEST_ASSERT_EQUAL_UINT16(1, sends);
    TEST_ASSERT_EQUAL_STRING("OK PERF RESET\r\n", sent[0]);
}

void test_any_other_word_is_refused_and_clears_nothing(void)
{
    static const char *const words[] = {"RESE", "RESETS", "1", "COST"};

    for (uint16_t i = 0; i < 4U; i++) {
        TEST_ASSERT_FALSE(ask(words[i]));
        TEST_ASSERT_EQUAL_UINT16(1, sends);
        TEST_ASSERT_EQUAL_STRING("ERR PERF one of COSTS|RESET\r\n", sent[0]);
    }
    TEST_ASSERT_EQUAL_UINT16(0, resets);
}

void test_costs_are_every_job_then_every_gate_numbered_in_nanoseconds(void)
{
    TEST_ASSERT_TRUE(ask("costs"));
    TEST_ASSERT_EQUAL_UINT16(CPU_TIME_JOBS + MONITOR_SERVERS + 1, sends);
    TEST_ASSERT_EQUAL_STRING("OK PERF COSTS 1 Job0 longest_ns:100\r\n", sent[0]);
    TEST_ASSERT_EQUAL_STRING("OK PERF COSTS 17 Job16 longest_ns:180\r\n", sent[16]);
    TEST_ASSERT_EQUAL_STRING("OK PERF COSTS 18 altitude hold_ns:100\r\n", sent[17]);
    TEST_ASSERT_EQUAL_STRING("OK PERF COSTS 23 flight hold_ns:25100\r\n", sent[22]);
    TEST_ASSERT_EQUAL_STRING("OK PERF END lines:23\r\n", sent[23]);
}

void test_the_largest_figures_fit(void)
{
    for (uint32_t i = 0; i < MONITOR_TASKS; i++) {
        figures[i] = (monitor_report_t){"TaskReceiveLaser", 0xFFFFFFFFU, 0xFFFFFFFFU, 0xFFFFFFFFU,
                                        0xFFFFFFFFU};
    }
    (void)memset(waits, 0xFF, sizeof waits);
    boot_cause_IgnoreAndReturn("WATCHDOG");
    TEST_ASSERT_TRUE(ask(""));
    TEST_ASSERT_EQUAL_UINT16(9, sends);
    for (uint16_t i = 0; i < 8U; i++) {
        TEST_ASSERT_EQUAL_STRING_LEN("OK PERF ", sent[i], 8);
    }
}
