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

void test_fields_are_parted_by_a_blank(void)
{
    telemetry_field_number(&line, "alt", 0.598F, 3U);
    telemetry_field_text(&line, "laser", "OK");
    telemetry_field_count(&line, "flags", 257U);
    telemetry_field_number(&line, "thr", 7.12F, 2U);
    assert_line("alt:0.598 laser:OK flags:257 thr:7.12");
    telemetry_begin(&line);
    telemetry_text(&line, "P");
    telemetry_field_count(&line, "flags", 1U);
    assert_line("P flags:1");
}

void test_a_field_without_a_name_or_a_text_is_not_in_the_line(void)
{
    telemetry_field_number(&line, NULL, 1.0F, 3U);
    telemetry_field_text(&line, NULL, "OK");
    telemetry_field_text(&line, "doubt", NULL);
    telemetry_field_count(&line, NULL, 1U);
    assert_line("");
    telemetry_field_count(&line, "flags", 0U);
    assert_line("flags:0");
}

void test_a_field_keeps_its_sign_but_not_that_of_a_rounded_zero(void)
{
    telemetry_field_number(&line, "alt", -0.012F, 3U);
    telemetry_field_number(&line, "ref", -0.0004F, 3U);
    assert_line("alt:-0.012 ref:0.000");
}

void test_a_value_that_cannot_be_written_becomes_a_dash(void)
{
    telemetry_field_number(&line, "alt", NAN, 3U);
    telemetry_field_number(&line, "ref", INFINITY, 3U);
    telemetry_field_number(&line, "thr", -FLT_MAX, 2U);
    assert_line("alt:- ref:- thr:-");
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

/* Check value of CRC-16/CCITT-FALSE. */
void test_a_sum_is_a_star_and_four_digits(void)
{
    telemetry_text(&line, "123456789");
    telemetry_sum(&line);
    assert_line("123456789*29B1");
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

void test_an_answer_may_have_256_characters_and_not_one_more(void)
{
    char filler[TELEMETRY_ANSWER_MAX + 1U];

    memset(filler, 'x', sizeof filler);
    for (uint16_t length = 0; length <= TELEMETRY_ANSWER_MAX + 1U; length++) {
        telemetry_begin_answer(&line);
        telemetry_characters(&line, filler, length);
        telemetry_end(&line);
        TEST_ASSERT_EQUAL(length > 254U, line.overflowed);
        if (!line.overflowed) {
            TEST_ASSERT_EQUAL(length + 2U, line.length);
            TEST_ASSERT_EQUAL_STRING_LEN("\r\n", &line.text[length], 2);
        }
    }
}

void test_a_line_keeps_to_one_packet_after_an_answer(void)
{
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
    telemetry_pulse(&line, 1999.64F);
    TEST_ASSERT_EQUAL_STRING_LEN("P19996\r\n", line.text, 8);
    telemetry_pulse(&line, 999.36F);
    TEST_ASSERT_EQUAL_STRING_LEN("P9994\r\n", line.text, 7);
    TEST_ASSERT_EQUAL_UINT16(7, line.length);
}
