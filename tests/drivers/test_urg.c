#include "unity.h"

#include <stdlib.h>
#include <string.h>

#include "drivers/urg.h"
#include "tests/support/scip_frames.h"

#define POINTS 35U
#define STEP_US 150000U

static urg_driver_t urg;
static uint16_t memory[2U * POINTS + 1U];
static urg_output_t output;
static urg_report_t report;
static uint32_t now_us;

static const urg_config_t config = {
    .first_rate = 115200U,
    .stream_rate = 250000U,
    .fastest_rate = 250000U,
    .stream = SCIP_STREAM_2,
    .range = {372U, 406U, 1U, 0U, 0U},
};

void setUp(void)
{
    now_us = 0xFFFFF000U;
    memset(memory, 0, sizeof memory);
    TEST_ASSERT_TRUE(urg_init(&urg, &config, memory, 2U * POINTS, now_us));
}

void tearDown(void) {}

/* In memory of its own: sanitizers see a look beyond its end. */
static bool feed(const char *text)
{
    const size_t count = strlen(text);
    octet_t *octets = malloc(count * sizeof *octets);
    bool complete;

    TEST_ASSERT_NOT_NULL(octets);
    for (size_t i = 0U; i < count; i++) {
        octets[i] = (octet_t)text[i];
    }
    complete = urg_feed(&urg, octets, count);
    free(octets);
    return complete;
}

/* A frame of the stream; every distance the same: two characters. */
static const char *frame(unsigned long stamp_ms, const char *distance)
{
    static char text[200];
    char data[2U * POINTS];

    for (size_t i = 0U; i < sizeof data; i++) {
        data[i] = distance[i % 2U];
    }
    scip_frames_frame(text, "MS0372040601000", stamp_ms, data, sizeof data);
    return text;
}

static const char *step(void)
{
    static char sent[SCIP_REQUEST_MAX + 1U];

    now_us += STEP_US;
    urg_step(&urg, now_us);
    (void)urg_next_to_send(&urg, &output);
    for (uint16_t i = 0U; i < output.count; i++) {
        sent[i] = (char)output.octets[i];
    }
    sent[output.count] = '\0';
    return sent;
}

static urg_status_t status(void)
{
    urg_report(&urg, &report);
    return report.status;
}

static void reach_stream(void)
{
    TEST_ASSERT_EQUAL_STRING("\nL0\n", step());
    TEST_ASSERT_FALSE(feed("L0\n0\n\n"));
    TEST_ASSERT_EQUAL_STRING("SCIP2.0\n", step());
    (void)feed("SCIP2.0\n0\n\n");
    TEST_ASSERT_EQUAL_STRING("SS250000\n", step());
    (void)feed("SS250000\n00P\n\n");
    TEST_ASSERT_EQUAL_STRING("", step());
    TEST_ASSERT_EQUAL_STRING("\nQT\n", step());
    TEST_ASSERT_TRUE(output.set_rate);
    TEST_ASSERT_EQUAL_UINT32(250000U, output.rate);
    (void)feed("QT\n00P\n\n");
    TEST_ASSERT_EQUAL_STRING("MS0372040601000\n", step());
    TEST_ASSERT_FALSE(output.set_rate);
    (void)feed("MS0372040601000\n00P\n\n");
}

static void assert_scan(uint32_t stamp_ms, uint16_t distance_mm)
{
    scip_scan_t scan;

    TEST_ASSERT_TRUE(urg_take_scan(&urg, &scan));
    TEST_ASSERT_EQUAL_UINT32(stamp_ms, scan.timestamp_ms);
    TEST_ASSERT_EQUAL_UINT16(POINTS, scan.points);
    TEST_ASSERT_EQUAL_UINT16(372U, scan.first_step);
    for (uint16_t i = 0U; i < POINTS; i++) {
        TEST_ASSERT_EQUAL_UINT16(distance_mm, scan.distance_mm[i]);
    }
    TEST_ASSERT_FALSE_MESSAGE(urg_take_scan(&urg, &scan), "a scan comes once");
}

void test_from_power_up_to_the_first_scan(void)
{
    scip_scan_t none;

    reach_stream();
    TEST_ASSERT_FALSE(urg_take_scan(&urg, &none));
    TEST_ASSERT_TRUE(feed(frame(32U, "9H")));
    (void)step();
    TEST_ASSERT_EQUAL(URG_OK, status());
    TEST_ASSERT_EQUAL_UINT32(250000U, report.rate);
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.scan_count);
    TEST_ASSERT_EQUAL_UINT32(1U, report.scip.scans);
    TEST_ASSERT_EQUAL_UINT32(0U, report.restarts);
    TEST_ASSERT_EQUAL_UINT32(0U, report.timeouts);
    assert_scan(32U, 9U * 64U + 24U);
}

void test_a_scan_stays_while_the_next_one_comes_in(void)
{
    char most[128] = "";

    reach_stream();
    (void)feed(frame(32U, "9H"));
    memcpy(most, frame(64U, "0F"), 96U);
    TEST_ASSERT_FALSE(feed(most));
    assert_scan(32U, 600U);
    TEST_ASSERT_TRUE(feed(&frame(64U, "0F")[96]));
    assert_scan(64U, 22U);
}

void test_two_scans_and_a_notice_may_come_at_once(void)
{
    char text[400] = "";

    reach_stream();
    strcpy(text, frame(32U, "9H"));
    strcpy(&text[101], "MS0372040601000\n98a\n\n");
    strcpy(&text[101 + 21], frame(64U, "0F"));
    strcpy(&text[101 + 21 + 101], "MS03");
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(5U, report.seen.reply_count);
    const uint32_t before = report.seen.octet_count;
    TEST_ASSERT_TRUE(feed(text));
    assert_scan(64U, 22U);
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(2U, report.seen.scan_count);
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.notice_count);
    TEST_ASSERT_EQUAL_UINT32(2U * 101U + 21U + 4U, report.seen.octet_count - before);
    TEST_ASSERT_EQUAL_UINT16(97U, urg_expected(&urg));
}

/* A scan 30 ms before the latest step: the next one would be late 100 ms behind that step. */
void test_the_step_behind_a_missing_frame_is_asked_for_as_soon_as_it_is_known(void)
{
    reach_stream();
    TEST_ASSERT_EQUAL_UINT32(150000U, urg_pause_us(&urg));
    (void)feed(frame(32U, "9H"));
    now_us += 120000U;
    urg_scan_at(&urg, now_us);
    now_us -= 120000U;
    (void)step();
    TEST_ASSERT_EQUAL_UINT32(100000U, urg_pause_us(&urg));
    urg_scan_at(&urg, now_us + 70000U);
    TEST_ASSERT_EQUAL_UINT32(150000U, urg_pause_us(&urg));
    (void)step();
    (void)step();
    TEST_ASSERT_EQUAL(URG_LOST, status());
    TEST_ASSERT_EQUAL_UINT32(115200U, output.rate);
    TEST_ASSERT_EQUAL_UINT32(urg_pause_us(&urg), report.pause_us);
}

/* Octets that came since the latest step count: in a stream the next frame has begun, in a search it is news.
 */
void test_what_was_fed_since_the_latest_step_changes_the_pause(void)
{
    static const octet_t strange[] = {0x80U, 0x80U, 0x80U};

    reach_stream();
    (void)feed(frame(32U, "9H"));
    urg_scan_at(&urg, now_us + STEP_US - 30000U);
    (void)step();
    TEST_ASSERT_EQUAL_UINT32(100000U, urg_pause_us(&urg));
    (void)feed("M");
    TEST_ASSERT_EQUAL_UINT32(150000U, urg_pause_us(&urg));
    (void)step();
    (void)step();
    (void)step();
    (void)step();
    TEST_ASSERT_EQUAL(URG_LOST, status());
    TEST_ASSERT_GREATER_THAN_UINT32(40000U, urg_pause_us(&urg));
    (void)urg_feed(&urg, strange, 3U);
    TEST_ASSERT_EQUAL_UINT32(40000U, urg_pause_us(&urg));
}

/* The longest command: LF, TM2, LF, MS with its range, LF. */
void test_a_lost_stream_is_asked_for_behind_an_end_of_line_and_of_time_mode(void)
{
    const char *sent = "";

    reach_stream();
    urg.link.config.first_rate = config.stream_rate; /* it powers up there; else they go one by one */
    (void)feed(frame(32U, "9H"));
    for (unsigned i = 0U; i < 20U && strstr(sent, "MS") == NULL; i++) {
        sent = step();
    }
    TEST_ASSERT_EQUAL_STRING("\nTM2\nMS0372040601000\n", sent);
    TEST_ASSERT_EQUAL_UINT16(SCIP_REQUEST_MAX, output.count);
}

/* What the sensor holds of the first one would spoil the second. */
void test_a_repeated_command_has_an_end_of_line_first(void)
{
    (void)step();
    (void)feed("L0\n0\n\n");
    TEST_ASSERT_EQUAL_STRING("SCIP2.0\n", step());
    TEST_ASSERT_EQUAL_STRING("", step());
    TEST_ASSERT_EQUAL_STRING("", step());
    TEST_ASSERT_EQUAL_STRING("\nSCIP2.0\n", step());
}

void test_an_empty_line_before_the_first_answer_is_nothing(void)
{
    TEST_ASSERT_FALSE(feed("\n"));
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(0U, report.scip.skipped_lines);
}

void test_of_two_scans_that_nobody_took_the_later_one_counts(void)
{
    reach_stream();
    (void)feed(frame(32U, "9H"));
    TEST_ASSERT_TRUE(feed(frame(64U, "0F")));
    assert_scan(64U, 22U);
}

void test_the_outputs_of_a_step_come_once(void)
{
    now_us += STEP_US;
    urg_step(&urg, now_us);
    TEST_ASSERT_TRUE(urg_next_to_send(&urg, &output));
    TEST_ASSERT_EQUAL_UINT16(4U, output.count);
    TEST_ASSERT_FALSE(output.cycle_power);
    TEST_ASSERT_FALSE(urg_next_to_send(&urg, &output));
    TEST_ASSERT_EQUAL_UINT16(0U, output.count);
    TEST_ASSERT_EQUAL_UINT32(115200U, output.rate);
}

void test_line_errors_end_the_reply_under_way_and_tell_a_wrong_rate(void)
{
    (void)step();
    (void)feed("L0\n");
    urg_line_broken(&urg, 1U);
    (void)feed("0\n\n");
    TEST_ASSERT_EQUAL_STRING("", step());
    TEST_ASSERT_EQUAL(URG_STOP1, status());
    urg_line_broken(&urg, 0U);
    TEST_ASSERT_EQUAL(URG_STOP1, status());
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.framing_count);
    urg_line_broken(&urg, 9U);
    TEST_ASSERT_EQUAL_STRING("\nQT\n", step());
    TEST_ASSERT_EQUAL_UINT32(250000U, output.rate);
    TEST_ASSERT_EQUAL(URG_LOST, status());
}

void test_a_dead_sensor_is_powered_off_and_on_where_that_can_be(void)
{
    uint16_t cycles = 0U;

    for (uint16_t i = 0U; i < 300U; i++) {
        (void)step();
        cycles = (uint16_t)(cycles + (output.cycle_power ? 1U : 0U));
    }
    TEST_ASSERT_EQUAL_UINT16(2U, cycles);
    TEST_ASSERT_EQUAL(URG_LOST, status());
}

void test_the_octets_that_are_still_to_come_are_known_within_a_stream(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, urg_expected(&urg));
    reach_stream();
    TEST_ASSERT_EQUAL_UINT16(101U, urg_expected(&urg));
    (void)feed("MS03");
    TEST_ASSERT_EQUAL_UINT16(97U, urg_expected(&urg));
}

void test_damage_notices_and_old_answers_are_counted(void)
{
    char damaged[200];

    (void)step();
    (void)feed("L0\nE\n\n");
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.legacy_count);
    setUp();
    reach_stream();
    strcpy(damaged, frame(32U, "9H"));
    damaged[30] = '1';
    TEST_ASSERT_FALSE(feed(damaged));
    TEST_ASSERT_FALSE(feed("MS0372040601000\n98a\n\n"));
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.damage_count);
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SUM, report.last_damage);
    TEST_ASSERT_EQUAL_UINT32(1U, report.seen.notice_count);
}

void test_octets_above_7f_are_counted(void)
{
    static const octet_t octets[] = {0x80U, 0x7FU, 0xFFU};

    TEST_ASSERT_FALSE(urg_feed(&urg, octets, 3U));
    urg_report(&urg, &report);
    TEST_ASSERT_EQUAL_UINT32(3U, report.seen.octet_count);
    TEST_ASSERT_EQUAL_UINT32(2U, report.seen.strange_count);
}

/* With nothing else to be done, as while a slow answer is waited for. */
void test_a_power_cycle_alone_is_handed_over(void)
{
    urg.action = (urg_action_t){.cycle_power = true};
    TEST_ASSERT_TRUE(urg_next_to_send(&urg, &output));
    TEST_ASSERT_TRUE(output.cycle_power);
    TEST_ASSERT_EQUAL_UINT16(0, output.count);
    TEST_ASSERT_FALSE(output.set_rate);
    TEST_ASSERT_FALSE(urg_next_to_send(&urg, &output));
}

/* As when a stream at another rate is listened to. */
void test_a_rate_alone_is_handed_over(void)
{
    urg.action = (urg_action_t){.set_rate = true};
    TEST_ASSERT_TRUE(urg_next_to_send(&urg, &output));
    TEST_ASSERT_TRUE(output.set_rate);
    TEST_ASSERT_EQUAL_UINT16(0, output.count);
}

/* As a UTM-30LX on USB: it has no SCIP1.1, its rate is no matter, and it turns four times as fast. */
void test_a_sensor_of_1081_steps_streams_them_all(void)
{
    static const urg_config_t far = {0U,    115200U, 115200U, 0U, SCIP_STREAM_3, {0U, 1080U, 1U, 0U, 0U},
                                     1080U, false};
    static uint16_t points[2U * 1081U];
    static char data[3U * 1081U], text[3500];
    scip_scan_t scan;

    TEST_ASSERT_TRUE(urg_init(&urg, &far, points, 2U * 1081U, now_us));
    TEST_ASSERT_EQUAL_STRING("\nL0\n", step());
    (void)feed("L0\n0Ee\n\n");
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    (void)feed("QT\n00P\n\n");
    TEST_ASSERT_EQUAL_STRING("MD0000108001000\n", step());
    (void)feed("MD0000108001000\n00P\n\n");
    for (unsigned k = 0U; k < 6U; k++) {
        for (unsigned i = 0U; i < 1081U; i++) {
            scip_frames_encode(&data[3U * i], 23UL + 55UL * i + k, 3U);
        }
        scip_frames_frame(text, "MD0000108001000", 1000UL + 25UL * k, data, sizeof data);
        TEST_ASSERT_TRUE(feed(text));
    }
    (void)step();
    TEST_ASSERT_EQUAL(URG_OK, status());
    TEST_ASSERT_EQUAL_UINT32(6U, report.seen.scan_count);
    TEST_ASSERT_TRUE(urg_take_scan(&urg, &scan));
    TEST_ASSERT_EQUAL_UINT16(1081U, scan.points);
    TEST_ASSERT_EQUAL_UINT16(28U, scan.distance_mm[0]);
    TEST_ASSERT_EQUAL_UINT16(59428U, scan.distance_mm[1080]);
}

static void refused(const urg_config_t *bad, uint16_t values, urg_refusal_t cause, const char *words)
{
    const urg_driver_t before = urg;

    TEST_ASSERT_EQUAL(cause, urg_refusal(bad, values));
    TEST_ASSERT_EQUAL_STRING(words, urg_refusal_text(cause));
    TEST_ASSERT_EQUAL(cause == URG_ACCEPTED, urg_init(&urg, bad, memory, values, 0U));
    if (cause != URG_ACCEPTED) {
        TEST_ASSERT_EQUAL_MEMORY(&before, &urg, sizeof urg);
    }
}

void test_an_order_that_is_refused_changes_nothing_and_names_its_cause(void)
{
    const struct {
        urg_config_t config;
        urg_refusal_t cause;
        const char *words;
    } rows[] = {
        {{0U, 19200U, 115200U, 0U, SCIP_SINGLE_2, {0U, 34U, 1U, 0U, 0U}, 0U, false},
         URG_STREAM_KIND,
         "stream is neither MS nor MD"},
        {{0U, 38400U, 115200U, 0U, SCIP_STREAM_2, {0U, 34U, 1U, 0U, 0U}, 0U, false},
         URG_FIRST_RATE,
         "first_rate is not a rate of SCIP"},
        {{0U, 19200U, 230400U, 0U, SCIP_STREAM_2, {0U, 34U, 1U, 0U, 0U}, 0U, false},
         URG_STREAM_RATE,
         "stream_rate is not a rate of SCIP"},
        {{0U, 19200U, 250000U, 115200U, SCIP_STREAM_2, {0U, 34U, 1U, 0U, 0U}, 0U, false},
         URG_TOO_FAST,
         "a rate is above fastest_rate"},
        {{0U, 115200U, 19200U, 57600U, SCIP_STREAM_2, {0U, 34U, 1U, 0U, 0U}, 0U, false},
         URG_TOO_FAST,
         "a rate is above fastest_rate"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {735U, 769U, 1U, 0U, 0U}, 0U, false},
         URG_LAST_STEP,
         "the range ends beyond the sensor's last step"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {34U, 0U, 1U, 0U, 0U}, 0U, false},
         URG_RANGE,
         "steps, cluster, interval or count of the range are impossible"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {0U, 34U, 0U, 0U, 0U}, 0U, false},
         URG_RANGE,
         "steps, cluster, interval or count of the range are impossible"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {0U, 34U, 1U, 10U, 0U}, 0U, false},
         URG_RANGE,
         "steps, cluster, interval or count of the range are impossible"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {0U, 34U, 1U, 0U, 100U}, 0U, false},
         URG_RANGE,
         "steps, cluster, interval or count of the range are impossible"},
        {{0U, 19200U, 115200U, 0U, SCIP_STREAM_2, {0U, 35U, 1U, 0U, 0U}, 0U, false},
         URG_MEMORY,
         "the memory is too small for two scans"},
        {{0U, 19200U, 115200U, 115200U, SCIP_STREAM_3, {734U, 768U, 1U, 9U, 99U}, 0U, false},
         URG_ACCEPTED,
         "accepted"},
    };

    for (size_t i = 0U; i < sizeof rows / sizeof rows[0]; i++) {
        refused(&rows[i].config, 2U * POINTS, rows[i].cause, rows[i].words);
    }
    refused(&config, 2U * POINTS - 1U, URG_MEMORY, "the memory is too small for two scans");
    refused(&config, 2U * POINTS + 1U, URG_ACCEPTED, "accepted");
}

/* --- what the sensor tells of itself --- */

static scip_info_t info;

static const char *const version =
    "VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nPROD:SOKUIKI Sensor URG-04LX;[\n"
    "FIRM:3.1.04(02/Aug./2007);a\nPROT:SCIP 2.0;N\nSERI:H0706400;F\n\n";
static const char *const limits =
    "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\n"
    "ARES:1024;\\\nAMIN:44;7\nAMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n";
static const char *const state = "II\n00P\nLASR:OFF;7\nSTAT:Sensor works well.;8\n\n";

static void answer_questions(void)
{
    TEST_ASSERT_EQUAL_STRING("VV\n", step());
    TEST_ASSERT_EQUAL(URG_STOP2, status());
    (void)feed(version);
    TEST_ASSERT_EQUAL_STRING("PP\n", step());
    TEST_ASSERT_FALSE(urg_told(&urg));
    (void)feed(limits);
    TEST_ASSERT_EQUAL_STRING("II\n", step());
    (void)feed(state);
    TEST_ASSERT_FALSE(urg_told(&urg));
    TEST_ASSERT_EQUAL_STRING("MS0372040601000\n", step());
    TEST_ASSERT_TRUE(urg_told(&urg));
}

static void assert_all_told(void)
{
    TEST_ASSERT_EQUAL_STRING("H0706400", info.serial);
    TEST_ASSERT_EQUAL_UINT16(725U, scip_info_limits(&info).amax);
    TEST_ASSERT_EQUAL(SCIP_HEALTH_GOOD, info.health);
    TEST_ASSERT_EQUAL_UINT16(15U, info.known);
}

static void start_streaming(void)
{
    (void)feed("MS0372040601000\n00P\n\n");
    TEST_ASSERT_TRUE(feed(frame(1000U, "0o")));
    (void)step();
    TEST_ASSERT_EQUAL(URG_OK, status());
}

static void reach_stop(void)
{
    (void)step();
    (void)feed("L0\n0\n\n");
    (void)step();
    (void)feed("SCIP2.0\n0\n\n");
    (void)step();
    (void)feed("SS250000\n00P\n\n");
    (void)step();
    TEST_ASSERT_EQUAL_STRING("\nQT\n", step());
    (void)feed("QT\n00P\n\n");
}

void test_who_asks_before_the_start_is_told_before_the_first_scan(void)
{
    memset(&info, 0x55, sizeof info);
    urg_ask(&urg, &info);
    TEST_ASSERT_EQUAL_UINT16(0U, info.known);
    reach_stop();
    answer_questions();
    assert_all_told();
    start_streaming();
    TEST_ASSERT_EQUAL_STRING("", step());
}

void test_who_does_not_ask_is_told_nothing_and_a_text_harms_nobody(void)
{
    reach_stop();
    TEST_ASSERT_EQUAL_STRING("MS0372040601000\n", step());
    TEST_ASSERT_FALSE(urg_told(&urg));
    (void)feed("VV\n00P\nVEND:x;X\n\n");
    start_streaming();
}

void test_who_asks_in_a_stream_is_told_and_the_stream_goes_on(void)
{
    reach_stream();
    start_streaming();
    urg_ask(&urg, &info);
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    TEST_ASSERT_FALSE(feed(frame(1100U, "0o"))); /* it was on its way: not the awaited answer */
    (void)feed("QT\n00P\n\n");
    answer_questions();
    assert_all_told();
    (void)feed("MS0372040601000\n00P\n\n");
    TEST_ASSERT_TRUE(feed(frame(2000U, "0o")));
    (void)step();
    TEST_ASSERT_EQUAL(URG_OK, status());
    TEST_ASSERT_EQUAL_UINT32(0U, report.restarts);
    urg_ask(&urg, &info); /* again */
    TEST_ASSERT_FALSE(urg_told(&urg));
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    (void)feed("QT\n00P\n\n");
    answer_questions();
}

void test_another_range_is_ordered_in_a_stream_and_the_stream_goes_on(void)
{
    static const scip_range_t half = {372U, 405U, 2U, 0U, 0U};
    scip_scan_t scan;

    reach_stream();
    start_streaming();
    TEST_ASSERT_TRUE(urg_order(&urg, &config.range));
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", step(), "the same range");
    TEST_ASSERT_TRUE(urg_order(&urg, &half));
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    (void)feed("QT\n00P\n\n");
    TEST_ASSERT_EQUAL_STRING("MS0372040502000\n", step());
    (void)feed("MS0372040502000\n00P\n\n");
    static char text[200];
    char data[34];
    for (size_t i = 0U; i < sizeof data; i++) {
        data[i] = "0o"[i % 2U];
    }
    scip_frames_frame(text, "MS0372040502000", 3000U, data, sizeof data);
    TEST_ASSERT_TRUE(feed(text));
    TEST_ASSERT_TRUE(urg_take_scan(&urg, &scan));
    TEST_ASSERT_EQUAL_UINT16(17U, scan.points);
    TEST_ASSERT_EQUAL_UINT16(2U, scan.cluster);
    for (unsigned long i = 1U; i < 5U; i++) { /* one interruption, no more */
        TEST_ASSERT_EQUAL_STRING("", step());
        TEST_ASSERT_EQUAL(URG_OK, status());
        scip_frames_frame(text, "MS0372040502000", 3000U + 100U * i, data, sizeof data);
        TEST_ASSERT_TRUE(feed(text));
    }
    TEST_ASSERT_EQUAL_UINT32(0U, report.restarts);
}

void test_each_number_of_a_range_alone_makes_it_another_one(void)
{
    static const scip_range_t other[] = {
        {373U, 406U, 1U, 0U, 0U}, {372U, 405U, 1U, 0U, 0U}, {372U, 406U, 5U, 0U, 0U},
        {372U, 406U, 1U, 1U, 0U}, {372U, 406U, 1U, 0U, 5U},
    };
    for (size_t i = 0U; i < sizeof other / sizeof other[0]; i++) {
        setUp();
        reach_stream();
        start_streaming();
        TEST_ASSERT_TRUE(urg_order(&urg, &other[i]));
        TEST_ASSERT_EQUAL_STRING("QT\n", step());
    }
}

void test_a_range_ordered_before_the_start_is_the_one_that_is_requested(void)
{
    static const scip_range_t half = {372U, 405U, 2U, 0U, 0U};

    TEST_ASSERT_TRUE(urg_order(&urg, &half));
    TEST_ASSERT_EQUAL_STRING("\nL0\n", step());
    (void)feed("L0\n0\n\n");
    (void)step();
    (void)feed("SCIP2.0\n0\n\n");
    (void)step();
    (void)feed("SS250000\n00P\n\n");
    (void)step();
    (void)step();
    (void)feed("QT\n00P\n\n");
    TEST_ASSERT_EQUAL_STRING("MS0372040502000\n", step());
}

/* What is on the line and in the memory stays. */
void test_a_range_that_cannot_be_streamed_or_kept_changes_nothing(void)
{
    static const scip_range_t bad[] = {{372U, 407U, 1U, 0U, 0U},
                                       {406U, 372U, 1U, 0U, 0U},
                                       {372U, 406U, 0U, 0U, 0U},
                                       {0U, 769U, 99U, 0U, 0U}};

    reach_stream();
    start_streaming();
    for (size_t i = 0U; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(urg_order(&urg, &bad[i]));
        TEST_ASSERT_TRUE(feed(frame(1100U + 100U * i, "0o")));
        TEST_ASSERT_EQUAL_STRING("", step());
    }
    TEST_ASSERT_TRUE(feed(frame(2000U, "0o")));
    assert_scan(2000U, 63U);
}

/* It answers the stop late or never: then the search finds it, and asks for the new range. */
void test_a_stop_that_is_lost_while_another_range_is_ordered_is_repeated(void)
{
    static const scip_range_t half = {372U, 405U, 2U, 0U, 0U};
    const char *sent = "";

    reach_stream();
    start_streaming();
    TEST_ASSERT_TRUE(urg_order(&urg, &half));
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    for (unsigned i = 0U; i < 20U && strstr(sent, "MS0372040502000") == NULL; i++) {
        (void)feed(frame(1100U + 150U * i, "0o"));
        sent = step();
        if (strstr(sent, "QT") != NULL && i > 3U) {
            (void)feed("QT\n00P\n\n");
        }
    }
    TEST_ASSERT_NOT_NULL(strstr(sent, "MS0372040502000"));
}

void test_a_question_that_is_refused_is_left_out(void)
{
    urg_ask(&urg, &info);
    reach_stop();
    TEST_ASSERT_EQUAL_STRING("VV\n", step());
    (void)feed("VV\n0Ee\n\n");
    TEST_ASSERT_EQUAL_STRING("PP\n", step());
    (void)feed(limits);
    TEST_ASSERT_EQUAL_STRING("II\n", step());
    (void)feed(state);
    TEST_ASSERT_EQUAL_STRING("MS0372040601000\n", step());
    TEST_ASSERT_FALSE(urg_told(&urg));
    TEST_ASSERT_EQUAL_UINT16(725U, info.told.amax);
    start_streaming();
}

/* 0.4 s and 400 octets at 250000 bit/s, twice; then the scans are wanted more. */
void test_a_question_without_an_answer_is_asked_again_and_then_scans_are_wanted_more(void)
{
    uint32_t asked_us;

    urg_ask(&urg, &info);
    reach_stop();
    TEST_ASSERT_EQUAL_STRING("VV\n", step());
    asked_us = now_us;
    (void)feed("VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\n"); /* and the line breaks */
    while (step()[0] == '\0') {
    }
    TEST_ASSERT_EQUAL_UINT16(4U, output.count);
    TEST_ASSERT_UINT32_WITHIN(STEP_US, 420000U, now_us - asked_us);
    asked_us = now_us;
    while (step()[0] == '\0') {
    }
    TEST_ASSERT_EQUAL_UINT8('M', output.octets[0]);
    TEST_ASSERT_UINT32_WITHIN(STEP_US, 420000U, now_us - asked_us);
    start_streaming();
    TEST_ASSERT_FALSE(urg_told(&urg));
    TEST_ASSERT_EQUAL_STRING("", step());
}

/* The line is cut while it asks: the stream is searched as ever, and nobody asks a second time. */
void test_a_line_that_breaks_while_it_asks_in_a_stream_costs_no_second_interruption(void)
{
    reach_stream();
    start_streaming();
    urg_ask(&urg, &info);
    TEST_ASSERT_EQUAL_STRING("QT\n", step());
    for (unsigned i = 0U; i < 20U; i++) {
        (void)step();
    }
    while (status() != URG_LOST || report.rate != 250000U) {
        (void)step();
    }
    TEST_ASSERT_TRUE(feed(frame(5000U, "0o")));
    for (unsigned i = 0U; i < 3U && status() != URG_OK; i++) {
        (void)step();
        (void)feed(frame(5100U + 100U * i, "0o"));
    }
    TEST_ASSERT_EQUAL(URG_OK, status());
    TEST_ASSERT_EQUAL_STRING("", step());
    TEST_ASSERT_FALSE(urg_told(&urg));
}

/* Or in as many cells, where an octet takes a wider one. */
void test_all_that_a_user_keeps_for_35_points_fits_in_1_kib(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT(1024U,
                                   (sizeof(urg_driver_t) + 2U * POINTS * sizeof(uint16_t)) / sizeof(octet_t));
}

/* What the board stores, and gives back in the next urg_config_t. */
void test_the_report_tells_the_rate_at_which_the_sensor_powers_up(void)
{
    urg_config_t stored = config;

    urg_report(&urg, &report);
    TEST_ASSERT_FALSE(report.first_rate_known);
    TEST_ASSERT_EQUAL_UINT32(config.first_rate, report.first_rate);
    (void)step();
    (void)feed("L0\n0\n\n");
    (void)step();
    urg_report(&urg, &report);
    TEST_ASSERT_TRUE(report.first_rate_known);
    stored.first_rate = 19200U;
    stored.first_rate_known = true;
    TEST_ASSERT_TRUE(urg_init(&urg, &stored, memory, 2U * POINTS, now_us));
    urg_report(&urg, &report);
    TEST_ASSERT_TRUE(report.first_rate_known);
    TEST_ASSERT_EQUAL_UINT32(19200U, report.first_rate);
}
