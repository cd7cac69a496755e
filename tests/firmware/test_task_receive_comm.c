/* TaskReceiveComm between a scripted radio and recording commands. */
#include "firmware/tasks.h"

#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_commands.h"
#include "mock_timebase.h"
#include "mock_xbee_port.h"
#include "unity.h"

static const struct {
    const char *text;
    uint32_t arrival_us;
    uint16_t lost;
} script[] = {{"#PING 1", 1000U, 0U}, {"#SETR 0.6", 2000U, 3U}, {"#PING 2", 0xFFFFFFF0U, 1U}};
#define SCRIPT (sizeof script / sizeof script[0])

static size_t taken;
static size_t executed;
static uint16_t reported[SCRIPT];
static size_t reports;

static void port_create(int calls)
{
    TEST_ASSERT_EQUAL_INT(0, calls);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.created);
    kernel_note("port");
}

static uint16_t port_wait(xbee_message_t *message, int calls)
{
    (void)calls;
    kernel_note("wait");
    if (taken == SCRIPT) {
        kernel_block();
    }
    message->line.length = (uint16_t)strlen(script[taken].text);
    message->line.overlong = false;
    (void)memcpy(message->line.text, script[taken].text, message->line.length);
    message->arrival_us = script[taken].arrival_us;
    return script[taken++].lost;
}

static void execute(const xbee_message_t *message, int calls)
{
    const telecommand_line_t *line = &message->line;

    (void)calls;
    kernel_note("execute");
    TEST_ASSERT_EQUAL_UINT16(strlen(script[executed].text), line->length);
    TEST_ASSERT_EQUAL_STRING_LEN(script[executed].text, line->text, line->length);
    TEST_ASSERT_EQUAL_UINT32(script[executed].arrival_us, message->arrival_us);
    executed++;
}

static uint32_t free_after_us; /* behind the arrival: the radio held the line up */

static uint32_t free_us(void)
{
    return script[taken < SCRIPT ? taken : SCRIPT - 1U].arrival_us + free_after_us;
}

static uint32_t go_on(int calls)
{
    (void)calls;
    kernel_note("continue");
    return free_us();
}

static uint32_t time_us(int calls)
{
    (void)calls;
    return script[taken - 1U].arrival_us + 5000000U;
}

static void report_lost(uint16_t count, int calls)
{
    (void)calls;
    kernel_note("lost");
    TEST_ASSERT_LESS_THAN_UINT64(SCRIPT, reports);
    reported[reports++] = count;
}

void setUp(void)
{
    kernel_reset();
    taken = executed = reports = 0U;
    free_after_us = (uint32_t)-700000;
    xbee_port_create_Stub(port_create);
    xbee_port_wait_Stub(port_wait);
    commands_execute_Stub(execute);
    commands_report_lost_Stub(report_lost);
    commands_continue_Stub(go_on);
    bsp_time_us_Stub(time_us);
    jobs_reset();
    task_receive_comm_create();
}

void tearDown(void)
{
    kernel_check();
}

void test_create_makes_the_port_first_and_then_one_task_of_priority_1(void)
{
    TEST_ASSERT_EQUAL_STRING("port ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskReceiveComm", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(1, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1152, kernel.task.params.stackSize);
}

void test_each_line_is_executed_once_in_its_order_losses_told_before_it_long_answers_between_lines(void)
{
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING(
        "port continue wait execute continue wait lost execute continue wait lost execute "
        "continue wait ",
        kernel.notes);
    TEST_ASSERT_EQUAL_UINT64(SCRIPT, executed);
    TEST_ASSERT_EQUAL_UINT64(2, reports);
    TEST_ASSERT_EQUAL_UINT16(3, reported[0]);
    TEST_ASSERT_EQUAL_UINT16(1, reported[1]);
}

void test_every_line_is_one_job_released_when_it_was_complete(void)
{
    kernel_run_task();
    jobs_assert(MONITOR_RECEIVE_COMM, SCRIPT);
    TEST_ASSERT_EQUAL_UINT16(SCRIPT, jobs[MONITOR_RECEIVE_COMM].released);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFF0U, jobs[MONITOR_RECEIVE_COMM].released_us);
}

void test_a_line_that_was_held_up_counts_from_when_it_could_be_taken(void)
{
    free_after_us = 4000000U;
    kernel_run_task();
    jobs_assert(MONITOR_RECEIVE_COMM, SCRIPT);
    TEST_ASSERT_EQUAL_UINT16(SCRIPT, jobs[MONITOR_RECEIVE_COMM].released);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFF0U + 4000000U, jobs[MONITOR_RECEIVE_COMM].released_us);
}
