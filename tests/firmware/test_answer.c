/* Answer lines with the real writer; the radio is mocked. */
#include "firmware/answer.h"

#include <string.h>

#include "mock_xbee_port.h"
#include "unity.h"

static char sent[TELEMETRY_ANSWER_MAX + 1U];
static uint16_t sends;
static telecommand_t command;
static answer_t answer;

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    (void)memcpy(sent, line->text, line->length);
    sent[line->length] = '\0';
    sends++;
}

void setUp(void)
{
    (void)memset(&command, 0, sizeof command);
    (void)memset(&answer, 0x5A, sizeof answer);
    (void)memcpy(command.name, "VERB", 4U);
    command.name_length = 4U;
    answer.command = &command;
    sends = 0U;
    sent[0] = '\0';
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static void assert_sent(const char *expected)
{
    TEST_ASSERT_EQUAL_STRING(expected, sent);
    TEST_ASSERT_EQUAL_UINT16(1, sends);
    sends = 0U;
}

void test_an_answer_begins_with_its_verdict_and_its_name_and_ends_with_cr_lf(void)
{
    answer_begin(&answer);
    answer_send(&answer);
    assert_sent("OK VERB\r\n");
}

void test_nothing_is_sent_before_it_is_asked_for(void)
{
    answer_begin(&answer);
    answer_count(&answer, "n", 1U);
    TEST_ASSERT_EQUAL_UINT16(0, sends);
}

void test_a_command_without_a_name_is_told_as_a_dash(void)
{
    command.name_length = 0U;
    answer_begin(&answer);
    answer_send(&answer);
    assert_sent("OK -\r\n");
    TEST_ASSERT_FALSE(answer_refuse(&answer, "empty command"));
    assert_sent("ERR - empty command\r\n");
}

void test_a_refusal_sends_its_reason_and_is_false(void)
{
    answer_begin(&answer);
    telemetry_text(&answer.line, " half an answer");
    TEST_ASSERT_FALSE(answer_refuse(&answer, "not now"));
    assert_sent("ERR VERB not now\r\n");
}

void test_counts_have_their_name_and_all_their_digits(void)
{
    answer_begin(&answer);
    answer_count(&answer, "good", 0U);
    answer_count(&answer, "bad", 65536U);
    answer_count(&answer, "ugly", 4294967295U);
    answer_send(&answer);
    assert_sent("OK VERB good:0 bad:65536 ugly:4294967295\r\n");
}

void test_limits_of_a_number_and_of_a_choice(void)
{
    static const char *const colours[] = {"RED", "GREEN", "BLUE"};
    const parameter_row_t number = {"N", "mm", -0.5F, 11.76F, 0.0F, NULL, PARAMETERS_LAWS, "m"};
    const parameter_row_t choice = {"C", "-", 0.0F, 2.0F, 0.0F, colours, PARAMETERS_LAWS, "m"};
    const parameter_row_t only = {"O", "-", 0.0F, 0.0F, 0.0F, colours, PARAMETERS_LAWS, "m"};

    TEST_ASSERT_FALSE(answer_refuse_range(&answer, &number));
    assert_sent("ERR VERB out of range -0.5..11.76 mm\r\n");
    TEST_ASSERT_FALSE(answer_refuse_range(&answer, &choice));
    assert_sent("ERR VERB one of RED|GREEN|BLUE\r\n");
    TEST_ASSERT_FALSE(answer_refuse_range(&answer, &only));
    assert_sent("ERR VERB one of RED\r\n");
    answer_begin(&answer);
    answer_limits(&answer, &choice);
    answer_send(&answer);
    assert_sent("OK VERBRED|GREEN|BLUE\r\n");
}

void test_answers_may_take_two_radio_packets(void)
{
    char filler[TELEMETRY_ANSWER_MAX];

    (void)memset(filler, 'x', sizeof filler);
    answer_begin(&answer);
    telemetry_characters(&answer.line, filler, TELEMETRY_ANSWER_MAX - 9U);
    answer_send(&answer);
    TEST_ASSERT_EQUAL_UINT64(TELEMETRY_ANSWER_MAX, strlen(sent));
    TEST_ASSERT_EQUAL_STRING("x\r\n", &sent[TELEMETRY_ANSWER_MAX - 3U]);
}

/* A line that is cut would swallow the next one. */
void test_an_answer_that_does_not_fit_becomes_an_error_at_every_length(void)
{
    char filler[TELEMETRY_ANSWER_MAX + 10U];

    (void)memset(filler, 'x', sizeof filler);
    for (uint16_t length = 0U; length < sizeof filler; length++) {
        answer_begin(&answer);
        telemetry_characters(&answer.line, filler, length);
        answer_send(&answer);
        TEST_ASSERT_EQUAL_UINT16(length + 1U, sends);
        if (length <= TELEMETRY_ANSWER_MAX - 9U) {
            TEST_ASSERT_EQUAL_UINT64(length + 9U, strlen(sent));
        } else {
            TEST_ASSERT_EQUAL_STRING("ERR VERB answer too long\r\n", sent);
        }
    }
}

void test_every_row_of_the_table_fits_its_refusal(void)
{
    (void)memcpy(command.name, "ABCDEFGHIJKL", TELECOMMAND_NAME_MAX);
    command.name_length = TELECOMMAND_NAME_MAX;
    for (uint16_t id = 0; id < PARAMETER_COUNT; id++) {
        (void)answer_refuse_range(&answer, &parameter_table[id]);
        TEST_ASSERT_NULL_MESSAGE(strstr(sent, "too long"), parameter_table[id].name);
    }
}

static bool argument_is(const char *argument, const char *word)
{
    command.argument_length = (uint16_t)strlen(argument);
    (void)memcpy(command.argument, argument, command.argument_length);
    return answer_argument_is(&answer, word);
}

void test_an_argument_is_compared_whole_and_in_either_case(void)
{
    TEST_ASSERT_TRUE(argument_is("RESET", "RESET"));
    TEST_ASSERT_TRUE(argument_is("rEsEt", "RESET"));
    TEST_ASSERT_FALSE(argument_is("RESE", "RESET"));
    TEST_ASSERT_FALSE(argument_is("RESETS", "RESET"));
    TEST_ASSERT_FALSE(argument_is("", "RESET"));
    TEST_ASSERT_TRUE(argument_is("", ""));
    TEST_ASSERT_FALSE(argument_is("[", "{"));
}

void test_blanks_and_tabs_between_words_are_one_blank(void)
{
    TEST_ASSERT_TRUE(argument_is("RATE FAST", "RATE FAST"));
    TEST_ASSERT_TRUE(argument_is("rate   fast", "RATE FAST"));
    TEST_ASSERT_TRUE(argument_is("RATE\t FAST", "RATE FAST"));
    TEST_ASSERT_FALSE(argument_is("RATEFAST", "RATE FAST"));
    TEST_ASSERT_FALSE(argument_is("RATE  FASTER", "RATE FAST"));
    TEST_ASSERT_FALSE(argument_is("RATE  ", "RATE FAST"));
    TEST_ASSERT_FALSE(argument_is("RA TE FAST", "RATE FAST"));
}
