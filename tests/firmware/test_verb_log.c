/* `#LOG` and its dump, over a recorder and a radio that are mocked. */
#include <stdio.h>
#include <string.h>

#include "mock_flight_recorder.h"
#include "mock_xbee_port.h"
#include "unity.h"
#include "firmware/verbs.h"

#define LINES_MAX 64U

static flight_recorder_span_t span;
static uint32_t since;
static uint16_t asked_seconds;
static bool cleared;
static flight_recorder_rate_t rate;
static bool line_waits;
static uint16_t room; /* lines that the radio takes until it is full */
static char lines[LINES_MAX][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t line_count;

static void keep(const telemetry_line_t *line)
{
    TEST_ASSERT_FALSE(line->overflowed);
    TEST_ASSERT_TRUE(line_count < LINES_MAX);
    memcpy(lines[line_count], line->text, line->length);
    lines[line_count][line->length] = '\0';
    line_count++;
}

static void answer_line(const telemetry_line_t *line, int calls)
{
    (void)calls;
    keep(line);
}

static bool spare_line(const telemetry_line_t *line, int calls)
{
    (void)calls;
    if (room == 0U) {
        return false;
    }
    room--;
    keep(line);
    return true;
}

static bool waits(int calls)
{
    (void)calls;
    return line_waits;
}

static flight_recorder_span_t look(int calls)
{
    (void)calls;
    return span;
}

static bool read(uint32_t number, published_t *record, int calls)
{
    (void)calls;
    *record = (published_t){
        .time_ms = number * 1000U, .beams = flight_beams_none(), .flight.state = FLIGHT_FLYING};
    return number - span.oldest < span.next - span.oldest;
}

static uint32_t seconds_back(uint16_t seconds, int calls)
{
    (void)calls;
    asked_seconds = seconds;
    return since;
}

static void clear(int calls)
{
    (void)calls;
    cleared = true;
    span.oldest = span.next;
}

static void set_rate(flight_recorder_rate_t wanted, int calls)
{
    (void)calls;
    rate = wanted;
}

void setUp(void)
{
    rate = FLIGHT_RECORDER_SLOW;
    flight_recorder_set_rate_Stub(set_rate);
    span = (flight_recorder_span_t){100U, 103U};
    line_count = asked_seconds = 0U;
    cleared = line_waits = false;
    room = LINES_MAX;
    xbee_port_answer_Stub(answer_line);
    xbee_port_spare_Stub(spare_line);
    xbee_port_waiting_Stub(waits);
    flight_recorder_span_Stub(look);
    flight_recorder_read_Stub(read);
    flight_recorder_since_Stub(seconds_back);
    flight_recorder_clear_Stub(clear);
}

static bool type(const char *argument)
{
    telecommand_t command = {.name = "LOG", .name_length = 3U};
    answer_t answer = {.command = &command};

    memcpy(command.argument, argument, strlen(argument));
    command.argument_length = (uint16_t)strlen(argument);
    return verb_log(&answer);
}

void tearDown(void)
{
    line_count = 0U;
    (void)type("STOP");
    TEST_ASSERT_FALSE(verb_log_more());
}

static void assert_line(uint16_t at, const char *start)
{
    TEST_ASSERT_TRUE_MESSAGE(at < line_count, start);
    TEST_ASSERT_EQUAL_STRING_LEN(start, lines[at], strlen(start));
}

void test_before_any_log_there_is_nothing_to_go_on_with(void)
{
    TEST_ASSERT_FALSE(verb_log_more());
    TEST_ASSERT_EQUAL_UINT16(0, line_count);
}

void test_the_rate_is_fast_or_slow_and_nothing_else(void)
{
    TEST_ASSERT_TRUE(type("rate fast"));
    assert_line(0, "OK LOG RATE FAST\r\n");
    TEST_ASSERT_EQUAL_INT(FLIGHT_RECORDER_FAST, rate);
    TEST_ASSERT_FALSE(type("RATE"));
    TEST_ASSERT_FALSE(type("RATE 25"));
    TEST_ASSERT_EQUAL_INT(FLIGHT_RECORDER_FAST, rate);
    TEST_ASSERT_TRUE(type("RATE SLOW"));
    assert_line(3, "OK LOG RATE SLOW\r\n");
    TEST_ASSERT_EQUAL_INT(FLIGHT_RECORDER_SLOW, rate);
}

void test_all_records_come_between_a_title_and_an_end(void)
{
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_EQUAL_UINT16(1, line_count);
    TEST_ASSERT_FALSE(verb_log_more());
    assert_line(0, "OK LOG records:3\r\n");
    assert_line(1, "OK LOG 0 t_s,");
    assert_line(2, "OK LOG 1 100.000,");
    assert_line(3, "OK LOG 2 101.000,");
    assert_line(4, "OK LOG 3 102.000,");
    assert_line(5, "OK LOG END lines:3\r\n");
    TEST_ASSERT_EQUAL_UINT16(6, line_count);
    TEST_ASSERT_NOT_NULL(strstr(lines[2], ",FLYING,"));
}

/* By Python: binascii.crc_hqx(line, 0xFFFF). */
void test_titles_and_rows_end_with_the_sum_of_all_before_it(void)
{
    (void)type("");
    TEST_ASSERT_FALSE(verb_log_more());
    TEST_ASSERT_EQUAL_STRING(
        "OK LOG 0 "
        "t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,up_mps2,"
        "pulse_us,age_s,bat_v,doubt,limit,bat,mf_rays,mf_mm,mf_spread_mm,mf_ms,mf_lie,m1_rays,"
        "m1_mm,m1_spread_mm,m1_ms,m1_lie,m2_rays,m2_mm,m2_spread_mm,m2_ms,m2_lie,"
        "out*5F9E\r\n",
        lines[1]);
    TEST_ASSERT_EQUAL_STRING(
        "OK LOG 1 "
        "100.000,0.000,0.000,0.000,0.000,0.000,0.0000,0.0000,FLYING,0,0.000,0.0,0.000,0.00,,,,"
        ",,,,,,,,,,,,,,,*6AF7\r\n",
        lines[2]);
}

void test_an_empty_recorder_gives_title_and_end(void)
{
    span.oldest = span.next;
    (void)type("");
    TEST_ASSERT_FALSE(verb_log_more());
    assert_line(0, "OK LOG records:0\r\n");
    assert_line(2, "OK LOG END lines:0\r\n");
}

void test_it_goes_on_line_by_line_as_the_radio_takes_them_and_none_twice(void)
{
    (void)type("");
    for (int i = 0; i < 5; i++) {
        room = 0U;
        TEST_ASSERT_TRUE(verb_log_more());
        room = 1U;
        TEST_ASSERT_EQUAL(i < 4, verb_log_more());
        TEST_ASSERT_EQUAL_UINT16(2 + i, line_count);
    }
    assert_line(2, "OK LOG 1 100.000,");
    assert_line(3, "OK LOG 2 101.000,");
    assert_line(5, "OK LOG END lines:3\r\n");
}

void test_a_command_that_waits_comes_first(void)
{
    (void)type("");
    line_waits = true;
    TEST_ASSERT_TRUE(verb_log_more());
    TEST_ASSERT_EQUAL_UINT16(1, line_count);
    line_waits = false;
    TEST_ASSERT_FALSE(verb_log_more());
    TEST_ASSERT_EQUAL_UINT16(6, line_count);
}

void test_records_that_come_later_are_not_waited_for_and_overwritten_ones_are_left_out(void)
{
    (void)type("");
    room = 2U;
    TEST_ASSERT_TRUE(verb_log_more());
    span = (flight_recorder_span_t){102U, 120U};
    room = LINES_MAX;
    TEST_ASSERT_FALSE(verb_log_more());
    assert_line(2, "OK LOG 1 100.000,");
    assert_line(3, "OK LOG 2 102.000,");
    assert_line(4, "OK LOG END lines:2\r\n");
    TEST_ASSERT_EQUAL_UINT16(5, line_count);
}

void test_a_log_that_is_overwritten_altogether_ends(void)
{
    (void)type("");
    span = (flight_recorder_span_t){500U, 600U};
    TEST_ASSERT_FALSE(verb_log_more());
    assert_line(2, "OK LOG END");
    TEST_ASSERT_EQUAL_UINT16(3, line_count);
}

void test_a_number_asks_for_the_latest_seconds(void)
{
    since = 102U;
    TEST_ASSERT_TRUE(type("10"));
    TEST_ASSERT_EQUAL_UINT16(10, asked_seconds);
    assert_line(0, "OK LOG records:1\r\n");
    TEST_ASSERT_FALSE(verb_log_more());
    assert_line(2, "OK LOG 1 102.000,");
}

void test_clear_and_stop_end_a_dump(void)
{
    (void)type("");
    TEST_ASSERT_TRUE(type("stop"));
    assert_line(1, "OK LOG STOP\r\n");
    TEST_ASSERT_FALSE(verb_log_more());
    TEST_ASSERT_FALSE(cleared);
    (void)type("");
    TEST_ASSERT_TRUE(type("Clear"));
    TEST_ASSERT_TRUE(cleared);
    assert_line(3, "OK LOG CLEAR\r\n");
    TEST_ASSERT_FALSE(verb_log_more());
}

void test_anything_else_is_refused_and_starts_nothing(void)
{
    static const char *const wrong[] = {"0", "-1", "3601", "STO", "STOPP", "CLEAR 1", "x", "nan", "1 2"};

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        line_count = 0U;
        TEST_ASSERT_FALSE_MESSAGE(type(wrong[i]), wrong[i]);
        assert_line(0, "ERR LOG ");
        TEST_ASSERT_FALSE(verb_log_more());
    }
}
