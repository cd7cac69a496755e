#include "drivers/telemetry.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "unity.h"

#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the generated runner declares the tests */

static telemetry_line_t line;

void setUp(void)
{
    memset(&line, 0x5A, sizeof line);
    telemetry_begin(&line);
}

void tearDown(void) {}

static void assert_line(const char *expected)
{
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

static telemetry_t flying(void)
{
    telemetry_t telemetry = {.height_valid = true,
                             .height_mm = 598.0F,
                             .reference_m = 0.6F,
                             .laser = "OK",
                             .thrust_n = 7.12F,
                             .state = "FLYING",
                             .flags = 0U};
    return telemetry;
}

void test_the_status_line_is_the_documented_one(void)
{
    telemetry_t telemetry = flying();
    telemetry_status(&line, &telemetry);
    assert_line("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n");
}

void test_without_a_valid_height_the_altitude_is_a_dash(void)
{
    telemetry_t telemetry = flying();
    telemetry.height_valid = false;
    telemetry.reference_m = 0.0F;
    telemetry.laser = "WAIT";
    telemetry.thrust_n = 0.0F;
    telemetry.state = "GROUND";
    telemetry.flags = 3U;
    telemetry_status(&line, &telemetry);
    assert_line("alt:- ref:0.000 laser:WAIT thr:0.00 state:GROUND flags:3\r\n");
}

void test_a_height_below_zero_keeps_its_sign_and_a_rounded_zero_has_none(void)
{
    telemetry_t telemetry = flying();
    telemetry.height_mm = -12.0F;
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_EQUAL_STRING_LEN("alt:-0.012 ref", line.text, 14);
    telemetry.height_mm = -0.4F;
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_EQUAL_STRING_LEN("alt:0.000 ref", line.text, 13);
}

void test_the_cause_of_a_reset_is_one_field_more(void)
{
    telemetry_t telemetry = flying();
    telemetry.reset = "WATCHDOG";
    telemetry_status(&line, &telemetry);
    assert_line("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 reset:WATCHDOG\r\n");
}

void test_with_the_longest_names_the_cause_of_a_reset_fits_the_packet_too(void)
{
    telemetry_t telemetry = {.height_valid = true,
                             .height_mm = -4000.0F,
                             .reference_m = 3.0F,
                             .laser = "EIGHT_CH",
                             .thrust_n = 11.76F,
                             .state = "DESCENDING",
                             .flags = 63U,
                             .reset = "WATCHDOG"};
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_LESS_OR_EQUAL(TELEMETRY_LINE_MAX, line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(" reset:WATCHDOG\r\n", &line.text[line.length - 17U], 17);
}

void test_values_that_cannot_be_written_become_dashes(void)
{
    telemetry_t telemetry = flying();
    telemetry.height_mm = NAN;
    telemetry.reference_m = INFINITY;
    telemetry.thrust_n = -FLT_MAX;
    telemetry_status(&line, &telemetry);
    assert_line("alt:- ref:- laser:OK thr:- state:FLYING flags:0\r\n");
}

void test_no_input_makes_the_line_longer_than_a_radio_packet(void)
{
    static const float values[] = {0.0F,    0.598F,   -4294966.5F,   4294966.5F, -1.0e6F, 4294967.0F,
                                   FLT_MAX, -FLT_MAX, INFINITY,      -INFINITY,  NAN,     FLT_MIN,
                                   1e-7F,   -0.0F,    -999999.9999F, 1e30F};
    static const uint16_t n = sizeof values / sizeof values[0];

    for (uint16_t i = 0; i < n; i++) {
        for (uint16_t j = 0; j < n; j++) {
            for (uint16_t k = 0; k < n; k++) {
                telemetry_t telemetry = {.height_valid = true,
                                         .height_mm = values[i],
                                         .reference_m = values[j],
                                         .laser = "EIGHT_CH",
                                         .thrust_n = values[k],
                                         .state = "DESCENDING",
                                         .flags = 65535U};
                telemetry_status(&line, &telemetry);
                TEST_ASSERT_FALSE(line.overflowed);
                TEST_ASSERT_LESS_OR_EQUAL(TELEMETRY_LINE_MAX, line.length);
                TEST_ASSERT_EQUAL_STRING_LEN("alt:", line.text, 4);
                TEST_ASSERT_EQUAL_STRING_LEN(" flags:65535\r\n", &line.text[line.length - 14U], 14);
            }
        }
    }
}

void test_the_longest_line_that_fits_is_95_characters_and_one_more_is_not_to_be_sent(void)
{
    telemetry_t telemetry = {.height_valid = true,
                             .height_mm = -4294966500.0F,
                             .reference_m = -4294966.5F,
                             .laser = "EIGHT_CH",
                             .thrust_n = -4294966.5F,
                             .state = "DESCENDING",
                             .flags = 65535U};
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_EQUAL(95U, line.length);
    TEST_ASSERT_FALSE(line.overflowed);
    telemetry.laser = "NINE_CHAR";
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_TRUE(line.overflowed);
    TEST_ASSERT_LESS_OR_EQUAL(TELEMETRY_LINE_MAX, line.length);
}

void test_an_answer_is_built_from_texts_numbers_and_counts(void)
{
    telemetry_text(&line, "OK ");
    telemetry_characters(&line, "KPxx", 2U);
    telemetry_text(&line, " ");
    telemetry_number(&line, 0.015F);
    telemetry_text(&line, " ");
    telemetry_count(&line, 42U);
    telemetry_text(&line, " ");
    telemetry_fixed(&line, 2.5F, 0U);
    telemetry_end(&line);
    assert_line("OK KP 0.015 42 3\r\n");
}

void test_begin_forgets_everything(void)
{
    telemetry_text(&line, "rest of an old line");
    line.overflowed = true;
    telemetry_begin(&line);
    telemetry_end(&line);
    assert_line("\r\n");
}

void test_counts_are_written_over_their_whole_range(void)
{
    static const struct {
        uint32_t value;
        const char *text;
    } rows[] = {{0UL, "0"},
                {9UL, "9"},
                {10UL, "10"},
                {32768UL, "32768"},
                {65535UL, "65535"},
                {65536UL, "65536"},
                {1000000000UL, "1000000000"},
                {4294967295UL, "4294967295"}};
    for (uint16_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        telemetry_begin(&line);
        telemetry_count(&line, rows[i].value);
        assert_line(rows[i].text);
    }
}

void test_numbers_that_the_shortest_writer_refuses_are_dashes(void)
{
    telemetry_number(&line, NAN);
    telemetry_number(&line, 1e-8F);
    telemetry_number(&line, 1e7F);
    telemetry_number(&line, 0.0F);
    telemetry_fixed(&line, 1.0F, 7U);
    assert_line("---0-");
}

void test_what_does_not_fit_is_left_out_whole_and_nothing_follows(void)
{
    char filler[TELEMETRY_LINE_MAX];

    memset(filler, 'x', sizeof filler);
    telemetry_characters(&line, filler, TELEMETRY_LINE_MAX - 4U);
    TEST_ASSERT_FALSE(line.overflowed);
    telemetry_text(&line, "12345");
    TEST_ASSERT_TRUE(line.overflowed);
    TEST_ASSERT_EQUAL(TELEMETRY_LINE_MAX - 4U, line.length);
    telemetry_text(&line, "1");
    telemetry_count(&line, 1U);
    telemetry_number(&line, 1.0F);
    telemetry_end(&line);
    TEST_ASSERT_TRUE(line.overflowed);
    TEST_ASSERT_EQUAL(TELEMETRY_LINE_MAX - 4U, line.length);
}

void test_a_text_larger_than_the_line_is_refused(void)
{
    static const char text[TELEMETRY_LINE_MAX + 1U] = {0};
    telemetry_characters(&line, text, TELEMETRY_LINE_MAX + 1U);
    TEST_ASSERT_TRUE(line.overflowed);
    TEST_ASSERT_EQUAL(0U, line.length);
}

void test_a_line_is_ended_whole_or_marked_at_every_length(void)
{
    for (uint16_t length = 0; length <= TELEMETRY_LINE_MAX; length++) {
        char filler[TELEMETRY_LINE_MAX];

        memset(filler, 'x', sizeof filler);
        telemetry_begin(&line);
        telemetry_characters(&line, filler, length);
        telemetry_end(&line);
        TEST_ASSERT_EQUAL(length > TELEMETRY_LINE_MAX - 2U, line.overflowed);
        if (!line.overflowed) {
            TEST_ASSERT_EQUAL(length + 2U, line.length);
            TEST_ASSERT_EQUAL_STRING_LEN("\r\n", &line.text[length], 2);
        }
    }
}

void test_an_answer_may_have_240_characters_and_not_one_more(void)
{
    char filler[TELEMETRY_ANSWER_MAX + 1U];

    memset(filler, 'x', sizeof filler);
    for (uint16_t length = 0; length <= TELEMETRY_ANSWER_MAX + 1U; length++) {
        telemetry_begin_answer(&line);
        telemetry_characters(&line, filler, length);
        telemetry_end(&line);
        TEST_ASSERT_EQUAL(length > 238U, line.overflowed);
        if (!line.overflowed) {
            TEST_ASSERT_EQUAL(length + 2U, line.length);
            TEST_ASSERT_EQUAL_STRING_LEN("\r\n", &line.text[length], 2);
        }
    }
}

void test_the_status_line_keeps_to_one_packet_after_an_answer(void)
{
    telemetry_t telemetry = flying();

    telemetry_begin_answer(&line);
    telemetry_status(&line, &telemetry);
    TEST_ASSERT_EQUAL(TELEMETRY_LINE_MAX, line.limit);
    telemetry_begin_answer(&line);
    TEST_ASSERT_EQUAL(TELEMETRY_ANSWER_MAX, line.limit);
    telemetry_begin(&line);
    TEST_ASSERT_EQUAL(TELEMETRY_LINE_MAX, line.limit);
}

void test_a_pulse_is_a_line_of_at_most_eight_octets_in_tenths_of_a_microsecond(void)
{
    telemetry_pulse(&line, 1999.68F);
    TEST_ASSERT_EQUAL_STRING_LEN("P19997\r\n", line.text, 8);
    TEST_ASSERT_EQUAL_UINT16(8, line.length);
    telemetry_pulse(&line, 999.36F);
    TEST_ASSERT_EQUAL_STRING_LEN("P9994\r\n", line.text, 7);
    TEST_ASSERT_EQUAL_UINT16(7, line.length);
}
