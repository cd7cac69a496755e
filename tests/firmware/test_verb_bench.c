/* `#STREAM` and `#HANG` with the real answer writer. */
#include "firmware/verbs.h"

#include <string.h>

#include "mock_alive.h"
#include "mock_ground.h"
#include "mock_pulse_stream.h"
#include "mock_xbee_port.h"
#include "unity.h"

static char sent[TELEMETRY_ANSWER_MAX + 1U];

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    (void)memcpy(sent, line->text, line->length);
    sent[line->length] = '\0';
}

void setUp(void)
{
    sent[0] = '\0';
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static bool ask(bool (*verb)(answer_t *answer), const char *name, const char *argument)
{
    static telecommand_t command;
    answer_t answer = {.command = &command};

    command = (telecommand_t){.name_length = (uint16_t)strlen(name),
                              .argument_length = (uint16_t)strlen(argument)};
    (void)memcpy(command.name, name, strlen(name));
    (void)memcpy(command.argument, argument, strlen(argument));
    return verb(&answer);
}

void test_the_stream_is_turned_on_and_off_and_nothing_else_is_taken(void)
{
    pulse_stream_set_Expect(true);
    TEST_ASSERT_TRUE(ask(verb_stream, "STREAM", "pulse"));
    TEST_ASSERT_EQUAL_STRING("OK STREAM PULSE\r\n", sent);
    pulse_stream_set_Expect(false);
    TEST_ASSERT_TRUE(ask(verb_stream, "STREAM", "OFF"));
    TEST_ASSERT_EQUAL_STRING("OK STREAM OFF\r\n", sent);
    TEST_ASSERT_FALSE(ask(verb_stream, "STREAM", ""));
    TEST_ASSERT_EQUAL_STRING("ERR STREAM one of PULSE|OFF\r\n", sent);
}

void test_a_task_hangs_on_the_ground_and_the_answer_comes_first(void)
{
    ground_idle_ExpectAndReturn(true);
    alive_hang_Expect();
    TEST_ASSERT_TRUE(ask(verb_hang, "HANG", "TASK"));
    TEST_ASSERT_EQUAL_STRING("OK HANG TASK\r\n", sent);
}

void test_nothing_hangs_in_the_air_or_by_a_slip_of_the_finger(void)
{
    ground_idle_ExpectAndReturn(false);
    TEST_ASSERT_FALSE(ask(verb_hang, "HANG", "TASK"));
    TEST_ASSERT_EQUAL_STRING("ERR HANG not on the ground\r\n", sent);
    TEST_ASSERT_FALSE(ask(verb_hang, "HANG", ""));
    TEST_ASSERT_EQUAL_STRING("ERR HANG one of TASK\r\n", sent);
}
