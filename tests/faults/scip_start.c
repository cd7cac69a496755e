/* The scanner link against the model of the sensor, octet by octet in virtual time: how long it takes from
 * each start state to the first scan, and the same with faults at every octet of the start and of a frame.
 * Exit status 1 when streaming is not reached, a wrong distance comes, or the power pin would have been
 * needed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_layout.h"
#include "drivers/urg.h"
#include "sim/devices/serial.h"
#include "sim/devices/urg04lx.h"
#include "sim/timeline.h"

#define STEP (150 * SIM_MS)
#define TICK (10 * SIM_MS)
#define PATIENCE (60 * SIM_S)
#define NO_OCTET 0U

typedef struct {
    unsigned lost_to_host, lost_to_sensor; /* number of the octet, from 1; NO_OCTET: none */
    unsigned sensor_restart, host_restart; /* at this octet to the host */
    unsigned host_restart_sent;            /* at this octet to the sensor */
} faults_t;

/* What the line does to octets of either direction for a while. */
typedef struct {
    sim_time_t from, to;
    bool from_sensor, from_host, noise; /* which direction is out; noise in place of the sensor's octets */
    bool garbles;                       /* one octet in seven has a wrong bit, both ways; else none comes */
} outage_t;

static struct {
    urg04lx_t *sensor;
    serial_t transmitter;
    double rate;
    bool listening;
    bool plain; /* steps every 150 ms, tells no times of scans */
    urg_driver_t urg;
    uint16_t points[2 * SCIP_LAYOUT_POINTS_MAX];
    urg_config_t config;
    faults_t faults;
    outage_t outage;
    sim_time_t longest_gap;      /* between two scans, since it was last set to 0 */
    unsigned to_host, to_sensor; /* octets since the start */
    unsigned scans, wrong, power_cycles;
    sim_time_t started, latest_scan;
    sim_time_t good_from, first_good; /* line and sensor are well; first scan after that */
    timeline_id_t tick;
    sim_time_t stepped;
} host;

static bool holds = true;

/* What is asked for, and of which sensor. */
typedef struct {
    const char *name;
    uint32_t first_rate, stream_rate;
    scip_layout_id_t layout;
    bool rounds_down;               /* the sensor makes no point of steps that fill no cluster */
    bool plain;                     /* the host steps every 150 ms and tells no times of scans */
    double slower_s;                /* this host, or this sensor, takes so much longer */
    sim_time_t latency, revolution; /* 0: the model's own */
} line_t;

static const line_t lines[] = {
    {"front, 250000", 115200, 250000, SCIP_LAYOUT_FRONT, .rounds_down = false},
    {"front, 115200 throughout", 115200, 115200, SCIP_LAYOUT_FRONT, .rounds_down = false},
    {"front, 19200 throughout", 19200, 19200, SCIP_LAYOUT_FRONT, .rounds_down = false},
    {"front, from 19200 to 57600", 19200, 57600, SCIP_LAYOUT_FRONT, .rounds_down = false},
    {"front, from 57600 to 750000", 57600, 750000, SCIP_LAYOUT_FRONT, .rounds_down = false},
    {"two beams, 250000", 115200, 250000, SCIP_LAYOUT_TWO_BEAMS, .rounds_down = false},
    {"three mirrors, 250000", 115200, 250000, SCIP_LAYOUT_THREE_MIRRORS, .rounds_down = false},
    {"three mirrors, 115200", 115200, 115200, SCIP_LAYOUT_THREE_MIRRORS, .rounds_down = false},
    {"the same, points rounded down", 115200, 115200, SCIP_LAYOUT_THREE_MIRRORS, .rounds_down = true},
    {"front, steps of 150 ms only", 115200, 250000, SCIP_LAYOUT_FRONT, .plain = true, .slower_s = 0.3},
    {"front, answers after 100 ms", 115200, 250000, SCIP_LAYOUT_FRONT, .latency = 100 * SIM_MS,
     .slower_s = 0.2},
    {"front, revolutions of 99.7 ms", 115200, 250000, SCIP_LAYOUT_FRONT, .revolution = 99700 * SIM_US},
    {"front, revolutions of 100.9 ms", 115200, 250000, SCIP_LAYOUT_FRONT, .revolution = 100900 * SIM_US},
};
static const line_t *line = &lines[0];

/* ---- the world: a surface that every ray sees at its own distance ---- */

static int distance_at(int step)
{
    return 600 + 7 * (step % 40);
}

static void look(void *context, const urg_rays_t *rays, int *distance_mm)
{
    (void)context;
    for (int step = rays->from_step; step <= rays->to_step; step++) {
        distance_mm[step - rays->from_step] = distance_at(step);
    }
}

/* ---- the host, as an application of the driver is written ---- */

static int point_at(const scip_scan_t *scan, int i)
{
    const int first = scan->first_step + i * scan->cluster;
    int nearest = distance_at(first);

    for (int step = first + 1; step < first + scan->cluster; step++) {
        nearest = distance_at(step) < nearest ? distance_at(step) : nearest;
    }
    return nearest;
}

static void check_scan(void)
{
    scip_scan_t scan;

    host.wrong += !urg_take_scan(&host.urg, &scan);
    host.scans++;
    if (host.latest_scan != 0 && timeline_now() - host.latest_scan > host.longest_gap) {
        host.longest_gap = timeline_now() - host.latest_scan;
    }
    host.latest_scan = timeline_now();
    if (!host.plain) {
        urg_scan_at(&host.urg, (uint32_t)(timeline_now() / SIM_US));
    }
    if (host.first_good == 0 && host.latest_scan >= host.good_from) {
        host.first_good = host.latest_scan;
    }
    for (int i = 0; i < scan.points; i++) {
        host.wrong += scan.distance_mm[i] != point_at(&scan, i);
    }
}

static void hear(octet_t octet)
{
    if (urg_feed(&host.urg, &octet, 1)) {
        check_scan();
    }
}

static void step(void)
{
    urg_output_t output;

    host.stepped = timeline_now();
    urg_step(&host.urg, (uint32_t)(timeline_now() / SIM_US));
    if (!urg_next_to_send(&host.urg, &output)) {
        return;
    }
    host.power_cycles += output.cycle_power;
    if (output.set_rate) {
        host.rate = output.rate;
        serial_flush(&host.transmitter);
        serial_set_rate(&host.transmitter, output.rate);
    }
    serial_send(&host.transmitter, output.octets, output.count);
}

/* A clock that ticks every 10 ms; or one of 150 ms, whatever the driver asks for. */
static void tick(void *context)
{
    (void)context;
    host.tick = timeline_after(host.plain ? STEP : TICK, tick, NULL);
    if (host.plain || timeline_now() - host.stepped >= (sim_time_t)urg_pause_us(&host.urg) * SIM_US) {
        step();
    }
}

/* Everything forgotten, as after a reset; the wire and the sensor go on. */
static void start_host(void *context)
{
    (void)context;
    host.listening = true;
    host.scans = 0;
    host.rate = host.config.first_rate;
    host.latest_scan = 0;
    host.started = timeline_now();
    serial_set_rate(&host.transmitter, host.rate);
    if (!urg_init(&host.urg, &host.config, host.points, 2 * SCIP_LAYOUT_POINTS_MAX,
                  (uint32_t)(timeline_now() / SIM_US))) {
        abort();
    }
    host.stepped = timeline_now();
    host.tick = timeline_after(host.plain ? STEP : TICK, tick, NULL);
}

static void stop_host(void)
{
    host.listening = false;
    timeline_cancel(host.tick);
    serial_flush(&host.transmitter);
}

static void power_sensor(void *context)
{
    (void)context;
    urg04lx_power(host.sensor, true);
}

static void restart_sensor(void *context)
{
    (void)context;
    urg04lx_power(host.sensor, false);
    timeline_after(100 * SIM_MS, power_sensor, NULL);
}

static void restart_host(void)
{
    stop_host();
    timeline_after(100 * SIM_MS, start_host, NULL);
}

static void break_in(void)
{
    if (host.to_host == host.faults.sensor_restart) {
        restart_sensor(NULL);
    }
    if (host.to_host == host.faults.host_restart) {
        restart_host();
    }
}

/* Of an octet at another rate the UART makes a framing error, or now and then some octet. */
static void hear_noise(unsigned octet)
{
    urg_line_broken(&host.urg, octet % 4 == 0 ? 0 : 1);
    if (octet % 4 == 0) {
        hear((octet_t)(octet ^ 0xA5U));
    }
}

static bool in_outage(void)
{
    return timeline_now() >= host.outage.from && timeline_now() < host.outage.to;
}

/* What is left of an octet in an outage. */
static bool survives(bool out, unsigned number, unsigned *octet)
{
    if (!in_outage() || !out) {
        return true;
    }
    if (host.outage.garbles && number % 7 == 0) {
        *octet ^= 1U << number % 8;
    }
    return host.outage.garbles;
}

static void make_noise(void *context)
{
    (void)context;
    hear_noise((unsigned)(timeline_now() / SIM_MS * 37));
    if (timeline_now() + 3 * SIM_MS < host.outage.to) {
        timeline_after(3 * SIM_MS, make_noise, NULL);
    }
}

static void to_host(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    if (!host.listening || !survives(host.outage.from_sensor, host.to_host + 1, &octet)) {
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
    hear((octet_t)octet);
}

static void to_sensor(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    host.to_sensor++;
    if (host.to_sensor == host.faults.host_restart_sent) {
        restart_host();
    }
    if (host.to_sensor != host.faults.lost_to_sensor &&
        survives(host.outage.from_host, host.to_sensor, &octet)) {
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

static void power_up_with(double rate, sim_time_t boot)
{
    urg04lx_config_t config = urg04lx_default;

    config.power_up_rate = rate;
    config.boot = boot;
    config.phase = 13 * SIM_MS;
    config.rounds_down = line->rounds_down;
    config.latency = line->latency != 0 ? line->latency : config.latency;
    config.revolution = line->revolution != 0 ? line->revolution : config.revolution;
    timeline_reset();
    memset(&host, 0, sizeof host);
    host.plain = line->plain;
    host.sensor = urg04lx_create(&config, look, NULL, to_host, NULL);
    serial_init(&host.transmitter, rate, to_sensor, NULL);
    urg04lx_power(host.sensor, true);
    host.config = (urg_config_t){.first_rate = line->first_rate,
                                 .stream_rate = line->stream_rate,
                                 .fastest_rate = line->stream_rate,
                                 .stream = SCIP_STREAM_2,
                                 .range = scip_layout_range(&scip_layouts[line->layout], line->stream_rate)};
}

static void power_up(double rate)
{
    power_up_with(rate, urg04lx_default.boot);
}

static void power_down(void)
{
    stop_host();
    urg04lx_destroy(host.sensor);
}

/* Runs until scans have come for a second without a pause. The time from the start to the first of them, or a
 * negative number. */
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
    {"SCIP1.1", false, ""},
    {"SCIP1.1, half a command", false, "SCIP2"},
    {"SCIP2.0, idle", true, ""},
    {"SCIP2.0, laser on", true, "BM\n"},
    {"SCIP2.0, half a command", true, "MS0372"},
    {"streaming MS", true, "MS0372040601000\n"},
    {"streaming MD, another range", true, "MD0044072501000\n"},
    {"a counted run", true, "MS0372040601399\n"},
    {"time mode", true, "TM0\n"},
    {"time mode, half a command", true, "TM0\nT"},
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
    static const int rates[] = {19200, 57600, 115200, 250000};

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
    start_with((faults_t){.lost_to_host = NO_OCTET});
    while (host.scans < 2) {
        run_until(timeline_now() + SIM_MS);
    }
    const unsigned octets = towards_sensor ? host.to_sensor : host.to_host;
    power_down();
    return octets;
}

typedef faults_t (*fault_at_t)(unsigned octet);

static faults_t loss_to_host(unsigned octet)
{
    return (faults_t){.lost_to_host = octet};
}

static faults_t loss_to_sensor(unsigned octet)
{
    return (faults_t){.lost_to_sensor = octet};
}

static faults_t sensor_restart(unsigned octet)
{
    return (faults_t){.sensor_restart = octet};
}

static faults_t host_restart(unsigned octet)
{
    return (faults_t){.host_restart = octet};
}

static faults_t host_restart_sent(unsigned octet)
{
    return (faults_t){.host_restart_sent = octet};
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

/* ---- time without scans ---- */

#define OUTAGE_PHASES \
    24U /* of the revolution and of the host's step, in steps that share no divisor with either */
#define OUTAGE_PHASE (13 * SIM_MS)

typedef struct {
    const char *name;
    outage_t kind;
    bool restart;  /* the sensor's supply goes off for 100 ms; what lasts is its boot */
    double most_s; /* longer than the outage or the boot */
} trouble_t;

/* Of a sensor that kept its state: up to a revolution to the next frame. A request that reaches it as the
 * line comes back costs three more: its answer, the rest of a revolution, the measured one. */
static const trouble_t troubles[] = {
    {"the line is out, both ways", {.from_sensor = true, .from_host = true}, false, 0.45},
    {"from the sensor only", {.from_sensor = true}, false, 0.45},
    {"both ways, and noise", {.from_sensor = true, .from_host = true, .noise = true}, false, 0.45},
    {"the sensor restarts and boots", {.from_sensor = false}, true, 0.85},
};

static void begin_outage(const trouble_t *trouble, sim_time_t length)
{
    host.outage = trouble->kind;
    host.outage.from = timeline_now();
    host.outage.to = timeline_now() + length;
    if (trouble->kind.noise) {
        make_noise(NULL);
    }
    if (trouble->restart) {
        host.outage.to = host.outage.from;
        restart_sensor(NULL);
    }
}

/* The longest time between two scans from an outage at this phase until 3 s after it. */
static double blind_s(const trouble_t *trouble, sim_time_t length, unsigned phase)
{
    double seconds;

    power_up_with(line->first_rate, trouble->restart ? length - 100 * SIM_MS : urg04lx_default.boot);
    run_until(9 * SIM_S);
    start_host(NULL);
    (void)check_run(trouble->name, phase);
    run_until(timeline_now() + phase * OUTAGE_PHASE);
    host.longest_gap = 0;
    begin_outage(trouble, length);
    run_until(timeline_now() + length + 8 * SIM_S);
    seconds = (double)host.longest_gap / 1e9;
    if (timeline_now() - host.latest_scan > 250 * SIM_MS || host.wrong != 0 || host.power_cycles != 0) {
        complain("no scans, or wrong ones", trouble->name, phase);
    }
    power_down();
    return seconds;
}

static const int lengths_ms[] = {300, 500, 700, 1000, 1300, 1700, 2300, 2700, 3500, 5000, 6500, 8000};
#define BOOT_LEAST_MS 2000

static double worst_blind_s(const trouble_t *trouble, sim_time_t length)
{
    double worst = 0.0;

    for (unsigned phase = 0; phase < OUTAGE_PHASES; phase++) {
        worst = fmax(worst, blind_s(trouble, length, phase));
    }
    holds = holds && worst <= (double)length / 1e9 + trouble->most_s + line->slower_s;
    return worst;
}

static void print_outages(void)
{
    printf("%-30s", "longest time without scans, s");
    for (size_t i = 0; i < sizeof lengths_ms / sizeof lengths_ms[0]; i++) {
        printf(" %5.1f", lengths_ms[i] / 1000.0);
    }
    for (size_t k = 0; k < sizeof troubles / sizeof troubles[0]; k++) {
        printf("\n%-30s", troubles[k].name);
        for (size_t i = 0; i < sizeof lengths_ms / sizeof lengths_ms[0]; i++) {
            if (troubles[k].restart && lengths_ms[i] < BOOT_LEAST_MS) {
                printf("     -");
            } else {
                printf(" %5.2f", worst_blind_s(&troubles[k], lengths_ms[i] * SIM_MS));
            }
        }
    }
    printf("\n");
}

/* By how much the worst blind time is above the outage, over all lengths. */
static double worst_excess_s(const trouble_t *trouble)
{
    double worst = 0.0;

    for (size_t i = 0; i < sizeof lengths_ms / sizeof lengths_ms[0]; i++) {
        if (!trouble->restart || lengths_ms[i] >= BOOT_LEAST_MS) {
            worst = fmax(worst, worst_blind_s(trouble, lengths_ms[i] * SIM_MS) - lengths_ms[i] / 1000.0);
        }
    }
    return worst;
}

static void print_lines(void)
{
    printf("%-30s %6s %6s %6s %8s\n", "longer than the trouble, s", "out", "half", "noise", "restarts");
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        line = &lines[i];
        printf("%-30s", line->name);
        for (size_t k = 0; k < sizeof troubles / sizeof troubles[0]; k++) {
            printf(troubles[k].restart ? " %8.2f" : " %6.2f", worst_excess_s(&troubles[k]));
        }
        printf("\n");
    }
}

/* ---- several troubles, one upon the other ---- */

/* In the first dialogue, before any scan: before or after the sensor's first answer. */
typedef enum { STREAMING, UNHEARD, HEARD } in_start_t;

/* Outages of `out` with `good` between them; restarts at these times after the first one began. */
typedef struct {
    const char *name;
    outage_t kind;
    unsigned outages;
    sim_time_t out, good;
    unsigned restarts;
    sim_time_t restart[2];
    in_start_t in_start;
    double most_s; /* to the first scan, from the end of the outage or of the boot */
} misfortune_t;

#define MISFORTUNE_BOOT (2300 * SIM_MS)
#define BOTH_WAYS \
    { \
        .from_sensor = true, .from_host = true \
    }
#define GARBLED \
    { \
        .from_sensor = true, .from_host = true, .garbles = true \
    }

static const misfortune_t misfortunes[] = {
    {"three outages of 0.3 s, 0.1 s between",
     BOTH_WAYS,
     3,
     300 * SIM_MS,
     100 * SIM_MS,
     0,
     {0},
     STREAMING,
     0.5},
    {"three of 0.7 s, 0.3 s between", BOTH_WAYS, 3, 700 * SIM_MS, 300 * SIM_MS, 0, {0}, STREAMING, 0.5},
    {"three of 2 s, 0.6 s between", BOTH_WAYS, 3, 2 * SIM_S, 600 * SIM_MS, 0, {0}, STREAMING, 0.5},
    {"1 s of garbled octets", GARBLED, 1, SIM_S, 0, 0, {0}, STREAMING, 0.75},
    {"4 s of garbled octets", GARBLED, 1, 4 * SIM_S, 0, 0, {0}, STREAMING, 0.75},
    {"four of 0.7 s garbled, 0.9 s between", GARBLED, 4, 700 * SIM_MS, 900 * SIM_MS, 0, {0}, STREAMING, 1.25},
    {"a restart in an outage of 1.5 s", BOTH_WAYS, 1, 1500 * SIM_MS, 0, 1, {400 * SIM_MS}, STREAMING, 1.0},
    {"a restart in an outage of 5 s", BOTH_WAYS, 1, 5 * SIM_S, 0, 1, {400 * SIM_MS}, STREAMING, 1.0},
    {"a restart, three of 0.4 s, 1.2 s between",
     BOTH_WAYS,
     3,
     400 * SIM_MS,
     1200 * SIM_MS,
     1,
     {600 * SIM_MS},
     STREAMING,
     1.0},
    {"garbled while it comes back", GARBLED, 2, 2 * SIM_S, 100 * SIM_MS, 1, {0}, STREAMING, 1.0},
    {"two restarts, 1 s between", {.from = 0}, 0, 0, 0, 2, {0, SIM_S}, STREAMING, 1.0},
    {"two restarts, 2.7 s between", {.from = 0}, 0, 0, 0, 2, {0, 2700 * SIM_MS}, STREAMING, 1.0},
    {"two restarts, 3.1 s between", {.from = 0}, 0, 0, 0, 2, {0, 3100 * SIM_MS}, STREAMING, 1.0},
    {"0.3 s in the start", BOTH_WAYS, 1, 300 * SIM_MS, 0, 0, {0}, HEARD, 0.55},
    {"0.7 s in the start", BOTH_WAYS, 1, 700 * SIM_MS, 0, 0, {0}, HEARD, 0.75},
    {"2 s in the start", BOTH_WAYS, 1, 2 * SIM_S, 0, 0, {0}, HEARD, 0.55},
    {"5 s in the start", BOTH_WAYS, 1, 5 * SIM_S, 0, 0, {0}, HEARD, 0.55},
    {"1 s of garbled octets in the start", GARBLED, 1, SIM_S, 0, 0, {0}, HEARD, 0.55},
    {"0.7 s before the first answer", BOTH_WAYS, 1, 700 * SIM_MS, 0, 0, {0}, UNHEARD, 0.75},
    {"1.4 s before the first answer", BOTH_WAYS, 1, 1400 * SIM_MS, 0, 0, {0}, UNHEARD, 2.0},
    {"2 s before the first answer", BOTH_WAYS, 1, 2 * SIM_S, 0, 0, {0}, UNHEARD, 2.0},
};

#define FIRST_ANSWER (160 * SIM_MS) /* of a start */

static const misfortune_t *misfortune;
static unsigned outages_left;

static void next_outage(void *context)
{
    (void)context;
    host.outage = misfortune->kind;
    host.outage.from = timeline_now();
    host.outage.to = timeline_now() + misfortune->out;
    outages_left--;
    if (outages_left > 0) {
        timeline_after(misfortune->out + misfortune->good, next_outage, NULL);
    }
}

static void begin_misfortune(void)
{
    const sim_time_t now = timeline_now();

    host.first_good = 0;
    host.good_from = now + misfortune->outages * (misfortune->out + misfortune->good) - misfortune->good;
    outages_left = misfortune->outages;
    if (outages_left > 0) {
        next_outage(NULL);
    }
    for (unsigned i = 0; i < misfortune->restarts; i++) {
        const sim_time_t booted = now + misfortune->restart[i] + 100 * SIM_MS + MISFORTUNE_BOOT;

        timeline_after(misfortune->restart[i], restart_sensor, NULL);
        host.good_from = booted > host.good_from ? booted : host.good_from;
    }
}

/* Of a start without trouble: what it still needs `begun` after it began. */
static double rest_of_start_s(sim_time_t begun)
{
    double seconds;

    power_up_with(line->first_rate, MISFORTUNE_BOOT);
    run_until(9 * SIM_S);
    start_host(NULL);
    seconds = check_run("a start", 0);
    power_down();
    return fmax(0.0, seconds - (double)begun / 1e9);
}

/* From when all is well to the first scan; in a start, without what it would have needed anyway. */
static double late_s(unsigned phase)
{
    const sim_time_t begun = misfortune->in_start == HEARD ? FIRST_ANSWER + phase * OUTAGE_PHASE
                                                           : phase * OUTAGE_PHASE % FIRST_ANSWER;
    double seconds = misfortune->in_start != STREAMING ? -rest_of_start_s(begun) : 0.0;

    power_up_with(line->first_rate, MISFORTUNE_BOOT);
    run_until(9 * SIM_S);
    start_host(NULL);
    if (misfortune->in_start == STREAMING) {
        (void)check_run(misfortune->name, phase);
        run_until(timeline_now() + phase * OUTAGE_PHASE);
    } else {
        run_until(timeline_now() + begun);
    }
    begin_misfortune();
    run_until(host.good_from + 10 * SIM_S);
    seconds += host.first_good == 0 ? 99.0 : (double)(host.first_good - host.good_from) / 1e9;
    if (timeline_now() - host.latest_scan > 250 * SIM_MS || host.wrong != 0 || host.power_cycles != 0) {
        complain("no scans, or wrong ones", misfortune->name, phase);
    }
    power_down();
    return seconds;
}

static void print_misfortunes(void)
{
    printf("%-40s %8s %8s\n", "from the end of it to the first scan, s", "longest", "at most");
    for (size_t i = 0; i < sizeof misfortunes / sizeof misfortunes[0]; i++) {
        double worst = 0.0;

        misfortune = &misfortunes[i];
        for (unsigned phase = 0; phase < 4 * OUTAGE_PHASES; phase++) {
            worst = fmax(worst, late_s(phase));
        }
        printf("%-40s %8.2f %8.2f\n", misfortune->name, worst, misfortune->most_s);
        holds = holds && worst <= misfortune->most_s;
    }
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--faults") == 0) {
        print_faults();
    } else if (argc == 2 && strcmp(argv[1], "--outages") == 0) {
        print_outages();
    } else if (argc == 2 && strcmp(argv[1], "--lines") == 0) {
        print_lines();
    } else if (argc == 2 && strcmp(argv[1], "--misfortunes") == 0) {
        print_misfortunes();
    } else if (argc == 2 && strcmp(argv[1], "--wait") == 0) {
        print_table(10000000);
    } else if (argc == 1) {
        print_table(0);
    } else {
        fprintf(stderr, "usage: scip_start [--wait|--faults|--outages|--lines|--misfortunes]\n");
        return 2;
    }
    return holds ? 0 : 1;
}
