#include "drivers/flight_log.h"

#include <math.h>
#include <string.h>

#include "unity.h"

static telemetry_line_t line;

void setUp(void)
{
    telemetry_begin(&line);
}

void tearDown(void) {}

static void assert_line(const char *expected)
{
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

void test_a_cell_keeps_a_number_within_half_a_step(void)
{
    static const float steps[] = {1.0F, 0.001F, 1000.0F, 10000.0F};

    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        const flight_log_scale_t scale = (flight_log_scale_t)i;

        for (int n = -320; n <= 320; n++) {
            const float value = (float)n * 101.3F / steps[i];

            TEST_ASSERT_FLOAT_WITHIN(0.51F / steps[i], value,
                                     flight_log_value(flight_log_cell(value, scale), scale));
        }
    }
}

void test_a_cell_comes_back_as_it_was(void)
{
    for (uint32_t cell = 0U; cell <= 0xFFFFU; cell += 13U) {
        if (cell != 0x8000U) {
            TEST_ASSERT_EQUAL_HEX32(
                cell, flight_log_cell(flight_log_value((uint16_t)cell, FLIGHT_LOG_MILLI), FLIGHT_LOG_MILLI));
        }
    }
}

void test_what_is_not_there_stays_so(void)
{
    TEST_ASSERT_TRUE(isnan(flight_log_value(flight_log_cell(NAN, FLIGHT_LOG_MILLI), FLIGHT_LOG_MILLI)));
    TEST_ASSERT_TRUE(isnan(flight_log_value(flight_log_cell(NAN, FLIGHT_LOG_4), FLIGHT_LOG_4)));
}

void test_what_is_beyond_the_range_becomes_its_end(void)
{
    static const float high[] = {32767.6F, 40000.0F, 1.0e9F, INFINITY};

    for (size_t i = 0; i < sizeof high / sizeof high[0]; i++) {
        TEST_ASSERT_EQUAL_FLOAT(
            32767.0F, flight_log_value(flight_log_cell(high[i], FLIGHT_LOG_MILLI), FLIGHT_LOG_MILLI));
        TEST_ASSERT_EQUAL_FLOAT(
            -32767.0F, flight_log_value(flight_log_cell(-high[i], FLIGHT_LOG_MILLI), FLIGHT_LOG_MILLI));
        TEST_ASSERT_EQUAL_FLOAT(3.2767F,
                                flight_log_value(flight_log_cell(high[i], FLIGHT_LOG_4), FLIGHT_LOG_4));
    }
}

void test_a_number_is_shown_in_the_unit_of_its_column(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.598F, flight_log_shown(598.0F, FLIGHT_LOG_MILLI));
    TEST_ASSERT_EQUAL_FLOAT(0.081234F, flight_log_shown(81234.0F, FLIGHT_LOG_MICRO));
    TEST_ASSERT_EQUAL_FLOAT(7.12F, flight_log_shown(7.12F, FLIGHT_LOG_3));
    TEST_ASSERT_EQUAL_FLOAT(-0.05F, flight_log_shown(-0.05F, FLIGHT_LOG_4));
}

void test_columns_begin_with_a_comma_and_one_without_a_value_is_empty(void)
{
    flight_log_time(&line, UINT32_C(4294967295));
    flight_log_number(&line, -0.0123F, 4U);
    flight_log_number(&line, NAN, 3U);
    flight_log_text(&line, "FLYING");
    flight_log_count(&line, 4095U);
    assert_line("4294967.295,-0.0123,,FLYING,4095");
}

void test_milliseconds_are_written_with_their_zeros(void)
{
    static const struct {
        uint32_t ms;
        const char *text;
    } rows[] = {{0U, "0.000"},  {9U, "0.009"},    {10U, "0.010"},
                {90U, "0.090"}, {1001U, "1.001"}, {60100U, "60.100"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        telemetry_begin(&line);
        flight_log_time(&line, rows[i].ms);
        assert_line(rows[i].text);
    }
}
