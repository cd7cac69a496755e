#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_parser.h"
#include "drivers/urg_link.h"
#include "tests/support/scip_frames.h"

#define STEP_US 150000U
#define STEP_MS 150U
#define NEVER 1000000U
#define LOG_MAX 600
#define QUEUE_MAX 400

/* --- a small scripted sensor, written apart from the product
 * ------------------------------------------------------ */

static struct {
    uint32_t rate, power_up_rate;
    bool on, scip2, streaming, time_mode;
    bool knows_switch, knows_rate, knows_stream, streams, refuses_all;
    char command[80];
    uint32_t length;
    char echo[40];
    uint32_t scans_left; /* of a counted run, 0 endless */
    uint32_t clock_ms, next_frame_ms;
    uint32_t latency_steps;
    uint32_t settles_ms; /* from an order to its first frame, in place of a revolution */
    const char *rate_refusal, *stream_refusal;
} sensor;

typedef struct {
    uint32_t octet, rate, due_step;
} flying_t;

static flying_t queue[QUEUE_MAX]; /* a ring */
static uint32_t queued, taken;
static uint32_t step_number;
static uint32_t sent_to_host, sent_to_sensor; /* octets, for faults by position */
static uint32_t drop_to_host, flip_to_host, drop_to_sensor;

static void send_octet(uint32_t octet)
{
    if (queued - taken == QUEUE_MAX) {
        TEST_FAIL_MESSAGE("queue full");
    }
    queue[queued++ % QUEUE_MAX] = (flying_t){octet, sensor.rate, step_number + sensor.latency_steps};
}

static void send_text(const char *text)
{
    while (*text != '\0') {
        send_octet((uint32_t)*text++);
    }
}

static void send_status(const char *echo, const char *status)
{
    char sum[2] = {(char)(((status[0] + status[1]) & 63) + 48), '\0'};
    send_text(echo);
    send_text("\n");
    send_text(status);
    send_text(sum);
    send_text("\n\n");
}

/* 35 points of 600 mm. */
static void send_frame(void)
{
    char echo[40], text[128];
    strcpy(echo, sensor.echo);
    if (sensor.scans_left > 0) {
        sensor.scans_left--;
        echo[13] = (char)(48 + sensor.scans_left / 10);
        echo[14] = (char)(48 + sensor.scans_left % 10);
        sensor.streaming = sensor.scans_left > 0;
    }
    scip_frames_frame(text, echo, sensor.clock_ms,
                      "9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H9H", 70);
    send_text(text);
}

static void answer_1(const char *command)
{
    char reply[100];
    bool switching = strcmp(command, "SCIP2.0") == 0 && sensor.knows_switch;
    snprintf(reply, sizeof reply, "%s\n%s\n\n", command, switching || strcmp(command, "L0") == 0 ? "0" : "E");
    send_text(reply);
    sensor.scip2 = switching;
}

static void answer_rate(const char *command)
{
    uint32_t rate = (uint32_t)atol(&command[2]);
    if (!sensor.knows_rate) {
        send_status(command, sensor.rate_refusal);
    } else if (rate == sensor.rate) {
        send_status(command, "03");
    } else {
        send_status(command, "00");
        sensor.rate = rate;
    }
}

static void answer_stream(const char *command)
{
    if (strlen(command) != 15 || !sensor.knows_stream) {
        send_status(command, strlen(command) != 15 ? "0C" : sensor.stream_refusal);
        return;
    }
    send_status(command, "00");
    strcpy(sensor.echo, command);
    sensor.scans_left = (uint32_t)atol(&command[13]);
    sensor.streaming = sensor.streams;
    sensor.next_frame_ms = sensor.clock_ms + (sensor.settles_ms > 0 ? sensor.settles_ms : 100);
}

static void answer_2(const char *command)
{
    if (sensor.refuses_all || (sensor.time_mode && strncmp(command, "TM", 2) != 0)) {
        send_status(command, "0E");
    } else if (strcmp(command, "QT") == 0) {
        if (sensor.streaming) {
            send_frame();
        }
        sensor.streaming = false;
        send_status(command, "00");
    } else if (strcmp(command, "TM2") == 0) {
        send_status(command, sensor.time_mode ? "00" : "03");
        sensor.time_mode = false;
    } else if (strcmp(command, "RS") == 0) {
        send_status(command, "00");
        sensor.streaming = false;
        sensor.rate = sensor.power_up_rate;
        sensor.clock_ms = 0;
    } else if (strncmp(command, "SS", 2) == 0 && strlen(command) == 8) {
        answer_rate(command);
    } else if (strncmp(command, "MS", 2) == 0) {
        answer_stream(command);
    } else {
        send_status(command, "0E");
    }
}

static void sensor_hears(uint32_t octet)
{
    if (octet != '\n') {
        sensor.command[sensor.length] = (char)octet;
        sensor.length = (sensor.length + 1) % (sizeof sensor.command - 1);
        return;
    }
    sensor.command[sensor.length] = '\0';
    if (sensor.length > 0) {
        (sensor.scip2 ? answer_2 : answer_1)(sensor.command);
    }
    sensor.length = 0;
}

static void sensor_runs(uint32_t ms)
{
    for (; ms > 0 && sensor.on; ms--) {
        sensor.clock_ms++;
        if (sensor.streaming && sensor.clock_ms >= sensor.next_frame_ms) {
            sensor.next_frame_ms += 100;
            send_frame();
        }
    }
}

static void sensor_powers_up(void)
{
    sensor.on = true;
    sensor.scip2 = sensor.streaming = sensor.time_mode = false;
    sensor.rate = sensor.power_up_rate;
    sensor.length = 0;
    sensor.clock_ms = 0;
}

/* --- the host
 * ----------------------------------------------------------------------------------------------------- */

static scip_parser_t parser;
static scip_scan_t scan;
static uint16_t points[35];
static urg_link_t link_;
static urg_config_t config;
static urg_seen_t seen;
static urg_action_t action;
static uint32_t now_us;
static uint32_t host_rate;
static uint32_t power_cycles;

static struct {
    char text[SCIP_REQUEST_MAX + 1];
    uint32_t step, rate;
    urg_status_t status;
} asked[LOG_MAX];
static uint32_t asked_count;

static void host_hears(void)
{
    for (; taken != queued && queue[taken % QUEUE_MAX].due_step <= step_number; taken++) {
        const flying_t *flying = &queue[taken % QUEUE_MAX];
        uint32_t octet = flying->octet;
        sent_to_host++;
        if (flying->rate != host_rate) {
            seen.framing_count++;
            scip_parser_line_broken(&parser);
            continue;
        }
        if (sent_to_host == drop_to_host) {
            continue;
        }
        octet ^= sent_to_host == flip_to_host ? 4U : 0U;
        const octet_t heard = (octet_t)octet;
        urg_seen_event(&seen, &parser, scip_parser_feed(&parser, heard));
    }
}

static void host_sends(void)
{
    if (asked_count == LOG_MAX) {
        asked_count = LOG_MAX / 2;
    }
    memset(&asked[asked_count], 0, sizeof asked[0]);
    for (uint16_t i = 0; i < action.request.text_length; i++) {
        asked[asked_count].text[i] = (char)action.request.text[i];
        sent_to_sensor++;
        if (sensor.on && host_rate == sensor.rate && sent_to_sensor != drop_to_sensor) {
            sensor_hears(action.request.text[i]);
        }
    }
    asked[asked_count].step = step_number;
    asked[asked_count].rate = host_rate;
    asked[asked_count].status = link_.status;
    asked_count++;
}

/* One step of 150 ms: what came since the last one is seen, the machine acts, the sensor answers. */
static void step(void)
{
    host_hears();
    urg_seen_octets(&seen, &parser);
    urg_link_step(&link_, &seen, now_us, &action);
    TEST_ASSERT_EQUAL_UINT32(link_.rate, action.rate);
    if (action.set_rate) {
        TEST_ASSERT_TRUE_MESSAGE(host_rate != action.rate, "reopened at the same rate");
        host_rate = action.rate;
    }
    TEST_ASSERT_EQUAL_UINT(host_rate, action.rate);
    if (action.cycle_power) {
        power_cycles++;
    }
    if (action.expect) {
        scip_parser_expect(&parser, &action.request);
    }
    if (action.send) {
        host_sends();
    }
    sensor_runs(STEP_MS);
    now_us += STEP_US;
    step_number++;
}

static void steps(uint32_t count)
{
    while (count-- > 0) {
        step();
    }
}

/* Steps until scans arrive; NEVER after 60 s. */
static uint32_t steps_to_ok(void)
{
    for (uint32_t count = 1; count <= 400; count++) {
        step();
        if (link_.status == URG_OK) {
            return count;
        }
    }
    return NEVER;
}

static void host_starts(uint32_t wait_us)
{
    config = (urg_config_t){.wait_us = wait_us,
                            .first_rate = 115200,
                            .stream_rate = 250000,
                            .fastest_rate = 250000,
                            .stream = SCIP_STREAM_2,
                            .range = {372, 406, 1, 0, 0}};
    memset(&seen, 0, sizeof seen);
    asked_count = 0;
    power_cycles = 0;
    host_rate = 115200;
    scan = (scip_scan_t){.distance_mm = points, .capacity = 35};
    scip_parser_init(&parser);
    scip_parser_scan_into(&parser, &scan);
    (void)urg_link_init(&link_, &config, now_us);
}

static void fresh_sensor(uint32_t rate)
{
    memset(&sensor, 0, sizeof sensor);
    sensor.power_up_rate = rate;
    sensor.knows_switch = sensor.knows_rate = sensor.knows_stream = sensor.streams = true;
    sensor_powers_up();
}

static void start_streaming(uint32_t rate)
{
    sensor.rate = rate;
    sensor.scip2 = sensor.streaming = true;
    strcpy(sensor.echo, "MS0372040601000");
    sensor.next_frame_ms = sensor.clock_ms + 50;
}

static void reset(uint32_t wait_us)
{
    queued = taken = step_number = sent_to_host = sent_to_sensor = 0;
    drop_to_host = flip_to_host = drop_to_sensor = NEVER;
    now_us = 1000000;
    fresh_sensor(115200);
    host_starts(wait_us);
}

void setUp(void)
{
    reset(10000000);
}

void tearDown(void) {}

static void assert_asked(uint32_t index, const char *text, uint32_t at_step, uint32_t rate,
                         urg_status_t status)
{
    TEST_ASSERT_LESS_THAN_UINT(asked_count, index);
    TEST_ASSERT_EQUAL_STRING(text, asked[index].text);
    TEST_ASSERT_EQUAL_UINT(at_step, asked[index].step);
    TEST_ASSERT_EQUAL_UINT(rate, asked[index].rate);
    TEST_ASSERT_EQUAL_STRING(urg_status_name(status), urg_status_name(asked[index].status));
}

static uint32_t times_asked(const char *command)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < asked_count; i++) {
        const char *text = asked[i].text[0] == '\n' ? &asked[i].text[1] : asked[i].text;
        count += strncmp(text, command, strlen(command)) == 0;
    }
    return count;
}

/* --- the start as the seed has it
 * --------------------------------------------------------------------------------- */

void test_the_status_names_are_those_of_the_telemetry(void)
{
    static const char *const names[] = {"WAIT",   "STOP1", "SWITCH", "RATE", "STOP2",
                                        "STREAM", "OK",    "LOST",   "OLD"};
    for (int status = 0; status < URG_STATUS_COUNT; status++) {
        TEST_ASSERT_EQUAL_STRING(names[status], urg_status_name((urg_status_t)status));
    }
}

/* 10 s are 66.7 steps. One command a step; the own rate follows one step after the reply. */
void test_a_sensor_after_power_up_is_started_in_the_order_of_the_seed(void)
{
    steps(67);
    TEST_ASSERT_EQUAL_UINT(0, asked_count);
    TEST_ASSERT_EQUAL(URG_WAIT, link_.status);
    TEST_ASSERT_EQUAL_UINT(6, steps_to_ok() - 1);
    TEST_ASSERT_EQUAL_UINT(5, asked_count);
    assert_asked(0, "\nL0\n", 67, 115200, URG_STOP1);
    assert_asked(1, "SCIP2.0\n", 68, 115200, URG_SWITCH);
    assert_asked(2, "SS250000\n", 69, 115200, URG_RATE);
    assert_asked(3, "\nQT\n", 71, 250000, URG_STOP2);
    assert_asked(4, "MS0372040601000\n", 72, 250000, URG_STREAM);
    TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
    TEST_ASSERT_EQUAL_UINT32(0, link_.timeouts);
    TEST_ASSERT_EQUAL_UINT32(0, seen.damage_count);
    TEST_ASSERT_EQUAL_UINT(0, power_cycles);
}

void test_without_a_wait_the_start_begins_at_once(void)
{
    reset(0);
    TEST_ASSERT_EQUAL_UINT(7, steps_to_ok());
    assert_asked(0, "\nL0\n", 0, 115200, URG_STOP1);
}

void test_nothing_is_sent_while_scans_arrive(void)
{
    steps_to_ok();
    uint32_t before = asked_count;
    steps(4000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT(before, asked_count);
    TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
    TEST_ASSERT_GREATER_THAN_UINT32(5900, seen.scan_count);
}

void test_time_may_wrap_at_any_moment(void)
{
    for (uint32_t before = 0; before < 14000000; before += 500000) {
        reset(10000000);
        now_us = 0U - before;
        host_starts(10000000);
        TEST_ASSERT_EQUAL_UINT(67 + 7, steps_to_ok());
        steps(40);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
    }
}

void test_the_time_in_a_status_is_known(void)
{
    steps(68);
    TEST_ASSERT_EQUAL_UINT32(now_us - STEP_US, link_.since_us);
    steps_to_ok();
    uint32_t entered = now_us - STEP_US;
    steps(20);
    TEST_ASSERT_EQUAL_UINT32(entered, link_.since_us);
}

/* Real sensors were seen to take 381 ms for a first reply: no command is repeated before 400 ms. */
void test_a_slow_sensor_is_not_asked_twice(void)
{
    sensor.latency_steps = 1;
    TEST_ASSERT_NOT_EQUAL_UINT(NEVER, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT32(0, link_.timeouts);
    TEST_ASSERT_EQUAL_UINT(5, asked_count);
}

/* What comes later than the time for it is heard at the next rate, and the search comes back. */
void test_every_rate_is_asked_again_only_after_400_ms(void)
{
    sensor.on = false;
    steps(1000);
    for (uint32_t i = 1; i < asked_count; i++) {
        uint32_t before = i - 1;
        while (before > 0 && asked[before].rate != asked[i].rate) {
            before--;
        }
        if (asked[before].rate == asked[i].rate) {
            TEST_ASSERT_GREATER_OR_EQUAL_UINT(3, asked[i].step - asked[before].step);
        }
    }
}

/* --- any state at the start
 * --------------------------------------------------------------------------------------- */

typedef enum { SCIP1, IDLE, STREAMING, TIMING } state_t;

static uint32_t start_from(state_t state, uint32_t rate, uint32_t wait_us)
{
    reset(wait_us);
    sensor.power_up_rate = sensor.rate = rate;
    sensor.scip2 = state != SCIP1;
    sensor.time_mode = state == TIMING;
    if (state == STREAMING) {
        start_streaming(rate);
    }
    return steps_to_ok();
}

/* The longest time from the first command (or from reset, when the sensor is heard) to the first scan. */
void test_streaming_is_reached_from_every_state_at_every_rate_without_a_power_cycle(void)
{
    static const char *const names[] = {"SCIP1.1", "SCIP2.0 idle", "streaming", "time mode"};
    static const uint32_t rates[] = {19200, 57600, 115200, 250000};
    static const uint32_t limit_ms[4][4] = {
        /* 19200 57600 115200 250000 */
        {2850, 3450, 1050, 1650},
        {2700, 3300, 1050, 1350},
        {1350, 1500, 1050, 600},
        {3000, 3600, 1350, 1650},
    };
    for (int state = SCIP1; state <= TIMING; state++) {
        for (uint32_t r = 0; r < 4; r++) {
            uint32_t ms = STEP_MS * start_from((state_t)state, rates[r], 0);
            printf("%s at %lu: %lu ms\n", names[state], (unsigned long)rates[r], (unsigned long)ms);
            TEST_ASSERT_LESS_OR_EQUAL_UINT(limit_ms[state][r], ms);
            TEST_ASSERT_EQUAL_UINT(250000, host_rate);
            TEST_ASSERT_EQUAL_UINT(0, power_cycles);
            TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
            steps(10);
            TEST_ASSERT_EQUAL(URG_OK, link_.status);
        }
    }
}

void test_a_sensor_that_already_streams_cuts_the_wait_short(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT(6, start_from(STREAMING, 250000, 10000000));
    TEST_ASSERT_EQUAL_STRING("\nQT\n", asked[0].text);
    TEST_ASSERT_EQUAL_UINT(250000, asked[0].rate);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(8, start_from(STREAMING, 115200, 10000000));
    TEST_ASSERT_EQUAL_UINT(115200, asked[0].rate);
}

void test_half_a_command_at_the_sensor_and_half_a_reply_in_the_line_do_no_harm(void)
{
    static const char *const halves[] = {"M", "MS0372", "QT", "SCIP2.", "\x15\x80garbage"};
    for (uint32_t i = 0; i < 5; i++) {
        for (int state = SCIP1; state <= TIMING; state++) {
            reset(0);
            sensor.scip2 = state != SCIP1;
            sensor.time_mode = state == TIMING;
            strcpy(sensor.command, halves[i]);
            sensor.length = (uint32_t)strlen(halves[i]);
            send_text("MS0372040601000\n99b\n01");
            TEST_ASSERT_LESS_OR_EQUAL_UINT(12, steps_to_ok());
        }
    }
}

void test_a_sensor_that_boots_after_the_host_is_found(void)
{
    for (uint32_t late = 0; late < 60; late++) {
        reset(0);
        sensor.on = false;
        steps(late);
        sensor_powers_up();
        TEST_ASSERT_LESS_OR_EQUAL_UINT(22, steps_to_ok());
    }
}

/* --- damage in the dialogue
 * --------------------------------------------------------------------------------------- */

/* 67 steps of waiting and 7 of talk without a fault. The worst is the lost end of SS: the next command ends
 * it, at the wrong moment. */
static void assert_start_survives(const char *fault, uint32_t position)
{
    char text[60];
    uint32_t count = steps_to_ok();
    snprintf(text, sizeof text, "%s %lu", fault, (unsigned long)position);
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(67 + 7 + 17, count, text);
    TEST_ASSERT_EQUAL_UINT(250000, host_rate);
    steps(10);
    TEST_ASSERT_EQUAL_MESSAGE(URG_OK, link_.status, text);
    TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
}

void test_any_octet_of_any_reply_may_be_lost_or_wrong(void)
{
    steps_to_ok();
    const uint32_t octets = sent_to_host;
    TEST_ASSERT_GREATER_THAN_UINT(6 + 11 + 14 + 8 + 21, octets);
    for (uint32_t k = 1; k <= octets; k++) {
        reset(10000000);
        drop_to_host = k;
        assert_start_survives("dropped", k);
        reset(10000000);
        flip_to_host = k;
        assert_start_survives("flipped", k);
    }
}

void test_any_octet_of_any_command_may_be_lost(void)
{
    steps_to_ok();
    const uint32_t octets = sent_to_sensor;
    TEST_ASSERT_EQUAL_UINT(4 + 8 + 9 + 4 + 16, octets);
    for (uint32_t k = 1; k <= octets; k++) {
        reset(10000000);
        drop_to_sensor = k;
        assert_start_survives("command octet", k);
    }
}

void test_the_sensor_may_restart_at_any_step_of_the_dialogue(void)
{
    for (uint32_t at = 66; at < 80; at++) {
        reset(10000000);
        steps(at);
        sensor_powers_up();
        steps(5);
        if (link_.status != URG_OK) {
            TEST_ASSERT_LESS_OR_EQUAL_UINT(25, steps_to_ok());
        }
        steps(10);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
    }
}

/* --- loss and recovery
 * -------------------------------------------------------------------------------------------- */

/* 450 ms for the front at 250000: two revolutions, a frame and a margin. */
void test_a_mute_sensor_is_noticed_within_600_ms_and_not_before_450(void)
{
    steps_to_ok();
    steps(20);
    sensor.on = false;
    uint32_t last = link_.scan_us;
    while (link_.status == URG_OK) {
        step();
        last = link_.scan_us;
    }
    const uint32_t silent = now_us - STEP_US - last;
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(450000, silent);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(600000, silent);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_EQUAL_UINT32(1, link_.restarts);
}

void test_a_stream_that_stopped_is_started_again_at_the_same_rate_within_1_5_s(void)
{
    steps_to_ok();
    steps(20);
    sensor.streaming = false;
    step();
    const uint32_t scans = seen.scan_count, stops = times_asked("QT");
    for (uint32_t i = 0; i < 10 && seen.scan_count == scans; i++) {
        step();
    }
    TEST_ASSERT_GREATER_THAN_UINT32(scans, seen.scan_count);
    TEST_ASSERT_EQUAL_UINT(1, times_asked("TM2"));
    TEST_ASSERT_EQUAL_UINT(stops, times_asked("QT"));
    TEST_ASSERT_EQUAL_UINT16(0, link_.failures);
}

/* 22 steps: 3.3 s from the end of the sensor's boot to scans. */
void test_a_brown_out_of_the_sensor_is_overcome(void)
{
    for (uint32_t off = 0; off < 40; off++) {
        reset(0);
        steps_to_ok();
        steps(10);
        sensor.on = false;
        steps(off);
        sensor_powers_up();
        steps(5);
        uint32_t count = link_.status == URG_OK ? 0 : steps_to_ok();
        TEST_ASSERT_LESS_OR_EQUAL_UINT(22, count);
        steps(10);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        TEST_ASSERT_EQUAL_UINT32(1, link_.restarts);
    }
}

void test_a_host_reset_while_the_sensor_streams_costs_less_than_a_second(void)
{
    reset(0);
    steps_to_ok();
    steps(10);
    host_starts(0);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(6, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT(0, times_asked("SCIP2.0"));
}

void test_a_sensor_in_time_mode_is_taken_out_of_it(void)
{
    steps_to_ok();
    sensor.streaming = false;
    sensor.time_mode = true;
    steps(12);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT(1, times_asked("TM2"));
}

/* A line that is out both ways: the sensor streams on, and no command may stop it when the line is back. */
void test_a_stream_that_is_only_out_of_hearing_is_not_stopped(void)
{
    for (uint32_t out = 1; out < 60; out++) {
        reset(0);
        steps_to_ok();
        steps(10);
        const uint32_t before = asked_count;
        for (uint32_t i = 0; i < out; i++) {
            taken = queued;
            step();
        }
        taken = queued;
        TEST_ASSERT_LESS_OR_EQUAL_UINT(4, steps_to_ok());
        TEST_ASSERT_TRUE(sensor.streaming);
        steps(10);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        for (uint32_t i = before; i < asked_count; i++) {
            TEST_ASSERT_NULL(strstr(asked[i].text, "QT"));
        }
    }
}

/* Before any other rate has a turn: for a restarted sensor at the first rate; after 1, 2, 4 and 8 s by a
 * request at the stream's. */
void test_a_lost_sensor_is_first_looked_for_where_it_can_be(void)
{
    steps_to_ok();
    steps(10);
    sensor.on = false;
    uint32_t begin = asked_count;
    const uint32_t lost_step = step_number;
    steps(75);
    TEST_ASSERT_EQUAL_STRING("\nSS250000\n", asked[begin].text);
    TEST_ASSERT_EQUAL_STRING("\nTM2\n", asked[begin + 1].text);
    TEST_ASSERT_EQUAL_STRING("\nMS0372040601000\n", asked[begin + 2].text);
    uint32_t requests_ms[9] = {0}, requests = 0;
    for (uint32_t i = begin + 3; i < asked_count; i++) {
        const bool at_stream_rate = asked[i].text[1] == 'M';
        assert_asked(i, at_stream_rate ? "\nMS0372040601000\n" : "\nSCIP2.0\n", asked[i].step,
                     at_stream_rate ? 250000 : 115200, URG_LOST);
        if (at_stream_rate) {
            requests_ms[requests++] = (asked[i].step - lost_step) * STEP_MS;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(25, asked_count - begin);
    TEST_ASSERT_EQUAL_UINT(2, requests); /* 8 s from each other */
    TEST_ASSERT_UINT32_WITHIN(2 * STEP_MS, 8000 + STEP_MS, requests_ms[1] - requests_ms[0]);
    begin = asked_count;
    steps(30);
    TEST_ASSERT_EQUAL_STRING("\nSCIP2.0\n", asked[asked_count - 1].text);
    TEST_ASSERT_EQUAL_UINT(1, times_asked("QT"));
}

void test_where_first_and_stream_rate_are_one_the_order_alone_finds_the_sensor(void)
{
    reset(0);
    config.stream_rate = 115200;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    steps_to_ok();
    sensor.on = false;
    steps(30);
    sensor_powers_up();
    TEST_ASSERT_LESS_OR_EQUAL_UINT(6, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT(115200, host_rate);
}

void test_octets_above_7f_tell_the_wrong_rate_like_framing_errors(void)
{
    for (uint32_t strange = 0; strange < 20; strange++) {
        urg_seen_t some = {.octet_count = 0};
        reset(0);
        urg_link_step(&link_, &some, 0, &action);
        some.octet_count = some.strange_count = strange;
        urg_link_step(&link_, &some, STEP_US, &action);
        TEST_ASSERT_EQUAL(strange >= 8 ? URG_LOST : URG_STOP1, link_.status);
    }
}

void test_no_rate_is_tried_that_the_own_uart_cannot_do(void)
{
    reset(0);
    sensor.on = false;
    steps(400);
    for (uint32_t i = 0; i < asked_count; i++) {
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(250000, asked[i].rate);
    }
    reset(0);
    sensor.rate = sensor.power_up_rate = 750000;
    config.fastest_rate = 0;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    TEST_ASSERT_LESS_OR_EQUAL_UINT(40, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT32(250000, host_rate);
}

void test_what_sensor_or_uart_cannot_do_is_refused_at_once(void)
{
    static const urg_config_t good = {0, 115200, 250000, 250000, SCIP_STREAM_2, {372, 406, 1, 0, 0},
                                      0, false};
    urg_config_t bad[10];
    const urg_link_t untouched = link_;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &good, 0));
    for (uint32_t i = 0; i < 10; i++) {
        bad[i] = good;
    }
    bad[0].first_rate = 38400;
    bad[1].stream_rate = 250001;
    bad[2].stream_rate = 500000;
    bad[3].first_rate = 750000;
    bad[4].stream = SCIP_SINGLE_2;
    bad[5].range.last_step = 769;
    bad[6].range.first_step = 407;
    bad[7].range.cluster = 0;
    bad[8].last_step = 405;
    bad[9].last_step = bad[9].range.last_step = 1081;
    link_ = untouched;
    for (uint32_t i = 0; i < 10; i++) {
        TEST_ASSERT_FALSE(urg_link_init(&link_, &bad[i], 5));
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &link_, sizeof link_);
    }
}

void test_a_range_may_reach_the_last_step_of_the_sensor(void)
{
    urg_config_t whole = {0, 115200, 250000, 250000, SCIP_STREAM_2, {0, 768, 1, 0, 0}, 0, false};
    TEST_ASSERT_TRUE(urg_link_init(&link_, &whole, 0));
    whole.range.last_step = whole.last_step = 1080;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &whole, 0));
    whole.range.last_step = 1079;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &whole, 0));
}

/* Every rate has its turn, the configured ones once only, for ever; power is cycled every 20 s where it can
 * be. */
void test_a_dead_sensor_is_looked_for_at_every_rate_for_ever(void)
{
    static const uint32_t rates[] = {250000, 115200, 19200, 57600};
    reset(0);
    sensor.on = false;
    steps(800);
    TEST_ASSERT_EQUAL_UINT(1, times_asked("L0"));
    TEST_ASSERT_EQUAL_UINT(asked_count - 1, times_asked("QT"));
    TEST_ASSERT_GREATER_THAN_UINT(200, asked_count);
    for (uint32_t i = 1; i < asked_count; i++) {
        TEST_ASSERT_EQUAL_UINT(rates[(i - 1) % 4], asked[i].rate);
        TEST_ASSERT_EQUAL(URG_LOST, asked[i].status);
        TEST_ASSERT_EQUAL_UINT('\n', (uint32_t)asked[i].text[0]);
    }
    TEST_ASSERT_EQUAL_UINT(5, power_cycles);
    TEST_ASSERT_EQUAL_UINT32(asked_count - 1, link_.timeouts);
    sensor_powers_up();
    TEST_ASSERT_LESS_OR_EQUAL_UINT(22, steps_to_ok());
}

void test_other_configured_rates_are_probed_first(void)
{
    static const uint32_t rates[] = {500000, 750000, 19200, 57600, 115200, 250000};
    reset(0);
    config.fastest_rate = 0;
    config.first_rate = 750000;
    config.stream_rate = 500000;
    host_rate = 750000;
    (void)urg_link_init(&link_, &config, now_us);
    sensor.on = false;
    steps(100);
    for (uint32_t i = 1; i < 20; i++) {
        TEST_ASSERT_EQUAL_UINT(rates[(i - 1) % 6], asked[i].rate);
    }
}

/* The sensor answers everything but never scans: MS again, then TM2, then RS. */
void test_a_sensor_that_answers_but_does_not_scan_climbs_the_ladder(void)
{
    steps_to_ok();
    sensor.streams = false;
    sensor.streaming = false;
    uint32_t begin = asked_count;
    steps(40);
    while (asked[begin].text[1] != 'M') {
        begin++;
    }
    static const char *const ladder[] = {"\nMS0372040601000\n", "\nTM2\n", "MS0372040601000\n", "\nRS\n",
                                         "\nSCIP2.0\n"};
    for (uint32_t i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_STRING(ladder[i], asked[begin + i].text);
    }
    TEST_ASSERT_EQUAL_UINT(115200, asked[begin + 4].rate);
    steps(270);
    TEST_ASSERT_GREATER_THAN_UINT(3, times_asked("RS"));
    TEST_ASSERT_EQUAL_UINT(2, power_cycles);
    sensor.streams = true;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(30, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT16(0, link_.failures);
}

void test_a_sensor_that_refuses_everything_is_reset_again_and_again(void)
{
    reset(0);
    sensor.scip2 = sensor.refuses_all = true;
    steps(100);
    TEST_ASSERT_GREATER_THAN_UINT(3, times_asked("RS"));
    sensor.refuses_all = false;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(20, steps_to_ok());
}

void test_a_scan_order_that_is_refused_is_not_just_repeated(void)
{
    static const char *const refusals[] = {"04", "0E"};
    for (uint32_t i = 0; i < 2; i++) {
        reset(0);
        sensor.knows_stream = false;
        sensor.stream_refusal = refusals[i];
        steps(60);
        TEST_ASSERT_GREATER_THAN_UINT(1, times_asked("MS"));
        TEST_ASSERT_GREATER_THAN_UINT(0, times_asked("TM2"));
        TEST_ASSERT_GREATER_THAN_UINT(0, times_asked("RS"));
        sensor.knows_stream = true;
        TEST_ASSERT_LESS_OR_EQUAL_UINT(20, steps_to_ok());
    }
}

void test_a_sensor_that_does_not_know_the_rate_streams_at_its_own(void)
{
    static const char *const refusals[] = {"02", "04", "0F"};
    for (uint32_t i = 0; i < 3; i++) {
        reset(0);
        sensor.knows_rate = false;
        sensor.rate_refusal = refusals[i];
        TEST_ASSERT_LESS_OR_EQUAL_UINT(8, steps_to_ok());
        TEST_ASSERT_EQUAL_UINT(115200, host_rate);
        TEST_ASSERT_EQUAL_UINT(i == 2 ? 2 : 1, times_asked("SS"));
        sensor.streaming = false;
        steps(10);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        TEST_ASSERT_EQUAL_UINT(115200, host_rate);
    }
}

void test_a_sensor_that_has_the_rate_already_is_taken_at_its_word(void)
{
    reset(0);
    steps(2);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
    step();
    TEST_ASSERT_EQUAL(URG_RATE, link_.status);
    queued = taken = 0;
    sensor.rate = 115200;
    send_text("SS250000\n03S\n\n");
    sensor.rate = 250000;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(5, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT(1, times_asked("SS"));
}

void test_first_and_stream_rate_may_be_the_same(void)
{
    reset(0);
    config.stream_rate = 115200;
    (void)urg_link_init(&link_, &config, now_us);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(6, steps_to_ok());
    TEST_ASSERT_EQUAL_UINT(0, times_asked("SS"));
    TEST_ASSERT_EQUAL_UINT(115200, host_rate);
}

void test_firmware_without_scip_2_is_called_old_and_asked_for_ever(void)
{
    reset(0);
    sensor.knows_switch = false;
    steps(10);
    for (uint32_t i = 0; i < 100; i++) {
        step();
        TEST_ASSERT_EQUAL_STRING("OLD", urg_status_name(link_.status));
    }
    TEST_ASSERT_GREATER_THAN_UINT(10, times_asked("SCIP2.0"));
    sensor.knows_switch = true;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(20, steps_to_ok());
}

/* A sensor that answers everything but sends no scan, and falls silent at TM2 and RS. */
void test_a_sensor_that_is_silent_at_tm2_or_rs_is_looked_for(void)
{
    scip_kind_t latest = SCIP_KIND_COUNT;
    unsigned repeats[SCIP_KIND_COUNT] = {0}, then_stopped[SCIP_KIND_COUNT] = {0};
    reset(0);
    for (uint32_t i = 0; i < 400; i++) {
        now_us += 150000U;
        urg_link_step(&link_, &seen, now_us, &action);
        if (!action.send) {
            continue;
        }
        const scip_kind_t kind = action.request.kind;
        if (latest < SCIP_KIND_COUNT) {
            repeats[latest] += kind == latest;
            then_stopped[latest] += kind == SCIP_STOP;
        }
        latest = kind;
        if (kind != SCIP_TIME_LEAVE && kind != SCIP_RESET) {
            const bool old = kind == SCIP_LASER_OFF_1 || kind == SCIP_SWITCH;
            seen.reply_count++;
            seen.reply_kind = kind;
            seen.reply = (scip_reply_t){.status = {'0', old ? 0 : '0'}, .legacy = old};
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, repeats[SCIP_TIME_LEAVE]);
    TEST_ASSERT_GREATER_THAN_UINT(0, then_stopped[SCIP_TIME_LEAVE]);
    TEST_ASSERT_EQUAL_UINT(0, repeats[SCIP_RESET]);
    TEST_ASSERT_GREATER_THAN_UINT(0, then_stopped[SCIP_RESET]);
}

void test_no_other_rate_than_scips_is_taken(void)
{
    reset(0);
    config.first_rate = 9600;
    TEST_ASSERT_FALSE(urg_link_init(&link_, &config, now_us));
    config.first_rate = 115200;
    config.stream_rate = 38400;
    TEST_ASSERT_FALSE(urg_link_init(&link_, &config, now_us));
    config.stream_rate = 250000;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
}

void test_only_streams_are_taken(void)
{
    reset(0);
    config.stream = SCIP_SINGLE_3;
    TEST_ASSERT_FALSE(urg_link_init(&link_, &config, now_us));
    config.stream = SCIP_STREAM_3;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    config.stream = SCIP_STREAM_2;
}

void test_one_stray_refusal_does_not_make_a_sensor_old(void)
{
    reset(0);
    steps(2);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
    queued = taken = 0;
    send_text("SCIP2.0\nE\n\n");
    while (link_.status != URG_OK) {
        step();
        TEST_ASSERT_NOT_EQUAL(URG_OLD, link_.status);
        TEST_ASSERT_LESS_THAN_UINT(20, step_number);
    }
}

void test_an_old_sensor_that_falls_silent_is_looked_for(void)
{
    reset(0);
    sensor.knows_switch = false;
    steps(20);
    sensor.on = false;
    steps(20);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

/* --- hardware notices
 * --------------------------------------------------------------------------------------------- */

static void reach_ok(void)
{
    reset(0);
    steps_to_ok();
    steps(5);
}

void test_hardware_trouble_ends_the_stream_and_is_met_at_once(void)
{
    reach_ok();
    send_status("MS0372040601000", "50");
    sensor.streaming = false;
    steps(1);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    steps(6);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT32(1, link_.restarts);
}

void test_a_sensor_that_verifies_an_error_is_given_two_seconds(void)
{
    reach_ok();
    send_status("MS0372040601000", "21");
    sensor.streaming = false;
    steps(13);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    steps(2);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

void test_the_all_clear_changes_nothing(void)
{
    reach_ok();
    send_status("MS0372040601000", "98");
    steps(20);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
    TEST_ASSERT_EQUAL_UINT32(1, seen.notice_count);
}

void test_after_verifying_the_usual_time_out_holds_again(void)
{
    reach_ok();
    send_status("MS0372040601000", "21");
    send_status("MS0372040601000", "98");
    steps(10);
    sensor.streaming = false;
    steps(6);
    TEST_ASSERT_EQUAL_UINT32(1, link_.restarts);
}

/* --- other ranges
 * ------------------------------------------------------------------------------------------------- */

void test_a_counted_run_is_ordered_again_when_it_ends(void)
{
    reset(0);
    config.range.scans = 7;
    (void)urg_link_init(&link_, &config, now_us);
    steps_to_ok();
    steps(200);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT32(0, link_.restarts);
    TEST_ASSERT_GREATER_THAN_UINT(15, times_asked("MS0372040601007"));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(7 * 15, seen.scan_count);
    TEST_ASSERT_EQUAL_UINT32(0, seen.damage_count);
}

void test_a_counted_run_whose_last_scan_is_lost_is_ordered_again_too(void)
{
    reset(0);
    config.range.scans = 7;
    (void)urg_link_init(&link_, &config, now_us);
    steps_to_ok();
    sensor.streaming = false;
    steps(8);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_EQUAL_UINT32(1, link_.restarts);
}

/* Time-outs follow revolutions and frame lengths. */
void test_longer_scans_are_waited_for_longer(void)
{
    static const struct {
        scip_range_t range;
        uint32_t least_us, most_us;
    } rows[] = {
        {{372, 406, 1, 0, 0}, 450000, 460000},
        {{372, 406, 1, 9, 0}, 2250000, 2260000},
        {{111, 657, 1, 0, 0}, 490000, 505000},
    };
    for (uint32_t i = 0; i < 3; i++) {
        urg_seen_t some = {.scan_count = 0};
        reset(0);
        config.range = rows[i].range;
        config.first_rate = config.stream_rate;
        (void)urg_link_init(&link_, &config, 0);
        urg_link_step(&link_, &some, 0, &action);
        some.reply_count = 1;
        some.reply_kind = SCIP_LASER_OFF_1;
        some.reply.legacy = false;
        urg_link_step(&link_, &some, STEP_US, &action);
        some.reply_count = 2;
        some.reply_kind = SCIP_STOP;
        urg_link_step(&link_, &some, 2 * STEP_US, &action);
        TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
        TEST_ASSERT_EQUAL(SCIP_STREAM_2, action.request.kind);
        TEST_ASSERT_GREATER_THAN_UINT32(rows[i].least_us - 50000, link_.timeout_us);
        some.scan_count = 1;
        urg_link_step(&link_, &some, 3 * STEP_US, &action);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        TEST_ASSERT_GREATER_OR_EQUAL_UINT32(rows[i].least_us, link_.timeout_us);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(rows[i].most_us, link_.timeout_us);
    }
}

void test_a_reply_of_another_kind_confirms_nothing(void)
{
    urg_seen_t some = {.reply_count = 0};
    reset(0);
    urg_link_step(&link_, &some, 0, &action);
    some.reply_count = 1;
    some.reply_kind = SCIP_STOP;
    urg_link_step(&link_, &some, STEP_US, &action);
    TEST_ASSERT_EQUAL(URG_STOP1, link_.status);
    TEST_ASSERT_FALSE(action.send);
}

void test_late_scans_of_an_older_order_do_not_end_the_start(void)
{
    urg_seen_t some = {.reply_count = 0};
    reset(0);
    urg_link_step(&link_, &some, 0, &action);
    some.scan_count = 5;
    urg_link_step(&link_, &some, STEP_US, &action);
    TEST_ASSERT_EQUAL(URG_STOP1, link_.status);
}

static void probe_hears(uint32_t octets, uint32_t framing)
{
    urg_seen_t some = {.octet_count = 0};
    reset(0);
    urg_link_step(&link_, &some, 0, &action);
    urg_link_step(&link_, &some, 450000, &action);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    some.octet_count += octets;
    some.framing_count += framing;
    urg_link_step(&link_, &some, 1350000, &action);
    TEST_ASSERT_TRUE(action.send);
}

void test_a_probe_that_hears_clean_octets_stays_at_its_rate(void)
{
    probe_hears(0, 0);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    probe_hears(30, 0);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL_UINT16(2, link_.attempt);
    probe_hears(30, 6); /* damage, not another rate */
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    probe_hears(30, 8);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    probe_hears(0, 7);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

void test_a_burst_of_framing_errors_ends_a_probe_early_and_a_few_do_not(void)
{
    for (uint32_t framing = 0; framing < 20; framing++) {
        urg_seen_t some = {.octet_count = 0};
        reset(0);
        urg_link_step(&link_, &some, 0, &action);
        some.framing_count = framing;
        urg_link_step(&link_, &some, STEP_US, &action);
        TEST_ASSERT_EQUAL(framing >= 8 ? URG_LOST : URG_STOP1, link_.status);
        TEST_ASSERT_EQUAL(framing >= 8, action.set_rate);
    }
}

/* Random losses in both directions at one octet in a hundred: the stream always comes back. */
void test_a_noisy_cable_never_ends_it(void)
{
    unsigned long seed = 19991231UL;
    uint32_t ok = 0;
    printf("random seed %lu\n", seed);
    reset(0);
    for (uint32_t i = 0; i < 20000; i++) {
        seed = (seed * 1103515245UL + 12345UL) & 0x7FFFFFFFUL;
        drop_to_host = sent_to_host + 1 + (uint32_t)(seed >> 8) % 300;
        drop_to_sensor = sent_to_sensor + 1 + (uint32_t)(seed >> 16) % 30;
        if (i % 1000 == 500) {
            sensor_powers_up();
        }
        step();
        ok += link_.status == URG_OK;
    }
    TEST_ASSERT_GREATER_THAN_UINT(19000, ok);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(20, link_.restarts);
}

/* A laser or a motor that each order starts anew: to ask again and again would be for ever. */
void test_a_sensor_that_needs_seconds_before_its_first_scan_is_waited_for(void)
{
    static const uint32_t settles_ms[] = {500, 700, 1500, 2900};
    for (uint32_t i = 0; i < 4; i++) {
        reset(0);
        sensor.settles_ms = settles_ms[i];
        const uint32_t needed = steps_to_ok();
        TEST_ASSERT_NOT_EQUAL_UINT32(NEVER, needed);
        TEST_ASSERT_LESS_THAN_UINT32(8000 / STEP_MS, needed);
        steps(100);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
    }
}

/* ---- times to the microsecond, with answers made here ---- */

static uint32_t reply_after(uint32_t us, scip_kind_t kind, const char *status, bool legacy)
{
    now_us += us;
    seen.reply_count++;
    seen.reply_kind = kind;
    seen.reply = (scip_reply_t){{(octet_t)status[0], (octet_t)status[1]}, legacy, 0};
    urg_link_step(&link_, &seen, now_us, &action);
    return link_.timeout_us;
}

static void nothing_after(uint32_t us)
{
    now_us += us;
    urg_link_step(&link_, &seen, now_us, &action);
}

static void scan_after(uint32_t us)
{
    seen.scan_count++;
    nothing_after(us);
}

/* To a stream of every fourth revolution at 250000 bit/s. */
static void stream_every_fourth(void)
{
    reset(0);
    config.range.interval = 3;
    (void)urg_link_init(&link_, &config, now_us);
    nothing_after(0);
    TEST_ASSERT_EQUAL_UINT32(260000 + 10 * 87, link_.timeout_us); /* LF, L0, LF; 6 octets */
    TEST_ASSERT_EQUAL_UINT32(400000 + 19 * 87, reply_after(STEP_US, SCIP_LASER_OFF_1, "0", true));
    TEST_ASSERT_EQUAL_UINT32(400000 + 23 * 87, reply_after(STEP_US, SCIP_SWITCH, "0", true));
    (void)reply_after(STEP_US, SCIP_BIT_RATE, "00", false);
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL_UINT32(400000 + (12 + 101) * 41, link_.timeout_us); /* a frame may be under way */
    TEST_ASSERT_EQUAL_UINT32(400000 + 2 * 400000 + (16 + 21 + 101) * 41,
                             reply_after(STEP_US, SCIP_STOP, "00", false));
    TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
    scan_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
}

#define NEXT_SCAN_US (2U * 400000U + 101U * 41U + 250000U)

void test_every_time_out_is_what_the_octets_and_the_revolutions_take(void)
{
    stream_every_fourth();
    TEST_ASSERT_EQUAL_UINT32(NEXT_SCAN_US, link_.timeout_us);
    nothing_after(NEXT_SCAN_US - 1U);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    nothing_after(1U);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_EQUAL_UINT32(40000, link_.timeout_us); /* SS; its answer is heard at the other rate too */
    nothing_after(40000);
    TEST_ASSERT_EQUAL_UINT32(90000, link_.timeout_us); /* TM2, up to where SS would be answered */
    nothing_after(90000);
    TEST_ASSERT_EQUAL_UINT32(130000, link_.timeout_us); /* MS */
    TEST_ASSERT_EQUAL_UINT32(STEP_US + NEXT_SCAN_US, reply_after(STEP_US, SCIP_STREAM_2, "00", false));
    TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
    scan_after(STEP_US);
    seen.notice = (scip_reply_t){{'2', '1'}, false, 0};
    seen.notice_count++;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL_UINT32(2000000, link_.timeout_us);
}

/* To the first SCIP2.0 of a search: SS, TM2 and a request go before it. */
static void lose_and_ask(void)
{
    nothing_after(NEXT_SCAN_US);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    nothing_after(40000);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    nothing_after(90000);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_TRUE(action.send);
    nothing_after(130000);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

/* What it may stream is what it is asked for. */
void test_after_a_loss_no_sensor_is_stopped_first(void)
{
    static const struct {
        const char *status;
        bool legacy;
    } answers[] = {{"0", true}, {"0E", false}};
    for (uint32_t i = 0; i < 2; i++) {
        stream_every_fourth();
        lose_and_ask();
        (void)reply_after(STEP_US, SCIP_SWITCH, answers[i].status, answers[i].legacy);
        TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
        (void)reply_after(STEP_US, SCIP_BIT_RATE, "00", false);
        nothing_after(STEP_US);
        TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
        TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    }
}

void test_from_a_sensor_that_verifies_two_seconds_count_from_its_notice(void)
{
    stream_every_fourth();
    seen.notice = (scip_reply_t){{'2', '1'}, false, 0};
    seen.notice_count++;
    nothing_after(STEP_US);
    nothing_after(2000000 - 1);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    nothing_after(1);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

/* To a sensor that has refused the stream's rate. */
static void refuse_rate(void)
{
    reset(0);
    nothing_after(0);
    (void)reply_after(STEP_US, SCIP_LASER_OFF_1, "0", true);
    (void)reply_after(STEP_US, SCIP_SWITCH, "0", true);
    (void)reply_after(STEP_US, SCIP_BIT_RATE, "02", false);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
}

void test_a_refused_rate_is_tried_again_after_time_mode_and_by_the_search(void)
{
    refuse_rate();
    (void)reply_after(STEP_US, SCIP_STOP, "0A", false);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    (void)reply_after(STEP_US, SCIP_TIME_LEAVE, "00", false);
    (void)reply_after(STEP_US, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    refuse_rate();
    while (link_.status != URG_LOST || link_.rate != 115200) {
        nothing_after(500000);
    }
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    (void)reply_after(STEP_US, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
}

void test_a_stop_is_asked_for_twice_where_the_rate_is_proved_and_three_times_where_octets_are_clean(void)
{
    refuse_rate();
    for (uint16_t attempt = 1; attempt <= 2; attempt++) {
        TEST_ASSERT_EQUAL(URG_STOP2, link_.status);
        TEST_ASSERT_EQUAL_UINT16(attempt, link_.attempt);
        nothing_after(500000);
    }
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    const uint32_t rate = link_.rate;
    for (uint16_t attempt = 1; attempt <= 3; attempt++) {
        TEST_ASSERT_EQUAL_UINT32(rate, link_.rate);
        TEST_ASSERT_EQUAL_UINT16(attempt, link_.attempt);
        seen.octet_count++;
        nothing_after(500000);
    }
    TEST_ASSERT_NOT_EQUAL_UINT32(rate, link_.rate);
}

void test_signs_before_a_command_do_not_tell_of_its_rate(void)
{
    reset(50000);
    seen.framing_count = 20;
    nothing_after(0);
    nothing_after(50000);
    TEST_ASSERT_EQUAL(URG_STOP1, link_.status);
    nothing_after(50000);
    TEST_ASSERT_EQUAL(URG_STOP1, link_.status);
    seen.framing_count += 7;
    nothing_after(50000);
    TEST_ASSERT_EQUAL(URG_STOP1, link_.status);
    seen.framing_count++;
    nothing_after(50000);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

void test_octets_and_framing_errors_in_the_wait_add_up_to_a_stream(void)
{
    nothing_after(0);
    seen.octet_count = 32;
    seen.framing_count = 31;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_WAIT, link_.status);
    seen.framing_count = 32;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
}

/* The configured rates first, then SCIP's from the lowest on, none of them twice; and again. */
void test_the_search_goes_through_every_rate_once_in_its_order(void)
{
    static const uint32_t order[] = {250000, 115200, 19200, 57600, 500000, 750000, 250000, 115200};
    reset(0);
    config.fastest_rate = 0;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    nothing_after(0);
    nothing_after(500000);
    for (uint32_t i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL(URG_LOST, link_.status);
        TEST_ASSERT_EQUAL_UINT32(order[i], link_.rate);
        nothing_after(500000);
    }
}

/* Scans did not start three times in a row: the first one is given three seconds more. */
void test_a_sensor_that_starts_slowly_is_given_three_seconds_from_the_third_failure_on(void)
{
    static const uint32_t settles_us[] = {0, 0, 0, 3000000};
    refuse_rate();
    for (uint32_t failures = 0; failures < 4; failures++) {
        for (uint32_t i = 0; i < 10 && link_.command != SCIP_STREAM_2; i++) {
            (void)reply_after(STEP_US, link_.command, link_.command == SCIP_BIT_RATE ? "02" : "00", false);
        }
        TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
        TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
        TEST_ASSERT_EQUAL_UINT32(400000 + 2 * 100000 + settles_us[failures] + (16 + 21 + 101) * 87,
                                 link_.timeout_us);
        nothing_after(link_.timeout_us);
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(3, link_.failures);
    }
}

/* Was the order lost, or the answer? Both rates are known. */
void test_a_rate_that_is_not_confirmed_after_a_loss_leads_back_to_the_known_rates(void)
{
    stream_every_fourth();
    lose_and_ask();
    (void)reply_after(STEP_US, SCIP_SWITCH, "0", true);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL_UINT32(130000, link_.timeout_us);
    while (link_.rate == 250000) {
        nothing_after(130000);
    }
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

void test_power_is_cycled_20_s_after_the_latest_scan_and_not_before(void)
{
    stream_every_fourth();
    nothing_after(NEXT_SCAN_US);
    nothing_after(20000000U - NEXT_SCAN_US - 1U);
    TEST_ASSERT_FALSE(action.cycle_power);
    nothing_after(1U);
    TEST_ASSERT_TRUE(action.cycle_power);
}

void test_64_octets_in_the_wait_are_a_stream_and_63_are_none(void)
{
    nothing_after(0);
    seen.octet_count = 63;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_WAIT, link_.status);
    seen.octet_count = 64;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

void test_a_switch_that_scip_1_1_refuses_is_repeated_once_and_given_up(void)
{
    reset(0);
    nothing_after(0);
    (void)reply_after(STEP_US, SCIP_LASER_OFF_1, "0", true);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
    (void)reply_after(STEP_US, SCIP_SWITCH, "2", true);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
    TEST_ASSERT_EQUAL_UINT16(2, link_.attempt);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

/* The rate was proved by an answer just now. */
void test_noise_does_not_end_the_wait_for_an_answer_at_a_proved_rate(void)
{
    reset(0);
    nothing_after(0);
    (void)reply_after(STEP_US, SCIP_LASER_OFF_1, "00", false);
    TEST_ASSERT_EQUAL(URG_STOP2, link_.status);
    seen.framing_count += 20;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(URG_STOP2, link_.status);
    TEST_ASSERT_EQUAL_UINT16(1, link_.attempt);
}

void test_the_end_of_time_mode_is_asked_for_twice(void)
{
    reset(0);
    nothing_after(0);
    (void)reply_after(STEP_US, SCIP_LASER_OFF_1, "00", false);
    (void)reply_after(STEP_US, SCIP_STOP, "0E", false);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
}

void test_a_counted_run_is_ordered_again_at_its_last_scan_only(void)
{
    stream_every_fourth();
    link_.config.range.scans = 3;
    for (uint16_t remaining = 2; remaining > 0; remaining--) {
        seen.scan_remaining = remaining;
        scan_after(STEP_US);
        TEST_ASSERT_FALSE(action.send);
    }
    seen.scan_remaining = 0;
    scan_after(STEP_US);
    TEST_ASSERT_TRUE(action.send);
}

void test_after_a_reset_the_sensor_is_looked_for_at_the_first_rate(void)
{
    stream_every_fourth();
    nothing_after(NEXT_SCAN_US);
    (void)reply_after(STEP_US, SCIP_STREAM_2, "0E", false);
    for (uint32_t i = 0; i < 20 && link_.command != SCIP_RESET; i++) {
        (void)reply_after(STEP_US, link_.command, "0E", false);
    }
    TEST_ASSERT_EQUAL(SCIP_RESET, link_.command);
    (void)reply_after(STEP_US, SCIP_RESET, "00", false);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

/* ---- the search between the frames of a sensor that may stream still ---- */

#define REVOLUTION_US 100000U
#define FRAME_US (101U * 41U)
#define PHASE_US \
    15000U /* by which a frame may be early or late, and by a part in 512 of the time since the latest */

/* To a stream of every revolution, whose scans are told with their times. */
static void stream_in_time(void)
{
    reset(0);
    steps_to_ok();
    TEST_ASSERT_EQUAL_UINT32(150000, urg_link_pause_us(&link_, &seen));
    seen.scan_count++;
    seen.framing_count = 1000; /* of a long life: what counts is what comes after a command */
    seen.strange_count = 500;
    seen.stray_count = 100;
    urg_link_scan_at(&link_, now_us);
    nothing_after(20000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
}

static void next_step(void)
{
    nothing_after(urg_link_pause_us(&link_, &seen));
}

static void lose(void)
{
    while (link_.status == URG_OK) {
        next_step();
    }
}

/* No request while the next frame comes; but one at once where the sensor has told of trouble. */
void test_octets_at_the_moment_of_the_loss_are_heard_to_their_end(void)
{
    stream_in_time();
    seen.octet_count++;
    nothing_after(300000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    nothing_after(200000);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_FALSE(action.send);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL_UINT32(160000, link_.timeout_us);
    stream_in_time();
    seen.octet_count += 21;
    seen.notice = (scip_reply_t){{'5', '0'}, false, 0};
    seen.notice_count++;
    nothing_after(50000);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
}

void test_the_own_rate_follows_the_sensors_after_90_ms(void)
{
    stream_in_time();
    lose();
    while (link_.rate != 115200) {
        next_step();
    }
    (void)reply_after(20000, SCIP_SWITCH, "0", true);
    (void)reply_after(20000, SCIP_BIT_RATE, "00", false);
    TEST_ASSERT_EQUAL_UINT32(90000, urg_link_pause_us(&link_, &seen));
    nothing_after(30000);
    TEST_ASSERT_EQUAL_UINT32(60000, urg_link_pause_us(&link_, &seen));
    nothing_after(59999);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    nothing_after(1);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
}

/* The seed's tick, as long as no stream was lost. */
void test_a_start_is_stepped_every_150_ms(void)
{
    reset(0);
    while (link_.status != URG_OK) {
        TEST_ASSERT_EQUAL_UINT32(150000, urg_link_pause_us(&link_, &seen));
        step();
    }
    TEST_ASSERT_EQUAL_UINT32(150000, urg_link_pause_us(&link_, &seen));
}

/* ---- what the search takes what it hears for ---- */

/* To the first window of a search in which nothing is sent at the stream's rate. */
static void listen_between(void)
{
    stream_in_time();
    lose();
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    while (link_.command != SCIP_SWITCH) {
        next_step();
    }
    while (link_.rate != 250000 || action.send) {
        next_step();
    }
    TEST_ASSERT_TRUE(link_.listening);
}

void test_a_mute_revolution_is_a_loss_and_one_with_an_octet_is_none(void)
{
    for (uint32_t octets = 0; octets < 2; octets++) {
        stream_in_time();
        const uint32_t scan_us = link_.frame_us;
        seen.octet_count += octets;
        nothing_after(scan_us + 129999 - now_us);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        nothing_after(1);
        TEST_ASSERT_EQUAL(octets == 0 ? URG_LOST : URG_OK, link_.status);
    }
}

void test_the_step_behind_a_mute_revolution_is_asked_for(void)
{
    stream_in_time();
    TEST_ASSERT_EQUAL_UINT32(link_.frame_us + 130000 - now_us, urg_link_pause_us(&link_, &seen));
    urg_link_scan_at(&link_, now_us + 80000);
    TEST_ASSERT_EQUAL_UINT32(150000, urg_link_pause_us(&link_, &seen));
}

void test_news_shorten_the_pause_in_a_search(void)
{
    listen_between();
    TEST_ASSERT_GREATER_THAN_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.reply_count++;
    TEST_ASSERT_EQUAL_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.reply_count--;
    seen.legacy_count++;
    TEST_ASSERT_EQUAL_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.legacy_count--;
    seen.stray_count++;
    TEST_ASSERT_EQUAL_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.stray_count--;
    seen.framing_count += 2;
    TEST_ASSERT_GREATER_THAN_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.strange_count++;
    TEST_ASSERT_EQUAL_UINT32(40000, urg_link_pause_us(&link_, &seen));
    seen.framing_count -= 2;
    seen.strange_count--;
    seen.scan_count++;
    TEST_ASSERT_EQUAL_UINT32(40000, urg_link_pause_us(&link_, &seen));
}

void test_a_frame_that_begins_in_a_listening_window_is_heard_to_its_end(void)
{
    listen_between();
    seen.octet_count += 60;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_FALSE(action.send);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL_UINT32(160000, link_.timeout_us);
    seen.octet_count += 101;
    nothing_after(160000);
    TEST_ASSERT_FALSE(action.send);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
}

/* Damage would make another request of it. */
void test_while_damaged_octets_come_nothing_is_sent_for_8_s(void)
{
    stream_in_time();
    seen.octet_count++;
    lose();
    const uint32_t lost_us = now_us;
    while (now_us - lost_us < 8000000) {
        TEST_ASSERT_FALSE(action.send);
        TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
        seen.octet_count += 101;
        seen.stray_count++;
        nothing_after(160000);
    }
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    nothing_after(130000); /* no octet more: an order for scans every time */
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
}

void test_damaged_octets_that_end_are_a_sensor_that_has_stopped(void)
{
    stream_in_time();
    seen.octet_count++;
    lose();
    TEST_ASSERT_FALSE(action.send);
    seen.octet_count += 60;
    nothing_after(30000);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(129999);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(1);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
}

void test_a_damaged_answer_and_nothing_else_repeats_the_order(void)
{
    stream_in_time();
    seen.octet_count++;
    seen.foreign_count++;
    lose();
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_TRUE(action.send);
    seen.octet_count += 47;
    nothing_after(130000);
    TEST_ASSERT_TRUE(action.send);
    seen.octet_count += 48; /* or a frame */
    nothing_after(130000);
    TEST_ASSERT_FALSE(action.send);
}

/* The line is good: it has heard a request that was damaged, or another host's. */
void test_a_stream_of_something_else_is_asked_to_be_another_at_once(void)
{
    stream_in_time();
    seen.octet_count += 101;
    seen.foreign_count++;
    nothing_after(20000);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL_UINT16(17, action.request.text_length); /* LF and MS, without TM2 */
    stream_in_time();
    seen.octet_count++;
    lose();
    TEST_ASSERT_FALSE(action.send);
    seen.octet_count += 101;
    seen.foreign_count++;
    TEST_ASSERT_TRUE(link_.listening);
    nothing_after(40000);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    seen.octet_count += 202; /* it goes on, and the order has no answer */
    seen.stray_count++;
    seen.foreign_count++;
    nothing_after(129999);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(1);
    TEST_ASSERT_TRUE(action.send);
}

/* What the sensor heard when other rates were probed stands before its answer. */
void test_an_answer_that_begins_with_strange_octets_is_heard_to_its_end(void)
{
    for (uint32_t framing = 0; framing < 2; framing++) {
        reset(0);
        while (link_.status != URG_LOST) {
            nothing_after(STEP_US);
        }
        const uint32_t rate = link_.rate;
        seen.octet_count += 13;
        seen.strange_count += 13;
        seen.framing_count += framing;
        nothing_after(100000);
        TEST_ASSERT_EQUAL(framing == 0, rate == link_.rate);
        if (framing == 0) {
            nothing_after(1);
            TEST_ASSERT_TRUE(rate != link_.rate);
        }
    }
}

/* It has stopped. Without an answer to that, it was heard at another rate. */
void test_a_sensor_that_was_just_heard_is_asked_once_more_at_its_rate(void)
{
    listen_between();
    seen.octet_count += 60;
    nothing_after(link_.timeout_us);
    nothing_after(160000);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    nothing_after(130000);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
}

static void ask_in_a_search(void)
{
    stream_in_time();
    lose();
    while (link_.command != SCIP_SWITCH) {
        next_step();
    }
}

static void repeat_the_request(void)
{
    ask_in_a_search();
    while (link_.command != SCIP_STREAM_2 || !action.send) {
        next_step();
    }
}

/* At half its rate an answer has few octets, and its end may look like that of a whole one. */
void test_an_answer_that_ends_well_at_half_its_rate_is_still_a_late_one(void)
{
    listen_between();
    seen.octet_count += 6;
    seen.strange_count += 3;
    seen.stray_count++;
    nothing_after(40000);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    repeat_the_request();
    seen.octet_count += 12;
    seen.framing_count += 3;
    seen.stray_count++;
    nothing_after(40000);
    nothing_after(130000);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
}

/* A sensor that has just booted must not wait for the answer that nobody gives. */
void test_a_repeated_request_delays_the_question_by_one_turn(void)
{
    repeat_the_request();
    const uint32_t asked_us = link_.asked_us;
    TEST_ASSERT_EQUAL_UINT32(40000, link_.timeout_us);
    nothing_after(40000);
    while (link_.command != SCIP_SWITCH || !action.send) {
        next_step();
    }
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(3U * REVOLUTION_US, now_us - asked_us);
}

/* A late first answer takes 381 ms, and each question of that time is answered behind it. */
void test_no_three_questions_lie_within_the_time_of_a_late_first_answer(void)
{
    uint32_t questions = 0, asked_us = 0;
    stream_in_time();
    const uint32_t begun_us = now_us;
    lose();
    while (now_us - begun_us < 11000000) {
        next_step();
        if (action.send && link_.command == SCIP_SWITCH) {
            TEST_ASSERT_TRUE(questions == 0 || now_us - asked_us >= 185000);
            TEST_ASSERT_TRUE(questions == 0 || now_us - asked_us <= 3 * REVOLUTION_US);
            asked_us = now_us;
            questions++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(45, questions);
}

/* 13 octets at twice the stream's rate are four at most, and may be heard without a fault. */
void test_a_few_octets_are_the_late_answer_of_a_sensor_that_powers_up_at_a_faster_rate(void)
{
    for (uint32_t signs = 0; signs < 3; signs++) {
        listen_between();
        link_.config.first_rate = link_.asked_rate = 500000;
        seen.octet_count += 1 + signs;
        seen.framing_count += signs;
        nothing_after(link_.timeout_us);
        TEST_ASSERT_EQUAL_UINT32(500000, link_.rate);
        TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    }
}

/* More than two answers could be, or nothing, or heard at a rate that is not the stream's. */
void test_other_octets_are_no_late_answer_of_a_faster_sensor(void)
{
    listen_between();
    const uint32_t stream_rate = link_.good_rate;
    link_.config.first_rate = link_.asked_rate = 500000;
    seen.octet_count += 60;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL_UINT32(stream_rate, link_.rate);
    TEST_ASSERT_NOT_EQUAL(SCIP_BIT_RATE, link_.command);
    listen_between();
    link_.config.first_rate = link_.asked_rate = 500000;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_NOT_EQUAL(SCIP_BIT_RATE, link_.command);
    listen_between();
    link_.config.first_rate = link_.asked_rate = 500000;
    link_.rate = 115200;
    seen.octet_count += 2;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_NOT_EQUAL(SCIP_BIT_RATE, link_.command);
    listen_between();
    link_.config.first_rate = link_.asked_rate = stream_rate; /* no faster one */
    seen.octet_count += 2;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_TRUE(link_.heard);
}

/* It has made a line of what it heard at another rate, or of SCIP2.0's end. */
void test_a_sensor_in_scip11_that_refuses_an_earlier_line_is_asked_again_and_never_old(void)
{
    ask_in_a_search();
    for (uint32_t i = 0; i < 3; i++) {
        seen.octet_count += 8;
        seen.legacy_count++;
        nothing_after(90000);
        TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
        TEST_ASSERT_FALSE(action.send);
    }
    nothing_after(129999);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(1);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    seen.legacy_count++;
    nothing_after(50000);
    TEST_ASSERT_EQUAL(URG_SWITCH, link_.status);
}

static void order_the_rate(void)
{
    ask_in_a_search();
    (void)reply_after(50000, SCIP_SWITCH, "0", true);
    TEST_ASSERT_EQUAL(URG_RATE, link_.status);
    TEST_ASSERT_TRUE(action.send);
}

/* While the first answer was awaited SCIP2.0 was sent again: those are refused first. */
void test_ss_waits_behind_the_answers_to_earlier_lines(void)
{
    order_the_rate();
    for (uint32_t i = 0; i < 4; i++) {
        seen.octet_count += 13;
        seen.stray_count++;
        nothing_after(115000);
        TEST_ASSERT_EQUAL(URG_RATE, link_.status);
        TEST_ASSERT_FALSE(action.send);
    }
    (void)reply_after(115000, SCIP_BIT_RATE, "00", false);
    nothing_after(90000);
    TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
}

void test_ss_of_a_dialogue_that_is_answered_late_has_changed_the_rate_too(void)
{
    order_the_rate();
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    seen.octet_count += 9;
    seen.framing_count += 5;
    nothing_after(40000);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(90000);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
}

void test_signs_of_another_rate_while_listening_are_a_late_answer(void)
{
    listen_between();
    seen.octet_count += 11;
    seen.framing_count += 2;
    nothing_after(40000);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    seen.framing_count++;
    nothing_after(1);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command); /* SCIP2.0 is obeyed; SS is next */
    TEST_ASSERT_EQUAL_UINT32(400000, link_.timeout_us);
}

void test_strange_octets_at_the_asked_rate_may_be_an_echo_and_framing_errors_are_the_stream(void)
{
    for (uint32_t framing = 0; framing < 2; framing++) {
        listen_between();
        while (link_.rate != 115200) {
            next_step();
        }
        seen.octet_count += 6;
        seen.strange_count += 6;
        seen.framing_count += 3 * framing;
        nothing_after(40000);
        TEST_ASSERT_EQUAL_UINT32(framing == 0 ? 115200 : 250000, link_.rate);
    }
    nothing_after(link_.timeout_us); /* no stream: the turn of the question again */
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
}

void test_a_stray_answer_gives_the_awaited_one_its_time(void)
{
    stream_in_time();
    lose();
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    seen.octet_count += 9;
    seen.stray_count++;
    nothing_after(80000);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    TEST_ASSERT_EQUAL_UINT32(210000, link_.timeout_us);
    TEST_ASSERT_FALSE(action.send);
    for (uint32_t i = 0; i < 4; i++) { /* not for ever: until 520 ms behind the command */
        seen.stray_count++;
        nothing_after(i < 3 ? 110000 : 109999);
    }
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    TEST_ASSERT_EQUAL_UINT32(519999 + 130000, link_.timeout_us);
    seen.stray_count++;
    nothing_after(1);
    TEST_ASSERT_EQUAL_UINT32(519999 + 130000, link_.timeout_us);
    nothing_after(130000);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_TRUE(action.send);
}

void test_ss_that_is_answered_late_means_that_the_sensor_has_the_streams_rate(void)
{
    stream_in_time();
    lose();
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(50000);
    TEST_ASSERT_FALSE(action.send); /* it changes its rate */
    TEST_ASSERT_EQUAL_UINT32(90000, urg_link_pause_us(&link_, &seen));
    nothing_after(89999);
    TEST_ASSERT_FALSE(action.send);
    nothing_after(1);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    while (!link_.listening) { /* it was noise: what is heard later is no answer to SS any more */
        nothing_after(link_.timeout_us);
    }
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(20000);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

/* ---- the rate at which the sensor powers up ---- */

void test_the_rate_at_which_scip_1_1_answers_is_where_the_next_search_begins(void)
{
    reset(0);
    sensor.rate = sensor.power_up_rate = 19200;
    TEST_ASSERT_FALSE(link_.config.first_rate_known);
    steps_to_ok();
    TEST_ASSERT_TRUE(link_.config.first_rate_known);
    TEST_ASSERT_EQUAL_UINT32(19200, link_.config.first_rate);
    sensor.on = false;
    const uint32_t begin = asked_count;
    steps(40);
    for (uint32_t i = begin; i < asked_count; i++) {
        TEST_ASSERT_TRUE(asked[i].rate == 19200 || asked[i].rate == 250000);
    }
    steps(100); /* 12 s after the latest scan it may be another sensor */
    uint32_t others = 0;
    for (uint32_t i = begin; i < asked_count; i++) {
        others += asked[i].rate == 57600;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(3, others);
}

void test_a_sensor_found_in_scip_2_0_teaches_no_rate_and_every_one_is_asked(void)
{
    uint32_t at[4] = {0};
    static const uint32_t rates[] = {19200, 57600, 115200, 250000};
    reset(0);
    start_streaming(250000);
    steps_to_ok();
    TEST_ASSERT_FALSE(link_.config.first_rate_known);
    sensor.on = false;
    const uint32_t begin = asked_count;
    steps(40);
    for (uint32_t i = begin; i < asked_count; i++) {
        for (uint32_t k = 0; k < 4; k++) {
            at[k] += asked[i].rate == rates[k];
        }
    }
    for (uint32_t k = 0; k < 4; k++) {
        TEST_ASSERT_GREATER_THAN_UINT32(1, at[k]);
    }
}

/* ---- a start in which the sensor falls silent ---- */

/* Up to the request of the stream's rate. */
static void start_until_rate(void)
{
    reset(0);
    config.fastest_rate = 0;
    (void)urg_link_init(&link_, &config, now_us);
    nothing_after(0);
    (void)reply_after(STEP_US, SCIP_LASER_OFF_1, "0", true);
    (void)reply_after(STEP_US, SCIP_SWITCH, "0", true);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
}

void test_a_sensor_that_answered_in_the_start_is_looked_for_at_the_two_rates_it_can_have(void)
{
    static const uint32_t rates[] = {250000, 115200};
    start_until_rate();
    const uint32_t answered_us = now_us;
    nothing_after(402001);
    for (uint32_t i = 0; now_us - answered_us < 12000000; i++) {
        TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
        TEST_ASSERT_EQUAL_UINT32(rates[i % 2], link_.rate);
        TEST_ASSERT_EQUAL_UINT32(130000, link_.timeout_us);
        TEST_ASSERT_EQUAL_UINT32(130000, urg_link_pause_us(&link_, &seen));
        nothing_after(130000);
    }
    for (uint32_t i = 0; i < 2 && link_.rate != 19200; i++) {
        nothing_after(500000);
    }
    TEST_ASSERT_EQUAL_UINT32(19200, link_.rate);
    TEST_ASSERT_GREATER_THAN_UINT32(130000, link_.timeout_us);
}

void test_it_is_looked_for_so_up_to_12_s_after_its_answer(void)
{
    for (uint32_t late_us = 0; late_us < 2; late_us++) {
        start_until_rate();
        nothing_after(11999999 + late_us);
        TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
        TEST_ASSERT_EQUAL(late_us == 0, link_.timeout_us == 130000);
    }
}

/* Of a sensor that was found at a third rate nothing is known when it falls silent. */
void test_an_answer_at_a_third_rate_tells_nothing_of_the_two(void)
{
    reset(0);
    nothing_after(0);
    while (link_.rate != 19200) {
        nothing_after(500000);
    }
    (void)reply_after(STEP_US, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    TEST_ASSERT_GREATER_THAN_UINT32(130000, link_.timeout_us);
}

void test_an_answer_of_scip_1_1_is_an_answer_too(void)
{
    reset(0);
    nothing_after(0);
    seen.legacy_count++;
    nothing_after(STEP_US);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    nothing_after(500000);
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    TEST_ASSERT_EQUAL_UINT32(130000, link_.timeout_us);
}

/* Nothing at all: the request or its answer was lost. An answer: the scans are waited for. */
void test_a_request_that_nothing_answers_is_given_up_after_400_ms(void)
{
    for (uint32_t heard = 0; heard < 2; heard++) {
        start_until_rate();
        (void)reply_after(STEP_US, SCIP_BIT_RATE, "00", false);
        nothing_after(STEP_US);
        (void)reply_after(STEP_US, SCIP_STOP, "00", false);
        TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
        seen.octet_count += heard;
        nothing_after(399999);
        TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
        nothing_after(1);
        TEST_ASSERT_EQUAL(heard == 0 ? URG_STOP2 : URG_STREAM, link_.status);
    }
}

/* ---- the less likely turns of a search ---- */

/* A stream of the whole circle fills 64 of 100 ms, so nothing is asked between two frames. */
void test_where_frames_leave_no_time_an_answer_is_awaited_for_130_ms(void)
{
    for (uint32_t whole = 0; whole < 2; whole++) {
        reset(0);
        if (whole == 1) {
            config.range = (scip_range_t){0, 768, 1, 0, 0};
            TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
        }
        link_.status = URG_OK;
        link_.good_rate = link_.rate = 250000;
        link_.config.first_rate_known = true;
        urg_link_scan_at(&link_, now_us);
        scan_after(1);
        lose();
        while (link_.command != SCIP_SWITCH) {
            nothing_after(link_.timeout_us);
        }
        nothing_after(link_.timeout_us);
        TEST_ASSERT_TRUE(link_.listening);
        TEST_ASSERT_EQUAL(whole == 1, link_.timeout_us == 160000);
        do {
            nothing_after(link_.timeout_us);
        } while (whole == 0 && link_.listening);
        TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
        TEST_ASSERT_TRUE(whole == 0 || link_.timeout_us == 130000);
    }
}

/* The sensor powers up at the stream's rate: octets of another one are noise. */
void test_noise_is_no_late_answer_where_the_sensor_has_one_rate(void)
{
    stream_in_time();
    link_.config.first_rate = link_.good_rate;
    lose();
    while (!link_.listening) {
        nothing_after(link_.timeout_us);
    }
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(20000);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
    TEST_ASSERT_TRUE(link_.knocking);
    TEST_ASSERT_EQUAL_UINT32(now_us, link_.sent_us); /* and the search goes on at once */
}

/* "0B": an earlier one, perhaps damaged on its way, had not been answered yet. */
void test_a_request_refused_because_of_an_earlier_one_is_repeated_once_and_then_listened_for(void)
{
    stream_in_time();
    seen.foreign_count++;
    lose();
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    (void)reply_after(100000, SCIP_STREAM_2, "0B", false);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL_UINT16(2, link_.attempt);
    (void)reply_after(100000, SCIP_STREAM_2, "0B", false);
    TEST_ASSERT_FALSE(action.send);
    TEST_ASSERT_TRUE(link_.listening);
    TEST_ASSERT_EQUAL_UINT16(0, link_.failures);
}

/* Octets that are no scan: a damaged one. No octet: the sensor has accepted, and does not scan. */
void test_after_an_accepted_request_silence_is_a_failure_and_octets_are_none(void)
{
    for (uint32_t octets = 0; octets < 2; octets++) {
        stream_in_time();
        seen.foreign_count++;
        lose();
        seen.octet_count += 21;
        (void)reply_after(100000, SCIP_STREAM_2, "00", false);
        TEST_ASSERT_EQUAL(URG_STREAM, link_.status);
        seen.octet_count += 101 * octets;
        nothing_after(link_.timeout_us - 100000);
        TEST_ASSERT_EQUAL_UINT16(octets == 0 ? 1 : 0, link_.failures);
        TEST_ASSERT_EQUAL(octets == 0 ? URG_STREAM : URG_LOST, link_.status);
    }
    stream_in_time();
    seen.foreign_count++;
    lose();
    seen.octet_count += 21;
    (void)reply_after(100000, SCIP_STREAM_2, "00", false);
    nothing_after(link_.timeout_us - 100000);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    nothing_after(link_.timeout_us); /* the second one was not accepted: its answer may be lost */
    TEST_ASSERT_EQUAL_UINT16(1, link_.failures);
}

/* Until 12 s after its answer. */
void test_an_answer_of_long_ago_tells_nothing_of_the_rate(void)
{
    start_until_rate();
    nothing_after(12000000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    TEST_ASSERT_NOT_EQUAL_UINT32(130000, link_.timeout_us);
}

/* Of four revolutions three are free: a question has its 130 ms between two frames. Steps may come late. */
void test_between_frames_of_every_fourth_revolution_a_question_has_its_time(void)
{
    uint32_t early = 0;
    for (uint32_t late_us = 0; late_us < 60000; late_us += 7000) {
        stream_every_fourth();
        link_.config.first_rate_known = true;
        urg_link_scan_at(&link_, now_us);
        const uint32_t frame_us = now_us;
        scan_after(1000);
        while (now_us - frame_us < 3000000) {
            nothing_after(urg_link_pause_us(&link_, &seen) + late_us);
            if (action.send && link_.command == SCIP_SWITCH) {
                const uint32_t since_us = (now_us - frame_us) % 400000;
                early += since_us > 30000 && since_us < 200000 ? 1 : 0;
                TEST_ASSERT_EQUAL_UINT32(130000, link_.timeout_us);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(3, early);
}

/* A stream that ends for questions has never searched: what is heard at another rate then is asked for at the
 * first one. */
void test_a_line_lost_while_the_sensor_is_asked_leads_to_no_rate_of_nought(void)
{
    stream_in_time();
    urg_link_ask(&link_);
    for (uint32_t i = 0; i < 60; i++) {
        seen.framing_count += 9;
        seen.octet_count += 9;
        nothing_after(urg_link_pause_us(&link_, &seen));
        TEST_ASSERT_NOT_EQUAL_UINT32(0, link_.rate);
    }
}

void test_a_first_word_is_said_twice_where_octets_are_clean(void)
{
    reset(0);
    nothing_after(0);
    for (uint16_t attempt = 1; attempt <= 2; attempt++) {
        TEST_ASSERT_EQUAL(SCIP_LASER_OFF_1, link_.command);
        TEST_ASSERT_EQUAL_UINT16(attempt, link_.attempt);
        seen.octet_count++;
        nothing_after(500000);
    }
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
}

static uint32_t next_request_after_us(void)
{
    const uint32_t before_us = now_us;
    do {
        nothing_after(urg_link_pause_us(&link_, &seen));
    } while (!action.send || link_.command != SCIP_STREAM_2);
    return now_us - before_us;
}

/* Each costs a frame of a sensor that streams out of hearing, and an answer's time of one that boots. */
void test_requests_of_a_search_come_each_8_s_and_each_0_4_s_to_a_sensor_that_has_answered(void)
{
    stream_in_time();
    lose();
    (void)next_request_after_us();
    TEST_ASSERT_UINT32_WITHIN(170000, 400000 + 170000, next_request_after_us());
    TEST_ASSERT_UINT32_WITHIN(170000, 8000000 + 170000, next_request_after_us());
    while (link_.command != SCIP_SWITCH) {
        next_step();
    }
    (void)reply_after(100000, SCIP_SWITCH, "0", true);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    (void)next_request_after_us();
    TEST_ASSERT_UINT32_WITHIN(170000, 400000 + 170000, next_request_after_us());
    TEST_ASSERT_UINT32_WITHIN(170000, 400000 + 170000, next_request_after_us());
    while (!link_.listening) {
        nothing_after(link_.timeout_us);
    }
    seen.octet_count += 202;
    seen.foreign_count++;
    nothing_after(40000);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL_UINT32(400000, link_.request_us); /* the sensor is there */
}

/* In a first search most rates are wrong, so only every third round through them waits for a late answer. */
void test_every_third_round_of_a_first_search_waits_for_late_answers(void)
{
    reset(0);
    config.fastest_rate = 0;
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    nothing_after(0);
    nothing_after(500000);
    for (uint32_t round = 0; round < 9; round++) {
        for (uint32_t i = 0; i < 6; i++) {
            TEST_ASSERT_EQUAL(round % 3 == 2, link_.timeout_us > 400000);
            nothing_after(600000);
        }
    }
    reset(0);
    config.first_rate = config.stream_rate = config.fastest_rate = 19200; /* a round of one rate */
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    nothing_after(0);
    nothing_after(500000);
    for (uint32_t round = 0; round < 9; round++) {
        TEST_ASSERT_EQUAL(round % 3 == 2, link_.timeout_us > 400000);
        nothing_after(600000);
    }
}

/* From the end of a frame's time, which grows with the time since the latest frame, to an answer's time; or
 * over the next frame and 50 ms on, or what is free. */
void test_a_question_ends_where_the_next_frame_is_not_lost(void)
{
    uint32_t over_a_frame = 0;
    stream_in_time();
    const uint32_t frame_us = link_.frame_us;
    lose();
    while (now_us - frame_us < 11000000) {
        nothing_after(urg_link_pause_us(&link_, &seen));
        if (action.send && link_.command == SCIP_SWITCH) {
            const uint32_t phase_us = PHASE_US + (now_us - frame_us) / 800U;
            const uint32_t gap_us = REVOLUTION_US - FRAME_US - 2U * phase_us;
            const uint32_t past_us = (now_us - frame_us + REVOLUTION_US - phase_us) % REVOLUTION_US;
            const uint32_t end_us = gap_us < 50000 ? gap_us : 50000;
            const bool over = past_us < end_us + 40000;
            TEST_ASSERT_EQUAL_UINT32(over ? REVOLUTION_US + end_us - past_us : 130000, link_.timeout_us);
            over_a_frame += over;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1, over_a_frame);
}

/* One sign of another rate among few octets is enough: nobody was heard. */
void test_an_octet_with_a_framing_error_is_nobody(void)
{
    for (uint32_t signs = 0; signs < 2; signs++) {
        listen_between();
        seen.octet_count += 3;
        seen.framing_count += signs;
        nothing_after(link_.timeout_us);
        TEST_ASSERT_EQUAL(signs == 0, link_.heard);
    }
}

void test_a_question_has_the_time_of_400_octets(void)
{
    stream_in_time();
    urg_link_ask(&link_);
    nothing_after(20000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    (void)reply_after(100000, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_VERSION, link_.command);
    TEST_ASSERT_EQUAL_UINT32(260000 + (action.request.text_length + 400U) * 41, link_.timeout_us);
}

static void request_in_a_search(void)
{
    stream_in_time();
    lose();
    while (link_.asked_kind != SCIP_SWITCH || link_.command != SCIP_STREAM_2 || !action.send) {
        nothing_after(link_.timeout_us);
    }
}

/* Heard while a request waits for its answer: the time of the request is over first. */
void test_a_late_answer_in_the_time_of_a_request_is_noticed_behind_it(void)
{
    for (uint32_t framing = 0; framing < 2; framing++) {
        request_in_a_search();
        seen.octet_count += 3;
        seen.framing_count += framing == 1 ? 3 : 0;
        seen.strange_count += framing == 0 ? 3 : 0;
        nothing_after(20000);
        TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
        nothing_after(link_.timeout_us - 20000);
        TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
        TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
        TEST_ASSERT_TRUE(action.send);
    }
}

/* The sensor echoes what it has heard at another rate: strange octets, and a right end. */
void test_a_whole_answer_to_nonsense_proves_the_rate(void)
{
    request_in_a_search();
    seen.octet_count += 12;
    seen.strange_count += 4;
    seen.stray_count++;
    nothing_after(20000);
    nothing_after(130000);
    TEST_ASSERT_TRUE(link_.heard);
    TEST_ASSERT_EQUAL_UINT32(250000, link_.rate);
}

void test_a_scan_in_a_listening_window_ends_the_search(void)
{
    listen_between();
    scan_after(10000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    TEST_ASSERT_FALSE(link_.knocking);
}

/* One sign of another rate among few octets: the first word is not said again there. */
void test_a_first_word_is_said_once_where_an_octet_is_not_clean(void)
{
    reset(0);
    nothing_after(0);
    seen.octet_count += 3;
    seen.framing_count++;
    nothing_after(500000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
}

/* Where a mute revolution would end just behind a step, the step comes earlier, and the next one in time. */
void test_a_step_leaves_room_for_the_one_behind_a_mute_revolution(void)
{
    stream_in_time();
    urg_link_scan_at(&link_, now_us + 20000); /* mute 150 ms from now */
    TEST_ASSERT_EQUAL_UINT32(110000, urg_link_pause_us(&link_, &seen));
    urg_link_scan_at(&link_, now_us + 30000); /* mute 160 ms from now */
    TEST_ASSERT_EQUAL_UINT32(120000, urg_link_pause_us(&link_, &seen));
    urg_link_scan_at(&link_, now_us + 59999);
    TEST_ASSERT_EQUAL_UINT32(149999, urg_link_pause_us(&link_, &seen));
    urg_link_scan_at(&link_, now_us + 60000);
    TEST_ASSERT_EQUAL_UINT32(150000, urg_link_pause_us(&link_, &seen));
}

/* ---- and of what only a long life shows ---- */

/* Where the sensor powers up at the stream's rate, TM2 and MS go together: the time of two answers. */
void test_a_request_behind_the_end_of_time_mode_has_the_time_of_two_answers(void)
{
    stream_in_time();
    link_.config.first_rate = link_.good_rate;
    lose();
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    TEST_ASSERT_EQUAL_UINT32(2 * 130000, link_.timeout_us);
}

/* Behind the time of the latest frame, which may be early or late; in the last 20 ms it is the one behind.
 * The second stream is of every fourth revolution, and lost 50 ms behind a frame. */
void test_a_listening_window_ends_where_the_next_frame_must_be_there(void)
{
    for (uint32_t k = 0; k < 20; k++) {
        const uint32_t fourth = k % 2, late_us = 2700 * k; /* of a step */
        const uint32_t period_us = fourth == 0 ? REVOLUTION_US : 4 * REVOLUTION_US;
        uint32_t windows = 0;
        stream_in_time();
        if (fourth == 1) {
            stream_every_fourth();
            link_.config.first_rate_known = true;
            urg_link_scan_at(&link_, now_us);
            scan_after(1000);
            seen.notice = (scip_reply_t){{'5', '0'}, false, 0};
            seen.notice_count++;
            nothing_after(49000);
        }
        const uint32_t frame_us = link_.frame_us;
        lose();
        while (now_us - frame_us < 6000000) {
            nothing_after(urg_link_pause_us(&link_, &seen) + late_us);
            if (link_.listening && link_.sent_us == now_us) {
                const uint32_t phase_us = PHASE_US + (now_us - frame_us) / 800U;
                const uint32_t left_us = period_us - (now_us - frame_us + period_us - phase_us) % period_us;
                TEST_ASSERT_EQUAL_UINT32(left_us < 20000 ? left_us + period_us : left_us, link_.timeout_us);
                windows++;
            }
        }
        TEST_ASSERT_GREATER_THAN_UINT32(5, windows);
    }
}

/* Who does not tell the times of the scans: an answer's time, and a revolution where the rate is a guess. */
void test_without_the_times_of_the_scans_a_question_has_the_time_of_an_answer(void)
{
    for (uint32_t known = 0; known < 2; known++) {
        uint32_t questions = 0;
        reset(0);
        steps_to_ok();
        link_.config.first_rate_known = known == 1;
        lose();
        for (uint32_t i = 0; i < 100; i++) {
            nothing_after(urg_link_pause_us(&link_, &seen));
            if (action.send && link_.command == SCIP_SWITCH) {
                TEST_ASSERT_EQUAL_UINT32(known == 1 ? 130000 : 230000, link_.timeout_us);
                questions++;
            }
        }
        TEST_ASSERT_GREATER_THAN_UINT32(10, questions);
    }
}

/* Within a revolution and 30 ms the next octets of a stream may still come. */
void test_octets_of_a_moment_ago_are_no_silence(void)
{
    for (uint32_t quiet_us = 110000; quiet_us <= 150000; quiet_us += 40000) {
        listen_between();
        seen.octet_count += 101;
        nothing_after(link_.timeout_us);
        TEST_ASSERT_TRUE(link_.listening);
        seen.octet_count += 50;
        nothing_after(160000 - quiet_us);
        nothing_after(quiet_us);
        TEST_ASSERT_EQUAL(quiet_us > 130000, action.send);
    }
}

void test_what_the_parser_counts_of_others_is_seen(void)
{
    scip_parser_t own;
    urg_seen_t told = {.stray_count = 0};
    scip_parser_init(&own);
    own.counters.stray = 5;
    own.counters.foreign = 2;
    urg_seen_octets(&told, &own);
    TEST_ASSERT_EQUAL_UINT32(5, told.stray_count);
    TEST_ASSERT_EQUAL_UINT32(2, told.foreign_count);
}

/* The sensor has restarted while it was asked. What it was not asked any more is not asked much later. */
void test_questions_that_a_restart_has_cut_short_are_not_asked_behind_a_later_order(void)
{
    static const scip_range_t other = {372, 405, 1, 0, 0};
    stream_in_time();
    urg_link_ask(&link_);
    nothing_after(20000);
    (void)reply_after(100000, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_VERSION, link_.command);
    seen.legacy_count++;
    nothing_after(100000);
    (void)reply_after(100000, SCIP_SWITCH, "00", false);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
    urg_link_scan_at(&link_, now_us + 100000);
    scan_after(100000);
    urg_link_order(&link_, &other);
    nothing_after(20000);
    TEST_ASSERT_EQUAL(SCIP_STOP, link_.command);
    (void)reply_after(100000, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, link_.command);
}

/* 129 points: 295 octets. */
void test_another_range_has_the_times_of_its_own_frames(void)
{
    static const scip_range_t other = {372, 500, 1, 0, 0};
    stream_in_time();
    urg_link_order(&link_, &other);
    nothing_after(20000);
    (void)reply_after(100000, SCIP_STOP, "00", false);
    TEST_ASSERT_EQUAL_UINT32(260000 + (16 + 21 + 295) * 41, link_.timeout_us);
    scan_after(100000);
    TEST_ASSERT_EQUAL_UINT32(2 * REVOLUTION_US + 295 * 41 + 250000, link_.timeout_us);
}

/* MD of the whole circle takes two revolutions and a tenth at 115200: a frame comes with every third. */
void test_frames_longer_than_a_revolution_are_late_behind_their_own_time(void)
{
    reset(0);
    config.stream_rate = 115200;
    config.stream = SCIP_STREAM_3;
    config.range = (scip_range_t){0, 768, 1, 0, 0};
    TEST_ASSERT_TRUE(urg_link_init(&link_, &config, now_us));
    link_.status = URG_OK;
    link_.good_rate = link_.rate;
    urg_link_scan_at(&link_, now_us);
    scan_after(0);
    nothing_after(329999);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    nothing_after(1);
    TEST_ASSERT_EQUAL(URG_LOST, link_.status);
}

/* Its power-up rate is not known: a late answer is that to the rate asked last, and is asked for again there.
 */
void test_a_late_answer_to_an_unknown_rate_is_asked_for_at_the_rate_asked_last(void)
{
    stream_in_time();
    link_.config.first_rate_known = false;
    lose();
    uint32_t asked_rate = 0;
    while (!link_.listening || asked_rate == 0 || asked_rate == link_.config.first_rate) {
        nothing_after(link_.timeout_us);
        asked_rate = action.send && link_.command == SCIP_SWITCH ? link_.rate : asked_rate;
    }
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(20000);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
    TEST_ASSERT_EQUAL_UINT32(asked_rate, link_.rate);
}

/* The search has ordered it already. */
void test_a_range_ordered_in_a_search_costs_no_second_interruption(void)
{
    static const scip_range_t other = {372, 500, 1, 0, 0};
    listen_between();
    urg_link_order(&link_, &other);
    seen.octet_count += 202; /* of the range before */
    seen.foreign_count++;
    nothing_after(20000);
    TEST_ASSERT_TRUE(action.send);
    urg_link_scan_at(&link_, now_us + 50000);
    scan_after(50000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    for (uint32_t i = 0; i < 5; i++) {
        urg_link_scan_at(&link_, now_us + REVOLUTION_US);
        scan_after(REVOLUTION_US);
        TEST_ASSERT_EQUAL(URG_OK, link_.status);
        TEST_ASSERT_FALSE(action.send);
    }
}

/* What was taken for a late answer to SS was noise: the same noise behind it is the answer to SCIP2.0. And
 * the sensor has left time mode before: no TM2 any more. */
void test_noise_is_taken_for_a_late_answer_to_ss_only_once(void)
{
    stream_in_time();
    lose();
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    for (uint32_t i = 0; i < 4 && link_.command != SCIP_BIT_RATE; i++) {
        seen.octet_count += 3;
        seen.framing_count += 3;
        nothing_after(50000);
        while (link_.rate == 250000 && !action.send) {
            next_step();
        }
    }
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
    for (uint32_t i = 0; i < 40; i++) {
        next_step();
        TEST_ASSERT_NOT_EQUAL(SCIP_TIME_LEAVE, link_.command);
    }
}

/* Octets of another rate just behind the loss: the sensor has restarted, and need not be waited for. */
void test_signs_of_another_rate_end_the_first_window_of_a_search_at_once(void)
{
    stream_in_time();
    seen.octet_count++;
    lose();
    TEST_ASSERT_TRUE(link_.listening);
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(20000);
    TEST_ASSERT_EQUAL_UINT32(115200, link_.rate);
}

/* Who was heard in an earlier search, and streamed again, is not asked as if it had just been heard. */
void test_what_an_earlier_search_has_heard_says_nothing_in_the_next_one(void)
{
    listen_between();
    seen.octet_count += 101;
    nothing_after(link_.timeout_us);
    TEST_ASSERT_TRUE(link_.heard);
    urg_link_scan_at(&link_, now_us);
    scan_after(50000);
    TEST_ASSERT_EQUAL(URG_OK, link_.status);
    seen.octet_count++;
    lose();
    TEST_ASSERT_TRUE(link_.listening);
    nothing_after(link_.timeout_us);
    TEST_ASSERT_EQUAL(SCIP_SWITCH, link_.command);
}

/* After the late answer, as after one in time, the request comes each 0.4 s, not each 8. */
void test_a_sensor_whose_late_answer_was_heard_is_asked_for_its_scans_each_0_4_s(void)
{
    stream_in_time();
    lose();
    (void)next_request_after_us();
    (void)next_request_after_us();
    while (!link_.listening) {
        nothing_after(link_.timeout_us);
    }
    seen.octet_count += 3;
    seen.framing_count += 3;
    nothing_after(20000);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, link_.command);
    for (uint32_t i = 0; i < 3; i++) {
        TEST_ASSERT_UINT32_WITHIN(470000, 100000 + 470000, next_request_after_us());
    }
}

/* No answer for 8 s, then scans of another request: the sensor is there. */
void test_a_stream_of_something_else_makes_requests_frequent_again(void)
{
    stream_in_time();
    lose();
    (void)next_request_after_us();
    (void)next_request_after_us();
    while (!link_.listening) {
        nothing_after(link_.timeout_us);
    }
    TEST_ASSERT_EQUAL_UINT32(8000000, link_.request_us);
    seen.octet_count += 202;
    seen.foreign_count++;
    nothing_after(20000);
    TEST_ASSERT_TRUE(action.send);
    TEST_ASSERT_EQUAL_UINT32(400000, link_.request_us);
}

/* The parser forgets octets of a line that is longer than its memory; what was told stays told. */
void test_strange_octets_of_a_long_line_are_not_taken_back(void)
{
    scip_parser_t own;
    urg_seen_t told = {.strange_count = 0};
    scip_parser_init(&own);
    for (uint32_t i = 0; i < 600; i++) {
        (void)scip_parser_feed(&own, (octet_t)(i == 0 ? 0x80U : 'x'));
        urg_seen_octets(&told, &own);
        TEST_ASSERT_EQUAL_UINT32(1, told.strange_count);
    }
    TEST_ASSERT_EQUAL_UINT32(0, scip_parser_strange(&own));
}
