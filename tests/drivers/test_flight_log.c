#include "drivers/flight_log.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

static const flight_log_t flying = {123456U, 598.0F, 601.0F, -12.0F, 0.6F,    7.123F, -0.0123F,
                                    0.0345F, 2U,     5U,     -1.25F, 1383.6F, 72.5F};

static telemetry_line_t line;

void setUp(void) {}

void tearDown(void) {}

static const char *text(void)
{
    static char copy[TELEMETRY_ANSWER_MAX + 1U];

    TEST_ASSERT_FALSE(line.overflowed);
    memcpy(copy, line.text, line.length);
    copy[line.length] = '\0';
    return copy;
}

static flight_log_t round_trip(const flight_log_t *record)
{
    uint16_t cells[FLIGHT_LOG_CELLS];
    flight_log_t back;

    flight_log_pack(cells, record);
    flight_log_unpack(&back, cells);
    return back;
}

void test_a_row_is_pinned(void)
{
    telemetry_begin_answer(&line);
    flight_log_row(&line, &flying, "FLYING");
    TEST_ASSERT_EQUAL_STRING(
        "123.456,0.598,0.601,-0.012,0.600,7.123,-0.0123,0.0345,FLYING,5,-1.250,1383.6,0.072", text());
}

void test_the_title_line_names_as_many_columns_as_a_row_has(void)
{
    size_t titles = 0, columns = 0;

    telemetry_begin_answer(&line);
    flight_log_titles(&line);
    TEST_ASSERT_EQUAL_STRING("t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,"
                             "up_mps2,pulse_us,age_s",
                             text());
    for (const char *p = text(); (p = strchr(p, ',')) != NULL; p++) {
        titles++;
    }
    telemetry_begin_answer(&line);
    flight_log_row(&line, &flying, "FLYING");
    for (const char *p = text(); (p = strchr(p, ',')) != NULL; p++) {
        columns++;
    }
    TEST_ASSERT_EQUAL(titles, columns);
}

void test_packing_keeps_every_field_within_half_a_step(void)
{
    for (int i = -320; i <= 320; i++) {
        const float x = (float)i;
        const flight_log_t record = {(uint32_t)(i + 320) * UINT32_C(6700417),
                                     x * 101.3F,
                                     -x * 99.9F,
                                     x * 7.7F,
                                     x * 0.0101F,
                                     fabsf(x) * 0.0367F,
                                     x * 0.0098F,
                                     -x * 0.0097F,
                                     (uint16_t)((i + 320) % 16),
                                     (uint16_t)((i + 320) * 6),
                                     x * 0.0987F,
                                     fabsf(x) * 9.87F,
                                     fabsf(x) * 3.3F};
        const flight_log_t back = round_trip(&record);

        TEST_ASSERT_EQUAL_UINT32(record.time_ms, back.time_ms);
        TEST_ASSERT_FLOAT_WITHIN(0.51F, record.height_mm, back.height_mm);
        TEST_ASSERT_FLOAT_WITHIN(0.51F, record.estimate_mm, back.estimate_mm);
        TEST_ASSERT_FLOAT_WITHIN(0.51F, record.innovation_mm, back.innovation_mm);
        TEST_ASSERT_FLOAT_WITHIN(0.00051F, record.reference_m, back.reference_m);
        TEST_ASSERT_FLOAT_WITHIN(0.00051F, record.thrust_n, back.thrust_n);
        TEST_ASSERT_FLOAT_WITHIN(0.000051F, record.roll_rad, back.roll_rad);
        TEST_ASSERT_FLOAT_WITHIN(0.000051F, record.pitch_rad, back.pitch_rad);
        TEST_ASSERT_EQUAL_UINT16(record.state, back.state);
        TEST_ASSERT_EQUAL_UINT16(record.flags, back.flags);
        TEST_ASSERT_FLOAT_WITHIN(0.00051F, record.up_mps2, back.up_mps2);
        TEST_ASSERT_FLOAT_WITHIN(0.051F, record.pulse_us, back.pulse_us);
        TEST_ASSERT_FLOAT_WITHIN(0.51F, record.age_ms, back.age_ms);
    }
}

void test_what_is_not_there_stays_so_and_leaves_its_column_empty(void)
{
    const flight_log_t nothing = {7U, NAN, NAN, NAN, NAN, NAN, NAN, NAN, 0U, 0U, NAN, NAN, NAN};
    const flight_log_t back = round_trip(&nothing);

    TEST_ASSERT_TRUE(isnan(back.height_mm) && isnan(back.estimate_mm) && isnan(back.innovation_mm));
    TEST_ASSERT_TRUE(isnan(back.reference_m) && isnan(back.thrust_n) && isnan(back.roll_rad) &&
                     isnan(back.pitch_rad));
    TEST_ASSERT_TRUE(isnan(back.up_mps2) && isnan(back.pulse_us) && isnan(back.age_ms));
    telemetry_begin_answer(&line);
    flight_log_row(&line, &back, "GROUND");
    TEST_ASSERT_EQUAL_STRING("0.007,,,,,,,,GROUND,0,,,", text());
}

void test_what_is_beyond_the_range_becomes_its_end(void)
{
    const flight_log_t high = {0U,       1.0e9F, INFINITY, 40000.0F, 99.0F,    1000.0F, 4.0F,
                               INFINITY, 0U,     0U,       1.0e9F,   INFINITY, 1.0e9F};
    const flight_log_t low = {0U,        -1.0e9F, -INFINITY, -40000.0F, -99.0F, -1.0F, -4.0F,
                              -INFINITY, 0U,      0U,        -INFINITY, -1.0F,  -1.0F};
    flight_log_t back = round_trip(&high);

    TEST_ASSERT_EQUAL_FLOAT(32767.0F, back.height_mm);
    TEST_ASSERT_EQUAL_FLOAT(32767.0F, back.estimate_mm);
    TEST_ASSERT_EQUAL_FLOAT(32767.0F, back.innovation_mm);
    TEST_ASSERT_EQUAL_FLOAT(32.767F, back.reference_m);
    TEST_ASSERT_EQUAL_FLOAT(65.534F, back.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(3.2767F, back.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(32.767F, back.up_mps2);
    TEST_ASSERT_EQUAL_FLOAT(6553.4F, back.pulse_us);
    TEST_ASSERT_EQUAL_FLOAT(65534.0F, back.age_ms);
    TEST_ASSERT_EQUAL_FLOAT(3.2767F, back.pitch_rad);
    back = round_trip(&low);
    TEST_ASSERT_EQUAL_FLOAT(-32767.0F, back.height_mm);
    TEST_ASSERT_EQUAL_FLOAT(-32.767F, back.reference_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, back.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(-3.2767F, back.pitch_rad);
    TEST_ASSERT_EQUAL_FLOAT(-32.767F, back.up_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, back.age_ms);
}

void test_the_longest_row_is_pinned(void)
{
    const flight_log_t longest = {UINT32_C(4294967295),
                                  -32767.0F,
                                  -32767.0F,
                                  -32767.0F,
                                  -32.767F,
                                  65.534F,
                                  -3.2767F,
                                  -3.2767F,
                                  15U,
                                  4095U,
                                  -32.767F,
                                  6553.4F,
                                  65534.0F};

    telemetry_begin_answer(&line);
    flight_log_row(&line, &longest, "DESCENDING");
    TEST_ASSERT_EQUAL_STRING(
        "4294967.295,-32.767,-32.767,-32.767,-32.767,65.534,-3.2767,-3.2767,DESCENDING,4095,"
        "-32.767,6553.4,65.534",
        text());
}

void test_milliseconds_are_written_with_their_zeros(void)
{
    static const struct {
        uint32_t ms;
        const char *start;
    } rows[] = {{0U, "0.000,"}, {9U, "0.009,"}, {90U, "0.090,"}, {1001U, "1.001,"}, {60100U, "60.100,"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        flight_log_t record = flying;

        record.time_ms = rows[i].ms;
        telemetry_begin_answer(&line);
        flight_log_row(&line, &record, "FLYING");
        TEST_ASSERT_EQUAL_STRING_LEN(rows[i].start, text(), strlen(rows[i].start));
    }
}
