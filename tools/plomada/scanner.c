#include "scanner.h"

#include <stdio.h>
#include <string.h>

#include "sim/host/pace.h"
#include "drivers/urg.h"

#define FIRST_RATE 115200UL
#define ASK_PATIENCE SIM_S
#define GAP_MS 1000U /* between two scans: the stream was lost */

static struct {
    scanner_config_t config;
    port_t port;
    urg_driver_t urg;
    uint16_t distance_mm[2 * SCIP_POINTS_MAX];
    unsigned long rate;                         /* of the latest scan */
    uint32_t first_ms, latest_ms, stream_scans; /* of the scans since the latest gap */
    bool asking;                                /* the dialogue is ours, not the link's */
    scip_parser_t parser;                       /* of that dialogue */
    bool answered;
    char *text; /* of the reply asked for */
    size_t text_size;
} scanner;

static uint32_t now_us(void)
{
    return (uint32_t)(timeline_now() / SIM_US);
}

static void tap(bool from_sensor, const unsigned char *octets, size_t count)
{
    scanner.config.tap(scanner.config.context, from_sensor, (long long)(timeline_now() / SIM_US), octets,
                       count);
}

static void send(const octet_t *text, uint16_t length)
{
    unsigned char octets[SCIP_REQUEST_MAX];

    for (uint16_t i = 0; i < length; i++) {
        octets[i] = (unsigned char)text[i];
    }
    tap(false, octets, length);
    port_write(&scanner.port, octets, length);
}

static void set_rate(uint32_t rate)
{
    const char *error = port_set_rate(&scanner.port, rate);

    if (error != NULL) {
        fprintf(stderr, "%s at %lu bit/s: %s\n", scanner.port.name, (unsigned long)rate, error);
    }
}

static void step(void *context)
{
    urg_output_t output;

    if (scanner.asking) {
        return;
    }
    urg_step(&scanner.urg, now_us());
    if (urg_next_to_send(&scanner.urg, &output)) {
        if (output.set_rate) {
            set_rate(output.rate);
        }
        if (output.count > 0) {
            send(output.octets, output.count);
        }
    }
    timeline_after((sim_time_t)urg_pause_us(&scanner.urg) * SIM_US, step, context);
}

static void keep_text(void)
{
    const scip_parser_t *parser = &scanner.parser;
    const size_t used = scanner.text == NULL ? 0 : strlen(scanner.text);

    if (scanner.text == NULL || used + parser->text_length + 2U > scanner.text_size) {
        return;
    }
    for (uint16_t i = 0; i < parser->text_length; i++) {
        scanner.text[used + i] = (char)parser->line[i];
    }
    memcpy(scanner.text + used + parser->text_length, "\n", 2);
}

static void take_scan(void)
{
    scip_scan_t scan;

    if (!urg_take_scan(&scanner.urg, &scan)) {
        return;
    }
    scanner.rate = port_rate(&scanner.port);
    if (scanner.stream_scans == 0 || ((scan.timestamp_ms - scanner.latest_ms) & 0xFFFFFFU) > GAP_MS) {
        scanner.first_ms = scan.timestamp_ms;
        scanner.stream_scans = 0;
    }
    scanner.latest_ms = scan.timestamp_ms;
    scanner.stream_scans++;
}

static void take_answer(scip_event_t event)
{
    if (event == SCIP_TEXT) {
        keep_text();
    }
    scanner.answered = scanner.answered || event == SCIP_REPLY;
}

static void received(void *context, const unsigned char *octets, size_t count)
{
    (void)context;
    tap(true, octets, count);
    for (size_t i = 0; i < count; i++) {
        if (scanner.asking) {
            take_answer(scip_parser_feed(&scanner.parser, octets[i]));
        } else if (urg_feed(&scanner.urg, &octets[i], 1)) {
            take_scan();
        }
    }
}

/* True when `done` within so many seconds, and not interrupted before. */
static bool run_until(bool (*done)(void), double seconds)
{
    const sim_time_t end = timeline_now() + (sim_time_t)(seconds * 1e9);

    while (!done() && timeline_now() < end && !pace_interrupted() && !scanner_is_gone()) {
        pace_run();
    }
    return done();
}

static urg_report_t report(void)
{
    urg_report_t now;

    urg_report(&scanner.urg, &now);
    return now;
}

static bool streaming(void)
{
    return report().status == URG_OK;
}

static bool never(void)
{
    return false;
}

/* The fastest of SCIP's rates that the port can do. */
static uint32_t fastest_rate(void)
{
    uint32_t fastest = FIRST_RATE;

    for (size_t i = 0; i < SCIP_BIT_RATES; i++) {
        if (port_set_rate(&scanner.port, scip_bit_rates[i]) == NULL && scip_bit_rates[i] > fastest) {
            fastest = scip_bit_rates[i];
        }
    }
    return fastest;
}

static const char *begin_link(void)
{
    const urg_config_t config = {
        .wait_us = 0,
        .first_rate = FIRST_RATE,
        .stream_rate = (uint32_t)scanner.config.rate,
        .fastest_rate = fastest_rate(),
        .stream = SCIP_STREAM_2,
        .range = {(uint16_t)scanner.config.first_step, (uint16_t)scanner.config.last_step, 1, 0, 0},
    };
    const char *error = port_set_rate(&scanner.port, scanner.config.rate);

    if (error != NULL) {
        return error;
    }
    error = port_set_rate(&scanner.port, FIRST_RATE);
    if (error == NULL &&
        !urg_init(&scanner.urg, &config, scanner.distance_mm, 2 * SCIP_POINTS_MAX, now_us())) {
        return "no such stream";
    }
    return error;
}

const char *scanner_open(const scanner_config_t *config)
{
    const char *error;

    memset(&scanner, 0, sizeof scanner);
    scanner.config = *config;
    timeline_reset();
    error = port_open_device(&scanner.port, config->device, FIRST_RATE);
    if (error == NULL) {
        error = begin_link();
    }
    if (error != NULL) {
        port_close(&scanner.port);
        return error;
    }
    pace_begin();
    pace_watch(&scanner.port, received, NULL);
    timeline_after(0, step, NULL);
    return NULL;
}

void scanner_close(void)
{
    pace_end();
    port_close(&scanner.port);
}

bool scanner_start(double patience_s)
{
    return run_until(streaming, patience_s);
}

bool scanner_run(double seconds)
{
    (void)run_until(never, seconds);
    return !pace_interrupted();
}

bool scanner_is_gone(void)
{
    return pace_lost(&scanner.port);
}

/* Waits for the answer even when interrupted. */
static bool converse(scip_kind_t kind)
{
    const sim_time_t end = timeline_now() + ASK_PATIENCE;
    scip_request_t request;

    scanner.asking = true;
    scanner.answered = false;
    scip_parser_init(&scanner.parser);
    (void)scip_request(&request, kind);
    scip_parser_expect(&scanner.parser, &request);
    send(request.text, request.text_length);
    while (!scanner.answered && timeline_now() < end && !scanner_is_gone()) {
        pace_run();
    }
    return scanner.answered;
}

bool scanner_stop(void)
{
    return converse(SCIP_STOP);
}

bool scanner_ask(scip_kind_t kind, char *text, size_t size)
{
    bool answered;

    text[0] = '\0';
    scanner.text = text;
    scanner.text_size = size;
    answered = converse(kind);
    scanner.text = NULL;
    return answered && scanner.parser.reply.status[0] == '0' && scanner.parser.reply.status[1] == '0';
}

unsigned long scanner_rate(void)
{
    return scanner.rate;
}

double scanner_scans_per_s(void)
{
    const uint32_t lasted_ms = (scanner.latest_ms - scanner.first_ms) & 0xFFFFFFU;

    return scanner.stream_scans < 2 ? 0.0 : 1e3 * (scanner.stream_scans - 1) / lasted_ms;
}
