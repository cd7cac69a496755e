#include "scanner.h"

#include <stdio.h>
#include <string.h>

#include "sim/host/pace.h"
#include "drivers/urg_link.h"

#define FIRST_RATE 115200UL
#define STEP (150 * SIM_MS)
#define ASK_PATIENCE SIM_S

static struct {
    scanner_config_t config;
    port_t port;
    scip_parser_t parser;
    scip_scan_t scan;
    uint16_t distance_mm[SCIP_POINTS_MAX];
    urg_link_t link;
    urg_seen_t seen;
    bool linked; /* the link drives the conversation */
    char *text;  /* of the reply asked for */
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

static void send(const scip_request_t *request)
{
    unsigned char octets[SCIP_REQUEST_MAX];

    for (uint16_t i = 0; i < request->text_length; i++) {
        octets[i] = (unsigned char)request->text[i];
    }
    tap(false, octets, request->text_length);
    port_write(&scanner.port, octets, request->text_length);
}

static void set_rate(uint32_t rate)
{
    const char *error = port_set_rate(&scanner.port, rate);

    scip_parser_line_broken(&scanner.parser);
    if (error != NULL) {
        fprintf(stderr, "%s at %lu bit/s: %s\n", scanner.port.name, (unsigned long)rate, error);
    }
}

static void step(void *context)
{
    urg_action_t action;

    if (!scanner.linked) {
        return;
    }
    urg_link_step(&scanner.link, &scanner.seen, now_us(), &action);
    if (action.set_rate) {
        set_rate(action.rate);
    }
    if (action.expect) {
        scip_parser_expect(&scanner.parser, &action.request);
    }
    if (action.send) {
        send(&action.request);
    }
    timeline_after(STEP, step, context);
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

static void note(scip_event_t event)
{
    urg_seen_event(&scanner.seen, &scanner.parser, event);
    if (event == SCIP_TEXT) {
        keep_text();
    }
}

static void received(void *context, const unsigned char *octets, size_t count)
{
    (void)context;
    tap(true, octets, count);
    for (size_t i = 0; i < count; i++) {
        urg_seen_octets(&scanner.seen, &octets[i], 1);
        note(scip_parser_feed(&scanner.parser, octets[i]));
    }
}

/* True when `done` within so many seconds, and not interrupted before. */
static bool run_until(bool (*done)(void), double seconds)
{
    const sim_time_t end = timeline_now() + (sim_time_t)(seconds * 1e9);

    while (!done() && timeline_now() < end && !pace_interrupted()) {
        pace_run();
    }
    return done();
}

static bool streaming(void)
{
    return scanner.link.status == URG_OK;
}

static bool never(void)
{
    return false;
}

static void begin_link(void)
{
    const urg_config_t config = {
        .wait_us = 0,
        .first_rate = FIRST_RATE,
        .stream_rate = (uint32_t)scanner.config.rate,
        .stream = SCIP_STREAM_2,
        .range = {(uint16_t)scanner.config.first_step, (uint16_t)scanner.config.last_step, 1, 0, 0},
    };

    (void)urg_link_init(&scanner.link, &config, now_us());
    scanner.linked = true;
    timeline_after(0, step, NULL);
}

const char *scanner_open(const scanner_config_t *config)
{
    const char *error;

    memset(&scanner, 0, sizeof scanner);
    scanner.config = *config;
    error = port_open_device(&scanner.port, config->device, FIRST_RATE);
    if (error != NULL) {
        return error;
    }
    scip_parser_init(&scanner.parser);
    scanner.scan.distance_mm = scanner.distance_mm;
    scanner.scan.capacity = SCIP_POINTS_MAX;
    scip_parser_scan_into(&scanner.parser, &scanner.scan);
    timeline_reset();
    pace_begin();
    pace_watch(&scanner.port, received, NULL);
    begin_link();
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

/* Waits for the answer even when interrupted. */
static bool converse(scip_kind_t kind)
{
    const sim_time_t end = timeline_now() + ASK_PATIENCE;
    const uint32_t replies = scanner.seen.reply_count;
    scip_request_t request;

    scanner.linked = false;
    (void)scip_request(&request, kind);
    scip_parser_expect(&scanner.parser, &request);
    send(&request);
    while (scanner.seen.reply_count == replies && timeline_now() < end) {
        pace_run();
    }
    return scanner.seen.reply_count != replies;
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
    return answered && scanner.seen.reply.status[0] == '0' && scanner.seen.reply.status[1] == '0';
}

unsigned long scanner_scans(void)
{
    return scanner.seen.scan_count;
}

unsigned long scanner_damaged(void)
{
    return scanner.seen.damage_count;
}

unsigned long scanner_rate(void)
{
    return scanner.link.rate;
}
