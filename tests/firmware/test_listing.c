/* An answer of many lines over a radio that takes some of them. */
#include "firmware/listing.h"

#include <string.h>

#include "mock_xbee_port.h"
#include "unity.h"

#define LINES_MAX 32U

static char lines[LINES_MAX][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t line_count;
static uint16_t room; /* lines that the radio takes until it is full */
static uint16_t to_tell;

static bool spare(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    if (room == 0U) {
        return false;
    }
    room--;
    TEST_ASSERT_LESS_THAN_UINT16(LINES_MAX, line_count);
    (void)memcpy(lines[line_count], line->text, line->length);
    lines[line_count][line->length] = '\0';
    line_count++;
    return true;
}

static bool write_line(answer_t *answer, uint16_t number)
{
    answer_begin(answer);
    answer_count(answer, "line", number);
    return number < to_tell;
}

void setUp(void)
{
    line_count = 0U;
    room = LINES_MAX;
    xbee_port_spare_Stub(spare);
}

void tearDown(void)
{
    room = LINES_MAX;
    (void)listing_more();
}

static void start(const char *name, uint16_t count)
{
    telecommand_t command = {.name_length = (uint16_t)strlen(name)};
    const answer_t answer = {.command = &command};

    (void)memcpy(command.name, name, strlen(name));
    to_tell = count;
    TEST_ASSERT_TRUE(listing_start(&answer, write_line));
    (void)memset(&command, 'X', sizeof command); /* the next command comes in its place */
}

void test_before_any_list_there_is_nothing_to_send(void)
{
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_UINT16(0, line_count);
}

void test_every_line_and_then_their_number(void)
{
    start("GET", 3U);
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_UINT16(4, line_count);
    TEST_ASSERT_EQUAL_STRING("OK GET line:0\r\n", lines[0]);
    TEST_ASSERT_EQUAL_STRING("OK GET line:2\r\n", lines[2]);
    TEST_ASSERT_EQUAL_STRING("OK GET END lines:3\r\n", lines[3]);
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_UINT16(4, line_count);
}

void test_a_list_of_nothing_says_so(void)
{
    start("HELP", 0U);
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_UINT16(1, line_count);
    TEST_ASSERT_EQUAL_STRING("OK HELP END lines:0\r\n", lines[0]);
}

void test_it_goes_on_where_the_radio_was_full_and_sends_nothing_twice(void)
{
    room = 0U;
    start("PERF", 3U);
    for (uint16_t i = 0; i < 4U; i++) {
        TEST_ASSERT_TRUE(listing_more());
        TEST_ASSERT_EQUAL_UINT16(i, line_count);
        room = 1U;
        TEST_ASSERT_EQUAL(i < 3U, listing_more());
        TEST_ASSERT_EQUAL_UINT16(i + 1U, line_count);
    }
    TEST_ASSERT_EQUAL_STRING("OK PERF END lines:3\r\n", lines[3]);
}
