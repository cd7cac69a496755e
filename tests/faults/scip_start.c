/* The scanner link against the model of the sensor, octet by octet in virtual time: how long it takes from each start
 * state to the first scan, and the same with faults at every octet of the start and of a frame. Exit status 1 when
 * streaming is not reached, a wrong distance comes, or the power pin would have been needed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_parser.h"
#include "sim/devices/serial.h"
#include "sim/devices/urg04lx.h"
#include "sim/timeline.h"
#include "drivers/urg_link.h"

#define STEP (150 * SIM_MS)
#define PATIENCE (60 * SIM_S)
#define POINTS 35
#define NO_OCTET 0U

typedef struct {
    unsigned lost_to_host, lost_to_sensor;      /* number of the octet, from 1; NO_OCTET: none */
    unsigned sensor_restart, host_restart;      /* at this octet to the host */
    unsigned host_restart_sent;                 /* at this octet to the sensor */
} faults_t;

static struct {
    urg04lx_t *sensor;
    serial_t transmitter;
    double rate;
    bool listening;
    scip_parser_t parser;
    scip_scan_t scan;
    uint16_t points[POINTS];
    urg_link_t link;
    urg_config_t config;
    urg_seen_t seen;
    faults_t faults;
    unsigned to_host, to_sensor;                /* octets since the start */
    unsigned wrong, power_cycles;
    sim_time_t started, latest_scan;
    timeline_id_t step;
} host;

static bool holds = true;

/* ---- the world: a surface that every ray sees at its own distance ---- */

static int distance_at(int step)
{
    return 600 + 7 * (step % 40);
}

static void look(void *context, int first_step, int last_step, int *distance_mm)
{
    (void)context;
    for (int step = first_step; step <= last_step; step++) {
        distance_mm[step - first_step] = distance_at(step);
    }
}

/* ---- the host, as an application of the driver is written ---- */

static void check_scan(void)
{
    host.seen.scan_count++;
    host.seen.scan_remaining = host.scan.remaining;
    host.latest_scan = timeline_now();
    for (int i = 0; i < POINTS; i++) {
        host.wrong += host.points[i] != distance_at(372 + i);
    }
}

static void note(scip_event_t event)
{
    switch (event) {
    case SCIP_REPLY:
        host.seen.reply_count++;
        host.seen.reply_kind = host.parser.awaited.kind;
        host.seen.reply = host.parser.reply;
        break;
    case SCIP_SCAN:
        check_scan();
        break;
    case SCIP_NOTICE:
        host.seen.notice_count++;
        host.seen.notice = host.parser.reply;
        break;
    case SCIP_LEGACY:
        host.seen.legacy_count++;
        break;
    case SCIP_DAMAGED:
        host.seen.damage_count++;
        break;
    default:
        break;
    }
}

static void step(void *context)
{
    urg_action_t action;

    (void)context;
    host.step = timeline_after(STEP, step, NULL);
    urg_link_step(&host.link, &host.seen, (uint32_t)(timeline_now() / SIM_US), &action);
    host.power_cycles += action.cycle_power;
    if (action.set_rate) {
        scip_parser_line_broken(&host.parser);
        host.rate = action.rate;
        serial_flush(&host.transmitter);
        serial_set_rate(&host.transmitter, action.rate);
    }
    if (action.send) {
        scip_parser_expect(&host.parser, &action.request);
        serial_send(&host.transmitter, action.request.text, action.request.text_length);
    }
}

/* Everything forgotten, as after a reset; the wire and the sensor go on. */
static void start_host(void *context)
{
    (void)context;
    host.listening = true;
    host.seen = (urg_seen_t){ .reply_count = 0 };
    host.scan = (scip_scan_t){ .distance_mm = host.points, .capacity = POINTS };
    host.rate = host.config.first_rate;
    host.latest_scan = 0;
    host.started = timeline_now();
    serial_set_rate(&host.transmitter, host.rate);
    scip_parser_init(&host.parser);
    scip_parser_scan_into(&host.parser, &host.scan);
    urg_link_init(&host.link, &host.config, (uint32_t)(timeline_now() / SIM_US));
    host.step = timeline_after(STEP, step, NULL);
}

static void stop_host(void)
{
    host.listening = false;
    timeline_cancel(host.step);
    serial_flush(&host.transmitter);
}

static void power_sensor(void *context)
{
    (void)context;
    urg04lx_power(host.sensor, true);
}

static void restart_host(void)
{
    stop_host();
    timeline_after(100 * SIM_MS, start_host, NULL);
}

static void break_in(void)
{
    if (host.to_host == host.faults.sensor_restart) {
        urg04lx_power(host.sensor, false);
        timeline_after(100 * SIM_MS, power_sensor, NULL);
    }
    if (host.to_host == host.faults.host_restart) {
        restart_host();
    }
}

/* Of an octet at another rate the UART makes a framing error, or now and then some octet. */
static void hear_noise(unsigned octet)
{
    scip_parser_line_broken(&host.parser);
    if (octet % 4 == 0) {
        host.seen.octet_count++;
        note(scip_parser_feed(&host.parser, (octet_t)(octet ^ 0xA5U)));
    } else {
        host.seen.framing_count++;
    }
}

static void to_host(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    if (!host.listening) {
        return;
    }
    host.to_host++;
    break_in();
    if (!host.listening || host.to_host == host.faults.lost_to_host) {
        return;
    }
    if (fabs(bit_ns * host.rate / 1e9 - 1.0) > 0.045) {
        hear_noise(octet);
        return;
    }
    host.seen.octet_count++;
    note(scip_parser_feed(&host.parser, (octet_t)octet));
}

static void to_sensor(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    host.to_sensor++;
    if (host.to_sensor == host.faults.host_restart_sent) {
        restart_host();
    }
    if (host.to_sensor != host.faults.lost_to_sensor) {
        urg04lx_receive(host.sensor, octet, bit_ns);
    }
}

/* ---- running ---- */

static void run_until(sim_time_t when)
{
    while (timeline_next() <= when) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(when);
}

static void power_up(double rate)
{
    urg04lx_config_t config = urg04lx_default;

    config.power_up_rate = rate;
    config.phase = 13 * SIM_MS;
    timeline_reset();
    memset(&host, 0, sizeof host);
    host.sensor = urg04lx_create(&config, look, NULL, to_host, NULL);
    serial_init(&host.transmitter, rate, to_sensor, NULL);
    urg04lx_power(host.sensor, true);
    host.config = (urg_config_t){ .first_rate = 115200, .stream_rate = 250000, .stream = SCIP_STREAM_2,
                                  .range = { 372, 406, 1, 0, 0 } };
}

static void power_down(void)
{
    stop_host();
    urg04lx_destroy(host.sensor);
}

/* Runs until scans have come for a second without a pause. The time from the start to the first of them, or a negative
 * number. */
static double seconds_to_stream(void)
{
    const sim_time_t end = timeline_now() + PATIENCE;
    sim_time_t first = 0;

    while (timeline_now() < end) {
        run_until(timeline_now() + 50 * SIM_MS);
        if (host.latest_scan == 0 || timeline_now() - host.latest_scan > 250 * SIM_MS) {
            first = 0;
        } else if (first == 0) {
            first = host.latest_scan;
        } else if (timeline_now() - first > SIM_S) {
            return (double)(first - host.started) / 1e9;
        }
    }
    return -1.0;
}

static void complain(const char *what, const char *where, unsigned number)
{
    printf("FAILED: %s: %s %u\n", what, where, number);
    holds = false;
}

static double check_run(const char *where, unsigned number)
{
    const double seconds = seconds_to_stream();

    if (seconds < 0.0) {
        complain("no scans", where, number);
    }
    if (host.wrong != 0) {
        complain("a wrong distance", where, number);
    }
    if (host.power_cycles != 0) {
        complain("the power pin was needed", where, number);
    }
    return seconds;
}

/* ---- from each start state ---- */

/* What another host left behind: commands sent at these rates, 300 ms apart. */
static void leave(const char *text, double rate)
{
    for (; *text != '\0'; text++) {
        urg04lx_receive(host.sensor, (unsigned char)*text, 1e9 / rate);
        run_until(timeline_now() + SIM_MS);
    }
    run_until(timeline_now() + 300 * SIM_MS);
}

typedef struct {
    const char *name;
    bool scip2;
    const char *left_behind;
} state_t;

static const state_t states[] = {
    { "SCIP1.1", false, "" },
    { "SCIP1.1, half a command", false, "SCIP2" },
    { "SCIP2.0, idle", true, "" },
    { "SCIP2.0, laser on", true, "BM\n" },
    { "SCIP2.0, half a command", true, "MS0372" },
    { "streaming MS", true, "MS0372040601000\n" },
    { "streaming MD, another range", true, "MD0044072501000\n" },
    { "a counted run", true, "MS0372040601399\n" },
    { "time mode", true, "TM0\n" },
    { "time mode, half a command", true, "TM0\nT" },
};

static void prepare(const state_t *state, int rate)
{
    char text[20];

    power_up(state->scip2 ? 115200 : rate);
    run_until(9 * SIM_S);
    if (state->scip2) {
        leave("SCIP2.0\n", 115200);
        snprintf(text, sizeof text, "SS%06d\n", rate);
        leave(text, 115200);
    }
    leave(state->left_behind, rate);
}

/* The slowest of starts at ten moments of a revolution. */
static double slowest_start(const state_t *state, int rate, uint32_t wait_us)
{
    double slowest = 0.0;

    for (unsigned phase = 0; phase < 10; phase++) {
        prepare(state, rate);
        run_until(timeline_now() + phase * 37 * SIM_MS);
        host.config.wait_us = wait_us;
        start_host(NULL);
        slowest = fmax(slowest, check_run(state->name, (unsigned)rate));
        power_down();
    }
    return slowest;
}

static void print_table(uint32_t wait_us)
{
    static const int rates[] = { 19200, 57600, 115200, 250000 };

    printf("%-30s %8s %8s %8s %8s\n", "the sensor is in", "19200", "57600", "115200", "250000");
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        printf("%-30s", states[i].name);
        for (size_t k = 0; k < sizeof rates / sizeof rates[0]; k++) {
            printf(" %8.2f", slowest_start(&states[i], rates[k], wait_us));
        }
        printf("\n");
    }
}

/* ---- faults at every octet ---- */

static void start_with(faults_t faults)
{
    power_up(115200);
    run_until(9 * SIM_S);
    host.faults = faults;
    start_host(NULL);
}

/* Octets in the dialogue and in the two frames that follow it. */
static unsigned count_octets(bool towards_sensor)
{
    start_with((faults_t){ .lost_to_host = NO_OCTET });
    while (host.seen.scan_count < 2) {
        run_until(timeline_now() + SIM_MS);
    }
    const unsigned octets = towards_sensor ? host.to_sensor : host.to_host;
    power_down();
    return octets;
}

typedef faults_t (*fault_at_t)(unsigned octet);

static faults_t loss_to_host(unsigned octet)
{
    return (faults_t){ .lost_to_host = octet };
}

static faults_t loss_to_sensor(unsigned octet)
{
    return (faults_t){ .lost_to_sensor = octet };
}

static faults_t sensor_restart(unsigned octet)
{
    return (faults_t){ .sensor_restart = octet };
}

static faults_t host_restart(unsigned octet)
{
    return (faults_t){ .host_restart = octet };
}

static faults_t host_restart_sent(unsigned octet)
{
    return (faults_t){ .host_restart_sent = octet };
}

static void try_every_octet(const char *what, fault_at_t fault_at, bool towards_sensor)
{
    const unsigned octets = count_octets(towards_sensor);
    double slowest = 0.0;

    for (unsigned octet = 1; octet <= octets; octet++) {
        start_with(fault_at(octet));
        slowest = fmax(slowest, check_run(what, octet));
        power_down();
    }
    printf("%-50s %6u %8.2f\n", what, octets, slowest);
}

static void print_faults(void)
{
    printf("%-50s %6s %8s\n", "at every octet of the start and of two frames", "octets", "slowest");
    try_every_octet("lost on its way to the host", loss_to_host, false);
    try_every_octet("lost on its way to the sensor", loss_to_sensor, true);
    try_every_octet("the sensor restarts while it sends it", sensor_restart, false);
    try_every_octet("the host restarts while it receives it", host_restart, false);
    try_every_octet("the host restarts while it sends it", host_restart_sent, true);
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--faults") == 0) {
        print_faults();
    } else if (argc == 2 && strcmp(argv[1], "--wait") == 0) {
        print_table(10000000);
    } else if (argc == 1) {
        print_table(0);
    } else {
        fprintf(stderr, "usage: scip_start [--wait|--faults]\n");
        return 2;
    }
    return holds ? 0 : 1;
}
