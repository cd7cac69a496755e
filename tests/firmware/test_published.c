/* The telemetry line and the rows of the flight recorder, as the ground station, the page and tools read
 * them. */
#include "firmware/published.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

#define NO_BEAMS ",,,,,,,,,,,,,,,,"

static telemetry_line_t line;
static published_t now;

void setUp(void)
{
    memset(&line, 0x5A, sizeof line);
    now = (published_t){
        .time_ms = 123456U,
        .height_mm = 598.0F,
        .age_us = 81234.0F,
        .roll_rad = -0.0123F,
        .pitch_rad = 0.0345F,
        .up_mps2 = -0.214F,
        .beams = flight_beams_none(),
        .laser = "OK",
        .flight = {.estimate_mm = 601.0F,
                   .innovation_mm = -12.0F,
                   .reference_m = 0.6F,
                   .thrust_n = 7.123F,
                   .battery_v = NAN,
                   .pulse_us = 1500.0F /* in no record */,
                   .state = FLIGHT_FLYING},
    };
}

void tearDown(void) {}

static void assert_text(const char *expected)
{
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

static void assert_telemetry(const char *expected)
{
    published_telemetry(&line, &now);
    TEST_ASSERT_TRUE(line.length <= TELEMETRY_LINE_MAX);
    assert_text(expected);
}

static published_t recorded(void)
{
    uint16_t cells[PUBLISHED_CELLS];
    published_t record;

    memset(&record, 0x5A, sizeof record);
    published_pack(cells, &now);
    published_unpack(&record, cells);
    return record;
}

static void assert_row(const char *expected)
{
    const published_t record = recorded();

    telemetry_begin_answer(&line);
    published_row(&line, &record);
    assert_text(expected);
}

void test_the_telemetry_line_is_the_documented_one(void)
{
    assert_telemetry("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n");
}

void test_a_number_that_is_not_there_is_a_dash(void)
{
    now.height_mm = NAN;
    now.laser = "WAIT";
    now.flight.reference_m = INFINITY;
    now.flight.thrust_n = -FLT_MAX;
    now.flight.state = FLIGHT_GROUND;
    now.flight.flags = 3U;
    assert_telemetry("alt:- ref:- laser:WAIT thr:- state:GROUND flags:3\r\n");
}

void test_a_height_below_zero_keeps_its_sign_and_a_rounded_zero_has_none(void)
{
    now.height_mm = -12.0F;
    assert_telemetry("alt:-0.012 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n");
    now.height_mm = -0.4F;
    assert_telemetry("alt:0.000 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n");
}

void test_a_doubt_or_the_cause_of_a_reset_is_one_field_more(void)
{
    now.doubt = "SIGHT";
    assert_telemetry("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 doubt:SIGHT\r\n");
    now.doubt = NULL;
    now.reset = "WATCHDOG";
    assert_telemetry("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 reset:WATCHDOG\r\n");
}

void test_with_the_longest_names_the_cause_of_a_reset_fits_the_packet(void)
{
    now.height_mm = -4000.0F;
    now.laser = "EIGHT_CH";
    now.reset = "WATCHDOG";
    now.flight.reference_m = 3.0F;
    now.flight.thrust_n = 11.76F;
    now.flight.state = FLIGHT_DESCENDING;
    now.flight.flags = 2047U;
    assert_telemetry(
        "alt:-4.000 ref:3.000 laser:EIGHT_CH thr:11.76 state:DESCENDING flags:2047 reset:WATCHDOG\r\n");
}

void test_whatever_the_numbers_are_the_line_fits_a_radio_packet(void)
{
    static const float values[] = {0.0F,    0.598F,   -4294966.5F,   4294966.5F, -1.0e6F, 4294967.0F,
                                   FLT_MAX, -FLT_MAX, INFINITY,      -INFINITY,  NAN,     FLT_MIN,
                                   1e-7F,   -0.0F,    -999999.9999F, 1e30F};
    static const uint16_t n = sizeof values / sizeof values[0];

    now.laser = "EIGHT_CH";
    now.flight.state = FLIGHT_DESCENDING;
    now.flight.flags = 65535U;
    for (uint16_t i = 0; i < n * n * n; i++) {
        now.height_mm = values[i % n];
        now.flight.reference_m = values[i / n % n];
        now.flight.thrust_n = values[i / n / n];
        published_telemetry(&line, &now);
        TEST_ASSERT_FALSE(line.overflowed);
        TEST_ASSERT_LESS_OR_EQUAL(TELEMETRY_LINE_MAX, line.length);
        TEST_ASSERT_EQUAL_STRING_LEN(" flags:65535\r\n", &line.text[line.length - 14U], 14);
    }
}

void test_the_longest_line_has_95_characters_and_one_more_is_not_to_be_sent(void)
{
    now.height_mm = -4294966500.0F;
    now.laser = "EIGHT_CH";
    now.flight.reference_m = now.flight.thrust_n = -4294966.5F;
    now.flight.state = FLIGHT_DESCENDING;
    now.flight.flags = 65535U;
    published_telemetry(&line, &now);
    TEST_ASSERT_EQUAL(95U, line.length);
    TEST_ASSERT_FALSE(line.overflowed);
    now.laser = "NINE_CHAR";
    published_telemetry(&line, &now);
    TEST_ASSERT_TRUE(line.overflowed);
}

void test_titles_and_a_row_are_pinned(void)
{
    telemetry_begin_answer(&line);
    published_titles(&line);
    assert_text("t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,up_mps2,"
                "pulse_us,age_s,bat_v,doubt,limit,bat,mf_rays,mf_mm,mf_spread_mm,mf_ms,mf_lie,m1_rays,m1_mm,"
                "m1_spread_mm,"
                "m1_ms,m1_lie,m2_rays,m2_mm,m2_spread_mm,m2_ms,m2_lie,out");
    now.flight.flags = 5U;
    assert_row(
        "123.456,0.598,0.601,-0.012,0.600,7.123,-0.0123,0.0345,FLYING,5,-0.214,1393.8,0.081,,,," NO_BEAMS);
    now.flight.reason = VERDICT_NO_EFFECT;
    now.flight.bound = BOUND_STANDING;
    assert_row(
        "123.456,0.598,0.601,-0.012,0.600,7.123,-0.0123,0.0345,FLYING,5,-0.214,1393.8,0.081,,THRUST/noeffect,"
        "STANDING," NO_BEAMS);
    now.flight.battery = BATTERY_LOW;
    now.flight.battery_v = 14.376F;
    assert_row("123.456,0.598,0.601,-0.012,0.600,7.123,-0.0123,0.0345,FLYING,5,-0.214,1393.8,0.081,14.38,"
               "THRUST/noeffect,STANDING,LOW" NO_BEAMS);
}

void test_the_longest_row_is_pinned(void)
{
    now = (published_t){
        .time_ms = UINT32_C(4294967295),
        .height_mm = -1e9F,
        .age_us = 1e9F,
        .up_mps2 = -99.0F,
        .roll_rad = -4.0F,
        .pitch_rad = -INFINITY,
        .flight = {.estimate_mm = -40000.0F,
                   .innovation_mm = -INFINITY,
                   .reference_m = -99.0F,
                   .thrust_n = -99.0F,
                   .state = FLIGHT_DESCENDING,
                   .reason = VERDICT_NO_EFFECT,
                   .bound = BOUND_STANDING,
                   .battery = BATTERY_FROZEN,
                   .battery_v = -99.0F,
                   .flags = 65535U},
        .beams = {.left_out = 7U},
    };
    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; m++) {
        now.beams.beam[m] = (flight_beam_t){1e6F, 1e6F, 1e6F, 1e9F, 1.0F};
    }
    assert_row("4294967.295,-32.767,-32.767,-32.767,-32.767,-32.767,-3.2767,-3.2767,DESCENDING,4095,"
               "-32.767,1999.7,32.767,-32.77,THRUST/"
               "noeffect,STANDING,FROZEN,62,4095,254,248,100,62,4095,254,248,100,62,4095,"
               "254,248,100,mf+m1+m2");
}

/* With "OK LOG 1228 " before it, and its sum and line end behind it. */
void test_the_titles_and_the_longest_row_fit_an_answer(void)
{
    telemetry_begin_answer(&line);
    telemetry_text(&line, "OK LOG 0 ");
    published_titles(&line);
    telemetry_sum(&line);
    telemetry_end(&line);
    TEST_ASSERT_FALSE(line.overflowed);
}

void test_a_row_tells_each_beam_and_who_was_left_out(void)
{
    now.beams.beam[FLIGHT_BEAM_F] = (flight_beam_t){35.0F, 612.0F, 9.0F, 84000.0F, 0.0F};
    now.beams.beam[FLIGHT_BEAM_1] = (flight_beam_t){8.0F, 131.0F, 4.0F, 108000.0F, 1.0F};
    now.beams.beam[FLIGHT_BEAM_2].rays = 1.0F;
    now.beams.left_out = 1U << FLIGHT_BEAM_1;
    assert_row(
        "123.456,0.598,0.601,-0.012,0.600,7.123,-0.0123,0.0345,FLYING,0,-0.214,1393.8,0.081,,,,,35,612,9,84,"
        "0,8,131,4,108,100,1,,,,,m1");
}

void test_what_is_not_there_leaves_its_column_empty(void)
{
    now = (published_t){
        .time_ms = 7U,
        .height_mm = NAN,
        .age_us = NAN,
        .up_mps2 = NAN,
        .roll_rad = NAN,
        .pitch_rad = NAN,
        .flight = {.estimate_mm = NAN,
                   .innovation_mm = NAN,
                   .reference_m = NAN,
                   .thrust_n = NAN,
                   .battery_v = NAN,
                   .state = FLIGHT_GROUND},
        .beams = flight_beams_none(),
    };
    assert_row("0.007,,,,,,,,GROUND,0,,1999.7,,,,," NO_BEAMS);
}

void test_every_millimetre_of_a_recorded_height_is_written_as_it_is(void)
{
    for (int mm = -5000; mm <= 5000; mm++) {
        char expected[48];

        now.height_mm = (float)mm;
        snprintf(expected, sizeof expected, "123.456,%s%d.%03d,", mm < 0 ? "-" : "", abs(mm) / 1000,
                 abs(mm) % 1000);
        const published_t record = recorded();
        telemetry_begin_answer(&line);
        published_row(&line, &record);
        TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, strlen(expected));
    }
}

void test_every_reason_every_limit_and_every_word_on_the_battery_is_recorded(void)
{
    for (uint16_t reason = 0U; reason < VERDICT_COUNT; reason++) {
        for (uint16_t bound = 0U; bound < BOUND_COUNT; bound++) {
            now.flight.reason = reason;
            now.flight.bound = bound;
            now.flight.battery = (uint16_t)((reason + bound) % BATTERY_VERDICT_COUNT);
            const published_t record = recorded();
            TEST_ASSERT_EQUAL_UINT16(reason, record.flight.reason);
            TEST_ASSERT_EQUAL_UINT16(bound, record.flight.bound);
            TEST_ASSERT_EQUAL_UINT16(now.flight.battery, record.flight.battery);
        }
    }
}

void test_every_reason_and_every_limit_fits_the_packet(void)
{
    now.height_mm = -4000.0F;
    now.laser = "SWITCH"; /* the longest that a flight can show */
    now.flight.reference_m = 3.0F;
    now.flight.thrust_n = 11.76F;
    now.flight.state = FLIGHT_DESCENDING;
    now.flight.flags = 2047U;
    for (uint16_t reason = 1U; reason < VERDICT_COUNT; reason++) {
        now.doubt = verdict_name(reason);
        published_telemetry(&line, &now);
        TEST_ASSERT_TRUE(!line.overflowed && line.length <= TELEMETRY_LINE_MAX);
    }
    now.doubt = NULL;
    for (uint16_t bound = 1U; bound < BOUND_COUNT; bound++) {
        now.limit = bound_name(bound);
        published_telemetry(&line, &now);
        TEST_ASSERT_TRUE(!line.overflowed && line.length <= TELEMETRY_LINE_MAX);
    }
    now.limit = NULL;
    now.battery = "14.8/ABSENT";
    published_telemetry(&line, &now);
    TEST_ASSERT_TRUE(!line.overflowed && line.length <= TELEMETRY_LINE_MAX);
}

void test_the_battery_is_one_field_more(void)
{
    now.battery = "14.1/LOW";
    assert_telemetry("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 bat:14.1/LOW\r\n");
}

void test_every_state_is_recorded(void)
{
    for (uint16_t state = 0U; state < FLIGHT_STATE_COUNT; state++) {
        now.flight.state = (flight_state_t)state;
        now.flight.flags = 4095U;
        TEST_ASSERT_EQUAL_UINT16(state, recorded().flight.state);
        TEST_ASSERT_EQUAL_UINT16(4095U, recorded().flight.flags);
        TEST_ASSERT_EQUAL_UINT32(123456U, recorded().time_ms);
    }
}

static flight_beams_t told(uint32_t now_us)
{
    return published_beams_of(&now.flight, now_us);
}

void test_the_beams_are_those_of_the_latest_scan_and_their_age_goes_on(void)
{
    now.flight.signal = (scan_signal_t){.scans = 7U, .arrival_us = UINT32_C(4294967000)};
    now.flight.signal.beams[MIRROR_AFT] = (beam_signal_t){true, true, 8U, 612.4F, 9.0F, 70500U};
    now.flight.signal.beams[MIRROR_FORE] = (beam_signal_t){true, false, 1U, 3.0F, 3.0F, 3U};
    now.flight.lies[MIRROR_AFT] = 0.75F;
    now.flight.left_out = 1U << MIRROR_AFT;
    const flight_beams_t beams = told(200U);

    TEST_ASSERT_EQUAL_FLOAT(8.0F, beams.beam[FLIGHT_BEAM_1].rays);
    TEST_ASSERT_EQUAL_FLOAT(612.4F, beams.beam[FLIGHT_BEAM_1].slant_mm);
    TEST_ASSERT_EQUAL_FLOAT(9.0F, beams.beam[FLIGHT_BEAM_1].spread_mm);
    TEST_ASSERT_EQUAL_FLOAT(70996.0F, beams.beam[FLIGHT_BEAM_1].age_us);
    TEST_ASSERT_EQUAL_FLOAT(0.75F, beams.beam[FLIGHT_BEAM_1].lie);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, beams.beam[FLIGHT_BEAM_2].rays);
    TEST_ASSERT_TRUE(isnan(beams.beam[FLIGHT_BEAM_2].slant_mm) &&
                     isnan(beams.beam[FLIGHT_BEAM_2].spread_mm) && isnan(beams.beam[FLIGHT_BEAM_2].age_us));
    TEST_ASSERT_TRUE(isnan(beams.beam[FLIGHT_BEAM_F].rays));
    TEST_ASSERT_EQUAL_UINT16(1U << FLIGHT_BEAM_1, beams.left_out);
}

void test_before_the_first_scan_no_beam_is_known(void)
{
    now.flight.signal = (scan_signal_t){.scans = 0U};
    now.flight.signal.beams[MIRROR_FRONT].looked = true;
    TEST_ASSERT_TRUE(isnan(told(0U).beam[FLIGHT_BEAM_F].rays));
}
