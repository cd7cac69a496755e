#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "sim/devices/line_fault.h"
#include "sim/devices/scene.h"
#include "sim/devices/urg04lx.h"
#include "sim/host/pace.h"
#include "sim/noise.h"

#define FAULTS_MAX 32
#define HEIGHT_MAX_M 5.0
#define PACKET 64U         /* of a full-speed USB port */
#define PAUSE (2 * SIM_MS) /* chosen: three octets at the slowest rate */

static const char usage[] =
    "usage: plomada laser --link PATH [OPTION]...\n\n"
    "Serves the scanner model (URG-04LX, firmware 3.1.04) on a pseudo-terminal for any SCIP client, paced by "
    "the wall clock.\n"
    "PATH becomes a symbolic link to it, and is removed at the end (SIGINT, SIGTERM; exit status 0).\n\n"
    "  --rate N        bit rate at power-up: 19200, 57600, 115200 (default), 250000, 500000, 750000\n"
    "  --height M      the vehicle stands M metres above the floor, 0..5 (default 0), and the three mirrors "
    "look down\n"
    "  --seed N        noise, phase and faults (default 1)\n"
    "  --burst         hands octets over in packets, as the sensor's own USB does: when 64 are there, or "
    "when "
    "the line\n"
    "                  pauses for 2 ms\n"
    "  --round-down    steps at the end of the range that fill no cluster make no point, as hokuyoaist "
    "expects; without it\n"
    "                  they make one more, as urg_library expects\n"
    "  --fault SPEC    may be repeated\n\n"
    "The sensor has been on for long: it listens, in SCIP1.1, at its power-up rate, which the "
    "pseudo-terminal is set to. As\n"
    "on a real line, a client must follow SS and S with its own rate (tcsetattr, TCSETS2): while the rates "
    "differ, what it\n"
    "sends is ignored and what it receives is nonsense. Malformed commands are refused "
    "(sim/devices/urg04lx.h says how),\n"
    "and so are those of newer models: ME, ND, NE and RB are answered 0E, undefined command.\n\n"
    "Faults, on what the sensor sends:\n";

enum { OPT_LINK = 1, OPT_RATE, OPT_HEIGHT, OPT_SEED, OPT_BURST, OPT_ROUND_DOWN, OPT_FAULT, OPT_HELP };

static const struct option long_options[] = {
    {"link", required_argument, NULL, OPT_LINK},
    {"rate", required_argument, NULL, OPT_RATE},
    {"height", required_argument, NULL, OPT_HEIGHT},
    {"seed", required_argument, NULL, OPT_SEED},
    {"burst", no_argument, NULL, OPT_BURST},
    {"fault", required_argument, NULL, OPT_FAULT},
    {"round-down", no_argument, NULL, OPT_ROUND_DOWN},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

static struct {
    const char *link;
    unsigned long rate, seed;
    double height_m;
    line_fault_spec_t faults[FAULTS_MAX];
    int fault_count;
    bool burst, round_down, help;
} order = {.rate = 115200, .seed = 1};

static struct {
    port_t port;
    quadrotor_t *quadrotor;
    scene_t scene;
    urg04lx_t *urg;
    line_fault_t *fault;
    noise_t nonsense;
    unsigned long mismatched; /* octets to a client at another rate */
    unsigned char packet[PACKET];
    size_t packed;
    sim_time_t octet_at; /* the latest */
    bool watching;       /* for a pause */
} server;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada laser: %s: %s\n", subject, what);
    return false;
}

/* ---- arguments ---- */

static bool read_rate(const char *text)
{
    static const unsigned long rates[] = {19200, 57600, 115200, 250000, 500000, 750000};
    char *end;

    order.rate = strtoul(text, &end, 10);
    for (size_t i = 0; *end == '\0' && i < sizeof rates / sizeof rates[0]; i++) {
        if (order.rate == rates[i]) {
            return true;
        }
    }
    return complain("not a rate of this sensor", text);
}

static bool read_height(const char *text)
{
    char *end;

    order.height_m = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && order.height_m >= 0.0 && order.height_m <= HEIGHT_MAX_M) ||
           complain("not a height, 0..5 m", text);
}

static bool read_seed(const char *text)
{
    char *end;

    order.seed = strtoul(text, &end, 10);
    return (*text >= '0' && *text <= '9' && *end == '\0') || complain("not a seed (0, 1, 2 ...)", text);
}

static bool read_fault(const char *text)
{
    const char *error;

    if (order.fault_count == FAULTS_MAX) {
        return complain("too many", "--fault");
    }
    error = line_fault_parse(&order.faults[order.fault_count++], text);
    return error == NULL || complain(error, text);
}

static bool read_option(int option, const char *argument)
{
    switch (option) {
    case OPT_LINK:
        order.link = argument;
        return true;
    case OPT_RATE:
        return read_rate(argument);
    case OPT_HEIGHT:
        return read_height(argument);
    case OPT_SEED:
        return read_seed(argument);
    case OPT_BURST:
        order.burst = true;
        return true;
    case OPT_ROUND_DOWN:
        order.round_down = true;
        return true;
    case OPT_FAULT:
        return read_fault(argument);
    case OPT_HELP:
        order.help = true;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (!read_option(option, optarg)) {
            return false;
        }
    }
    if (order.help) {
        return true;
    }
    if (optind < argc) {
        return complain("not understood", argv[optind]);
    }
    return order.link != NULL || complain("is needed", "--link");
}

static bool client_follows(double bit_ns)
{
    const double ratio = (double)port_rate(&server.port) * bit_ns * 1e-9;

    return ratio > 0.955 && ratio < 1.045;
}

/* ---- packets ---- */

static void hand_over(void)
{
    port_write(&server.port, server.packet, server.packed);
    server.packed = 0;
}

static void watch_for_pause(void *context)
{
    server.watching = timeline_now() - server.octet_at < PAUSE;
    if (server.watching) {
        timeline_at(server.octet_at + PAUSE, watch_for_pause, context);
    } else {
        hand_over();
    }
}

static void pack(unsigned char octet)
{
    server.packet[server.packed++] = octet;
    server.octet_at = timeline_now();
    if (server.packed == (order.burst ? PACKET : 1U)) {
        hand_over();
    }
    if (order.burst && !server.watching) {
        server.watching = true;
        timeline_after(PAUSE, watch_for_pause, NULL);
    }
}

/* ---- the line ---- */

static void to_client(void *context, unsigned octet, double bit_ns)
{
    unsigned char c = (unsigned char)octet;

    (void)context;
    if (!client_follows(bit_ns)) {
        server.mismatched++;
        c = (unsigned char)(noise_bits(&server.nonsense) & 0xFFU);
    }
    pack(c);
}

static void from_client(void *context, const unsigned char *octets, size_t count)
{
    const unsigned long rate = port_rate(&server.port);

    (void)context;
    for (size_t i = 0; rate > 0 && i < count; i++) {
        urg04lx_receive(server.urg, octets[i], 1e9 / (double)rate);
    }
}

static void restart(void *context)
{
    (void)context;
    urg04lx_power(server.urg, false);
    urg04lx_power(server.urg, true);
}

static void trouble(void *context, unsigned code)
{
    (void)context;
    urg04lx_trouble(server.urg, code);
}

/* ---- life ---- */

static void run_unpaced_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void create_sensor(void)
{
    const line_fault_ends_t ends = {to_client, NULL, restart, trouble, NULL};
    quadrotor_config_t quadrotor = quadrotor_default;
    urg04lx_config_t urg = urg04lx_default;

    urg.rounds_down = order.round_down;
    noise_t phase;

    timeline_reset();
    noise_init(&phase, order.seed, "phases");
    noise_init(&server.nonsense, order.seed, "nonsense");
    quadrotor.anchored = true;
    quadrotor.bench_height_m = order.height_m;
    urg.power_up_rate = (double)order.rate;
    urg.phase = (sim_time_t)noise_uniform(&phase, 0.0, (double)urg.revolution);
    server.quadrotor = quadrotor_create(&quadrotor, NULL, NULL, order.seed);
    scene_init(&server.scene, &scene_default, server.quadrotor, order.seed);
    server.fault = line_fault_create(order.faults, order.fault_count, order.seed, &ends);
    server.urg = urg04lx_create(&urg, scene_scan, &server.scene, line_fault_octet, server.fault);
    urg04lx_power(server.urg, true);
    run_unpaced_until(urg.boot);
}

static void destroy_sensor(void)
{
    urg04lx_destroy(server.urg);
    line_fault_destroy(server.fault);
    quadrotor_destroy(server.quadrotor);
}

static void serve(void)
{
    pace_watch(&server.port, from_client, NULL);
    printf("laser: %s\n", server.port.name);
    fflush(stdout);
    while (!pace_interrupted()) {
        pace_run();
    }
}

static void report(void)
{
    const urg04lx_state_t state = urg04lx_state(server.urg);

    fprintf(stderr, "scans: %u\ncommands: %u refused: %u\noctets: %llu sent\n", state.scans_sent,
            state.commands, state.refused, (unsigned long long)line_fault_octets(server.fault));
    fprintf(stderr,
            "at another rate: %u octets ignored, %lu sent as nonsense\nfaults:", state.octets_mismatched,
            server.mismatched);
    for (int i = 0; i < LINE_FAULT_KIND_COUNT; i++) {
        fprintf(stderr, " %s:%u", line_fault_names[i],
                line_fault_strikes(server.fault, (line_fault_kind_t)i));
    }
    fprintf(stderr, "\n");
}

/* Signals are caught before the link is there, so that it never stays behind. */
static int serve_link(void)
{
    const char *error;

    pace_begin();
    error = port_link(&server.port, order.link);
    if (error == NULL) {
        serve();
        port_unlink(&server.port, order.link);
        report();
    }
    pace_end();
    return error == NULL || complain(error, order.link) ? 0 : 2;
}

static int run(void)
{
    const char *error = port_open_pty(&server.port, order.rate);
    int status;

    if (error != NULL) {
        complain(error, "laser");
        return 2;
    }
    create_sensor();
    status = serve_link();
    destroy_sensor();
    port_close(&server.port);
    return status;
}

int command_laser(int argc, char **argv)
{
    if (!read_arguments(argc, argv)) {
        fprintf(stderr, "`plomada laser --help` tells more.\n");
        return 2;
    }
    if (order.help) {
        fputs(usage, stdout);
        fputs(line_fault_help, stdout);
        return 0;
    }
    return run();
}
