#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "lines.h"
#include "output.h"
#include "sim/board.h"
#include "sim/costs.h"
#include "sim/host/pace.h"
#include "sim/noise.h"
#include "sim/scenarios/wires.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/f021/flash.h"

#define STEP (10 * SIM_MS)
#define MISMATCH 0.045
#define WRONG_RATE 1.08
#define FAST 1.03 /* beyond the 2 % that a UART should keep, and yet understood */
#define SLOW 12.0
#define LONG_PULSE 1.1
#define LATE (400 * SIM_MS)
#define GARBLED_ONE_IN 50U

static const char usage[] =
    "usage: plomada board --laser PATH --imu PATH --xbee PATH [OPTION]...\n\n"
    "Runs the unmodified firmware in real time with all three serial lines outside, "
    "as a LaunchPad does. Each PATH becomes\n"
    "a symbolic link to a pseudo-terminal, removed at the end (SIGINT, SIGTERM; exit "
    "status 0): what a serial adapter on\n"
    "the board's pins would be. Its bit rate is that of whoever opens it; at another "
    "rate than the firmware's both hear\n"
    "nonsense. SIGUSR1 takes the power away and gives it back.\n\n"
    "  --usb PATH          the same for the LaunchPad's own USB serial port (115200, the "
    "board only talks)\n"
    "  --storage FILE      the chip's flash, kept over a power cycle and in the "
    "file; without it kept until the end\n"
    "  --pulses FILE       the throttle pin as a logic analyser records it, in "
    "sigrok-cli's format (csv:time=true:dedup=true);\n"
    "                      FILE may be a FIFO\n"
    "  --bits LINE=FILE    the transmit pin of a line (laser, imu, xbee) in the "
    "same way; may be repeated\n"
    "  --duration S        ends by itself\n"
    "  --seed N            phases (default 1)\n"
    "  --defect NAME[@S]   something is wrong, from S seconds after the first "
    "power-on on (default: always); may be repeated:\n";

static const char defect_help[] =
    "      laser-swapped imu-swapped xbee-swapped   transmit and receive wire of that line are crossed\n"
    "      laser-gone imu-gone xbee-gone            the adapter of that line is unplugged\n"
    "      laser-late imu-late xbee-late            its octets towards the board come 0.4 s late\n"
    "      laser-garbled imu-garbled xbee-garbled   every fiftieth octet is another, both ways\n"
    "      wrong-rate fast   the oscillator is 8 % fast, 3 % fast: every line\n"
    "      pulse-inverted pulse-long pulse-missing  the throttle pin: inverted, pulses 10 % long, dead\n"
    "      no-storage        the flash cannot be written\n"
    "      forgetful         the flash is blank after a power cycle\n"
    "      slow              every piece of code takes twelve times its time\n"
    "      no-watchdog       the watchdog never bites\n";

typedef enum {
    SWAPPED,
    GONE,
    LATELY,
    GARBLED,
    WIRE_DEFECTS,
    WRONG_RATE_DEFECT = WIRE_DEFECTS * BOARD_WIRES,
    PULSE_INVERTED,
    PULSE_LONG,
    PULSE_MISSING,
    NO_STORAGE,
    FORGETFUL,
    SLOW_CODE,
    NO_WATCHDOG,
    FAST_DEFECT,
    DEFECTS
} defect_t;

static const char *const wire_defects[] = {"swapped", "gone", "late", "garbled"};
_Static_assert(sizeof wire_defects / sizeof wire_defects[0] == WIRE_DEFECTS,
               "every defect of a wire has a name");
static const char *const other_defects[] = {"wrong-rate",    "pulse-inverted", "pulse-long",
                                            "pulse-missing", "no-storage",     "forgetful",
                                            "slow",          "no-watchdog",    "fast"};
_Static_assert(sizeof other_defects / sizeof other_defects[0] == DEFECTS - WRONG_RATE_DEFECT,
               "every other defect has a name");

enum { OPT_STORAGE = 1, OPT_DURATION, OPT_SEED, OPT_DEFECT, OPT_USB };

static const struct option long_options[] = {
    {"storage", required_argument, NULL, OPT_STORAGE},
    {"duration", required_argument, NULL, OPT_DURATION},
    {"seed", required_argument, NULL, OPT_SEED},
    {"defect", required_argument, NULL, OPT_DEFECT},
    {"usb", required_argument, NULL, OPT_USB},
    LINE_BITS_OPTION,
    LINE_OPTIONS,
};

static struct {
    lines_t lines;
    const char *storage, *usb;
    double duration_s, defect_s[DEFECTS]; /* NAN: not this defect */
    unsigned long seed;
} order;

static struct {
    port_t ports[BOARD_WIRES];
    bool linked[BOARD_WIRES];
    port_t usb;
    bool usb_linked;
    noise_t noise;
    unsigned passed;       /* octets, for the garbled ones */
    int pulses;            /* file, -1: none */
    int bits[BOARD_WIRES]; /* the same */
    sim_time_t before;     /* virtual time of earlier power-ons */
    sim_time_t worst_lag;
    costs_stretched_t costs;
} bench = {.pulses = -1, .bits = {-1, -1, -1}};

static volatile sig_atomic_t power_cycle;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada board: %s: %s\n", subject, what);
    return false;
}

/* ---- arguments ---- */

static int defect_of(const char *name)
{
    char text[32];

    for (int i = 0; i < WRONG_RATE_DEFECT; i++) {
        snprintf(text, sizeof text, "%s-%s", wire_names[i / WIRE_DEFECTS], wire_defects[i % WIRE_DEFECTS]);
        if (strcmp(name, text) == 0) {
            return i;
        }
    }
    for (int i = WRONG_RATE_DEFECT; i < DEFECTS; i++) {
        if (strcmp(name, other_defects[i - WRONG_RATE_DEFECT]) == 0) {
            return i;
        }
    }
    return -1;
}

static bool read_number(const char *text, double *number)
{
    char *end;

    *number = strtod(text, &end);
    return *text != '\0' && *end == '\0' && isfinite(*number) && *number >= 0.0;
}

static bool read_defect(const char *text)
{
    char name[32];
    const char *at = strchr(text, '@');
    double from_s = 0.0;
    int defect;

    snprintf(name, sizeof name, "%.*s", at != NULL ? (int)(at - text) : (int)strlen(text), text);
    defect = defect_of(name);
    if (defect < 0 || (at != NULL && !read_number(at + 1, &from_s))) {
        return complain("no such defect", text);
    }
    order.defect_s[defect] = from_s;
    return true;
}

static bool read_option(int option, const char *argument)
{
    double number;

    switch (option) {
    case OPT_STORAGE:
        order.storage = argument;
        return true;
    case OPT_DURATION:
        return read_number(argument, &order.duration_s) || complain("not a number of seconds", argument);
    case OPT_SEED:
        order.seed = strtoul(argument, NULL, 10);
        return read_number(argument, &number) || complain("not a seed (0, 1, 2 ...)", argument);
    case OPT_DEFECT:
        return read_defect(argument);
    case OPT_USB:
        order.usb = argument;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(int argc, char **argv)
{
    memset(&order, 0, sizeof order);
    order.seed = 1;
    for (int i = 0; i < DEFECTS; i++) {
        order.defect_s[i] = NAN;
    }
    return lines_read("board", argc, argv, long_options, read_option, &order.lines) &&
           (optind == argc || complain("not understood", argv[optind]));
}

/* ---- the wires ---- */

static bool broken(int defect)
{
    return !isnan(order.defect_s[defect]) &&
           (double)(bench.before + timeline_now()) * 1e-9 >= order.defect_s[defect];
}

static bool wire_broken(board_wire_t wire, int defect)
{
    return broken((int)wire * WIRE_DEFECTS + defect);
}

static double oscillator(void)
{
    return broken(WRONG_RATE_DEFECT) ? WRONG_RATE : broken(FAST_DEFECT) ? FAST : 1.0;
}

static double own_rate(board_wire_t wire)
{
    return board_rate(wire) * oscillator();
}

/* Start bit, eight of the octet, stop bit; it has just ended. Octets that follow each other do so on the pin
 * too, whatever the oscillator. */
static void record_bits(board_wire_t wire, unsigned octet)
{
    static struct {
        sim_time_t follows, ended; /* the octet before: its end on the pin, and when it was given */
    } before[BOARD_WIRES];
    const double bit_ns = 1e9 / own_rate(wire);
    const unsigned levels = octet << 1 | 1U << 9;
    const sim_time_t now = bench.before + timeline_now();
    const bool follows_on = (double)(now - before[wire].ended) < 10.5 * 1e9 / board_rate(wire);
    const sim_time_t end = follows_on ? before[wire].follows + llround(10.0 * bit_ns) : now;
    char rows[10 * 40];
    int length = 0;

    for (int i = 0; i < 10 && bench.bits[wire] >= 0; i++) {
        length += snprintf(rows + length, sizeof rows - (size_t)length, "%lld,%u\n",
                           (long long)end - llround((10 - i) * bit_ns), levels >> i & 1U);
    }
    if (length > 0 && write(bench.bits[wire], rows, (size_t)length) < 0) {
        perror(order.lines.bits[wire]);
    }
    before[wire].follows = end;
    before[wire].ended = now;
}

static unsigned char garbled(board_wire_t wire, unsigned char octet)
{
    if (wire_broken(wire, GARBLED) && ++bench.passed % GARBLED_ONE_IN == 0) {
        return (unsigned char)(noise_bits(&bench.noise) & 0xFFU);
    }
    return octet;
}

static void out(void *context, unsigned octet)
{
    port_t *port = context;
    const board_wire_t wire = (board_wire_t)(port - bench.ports);
    const double ratio = (double)port_rate(port) / own_rate(wire);
    unsigned char c = garbled(wire, (unsigned char)octet);

    record_bits(wire, octet);
    if (wire_broken(wire, SWAPPED) || port->fd < 0) {
        return;
    }
    if (fabs(ratio - 1.0) > MISMATCH) {
        c = (unsigned char)(noise_bits(&bench.noise) & 0xFFU);
    }
    (void)port_write(port, &c, 1);
}

static void out_usb(void *unused, unsigned octet, double bit_ns)
{
    const double ratio = (double)port_rate(&bench.usb) * bit_ns * 1e-9 / oscillator();
    unsigned char c = (unsigned char)(fabs(ratio - 1.0) > MISMATCH ? noise_bits(&bench.noise) & 0xFFU
                                                                   : octet);

    (void)unused;
    (void)port_write(&bench.usb, &c, 1);
}

typedef struct {
    board_wire_t wire;
    size_t count;
    unsigned char octets[4096];
} late_t;

static void arrive(board_wire_t wire, const unsigned char *octets, size_t count)
{
    /* A fast oscillator samples as if the far end were slow. */
    const double rate = (double)port_rate(&bench.ports[wire]) / oscillator();

    if (rate > 0.0) {
        board_receive_at(wire, rate, octets, count);
    }
}

static void arrive_late(void *context)
{
    late_t *late = context;

    arrive(late->wire, late->octets, late->count);
    free(late);
}

static void in(void *context, const unsigned char *octets, size_t count)
{
    const port_t *port = context;
    late_t *late = malloc(sizeof *late);

    if (late == NULL) {
        abort();
    }
    late->wire = (board_wire_t)(port - bench.ports);
    late->count = count;
    for (size_t i = 0; i < count; i++) {
        late->octets[i] = garbled(late->wire, octets[i]);
    }
    if (wire_broken(late->wire, SWAPPED)) {
        free(late);
    } else if (wire_broken(late->wire, LATELY)) {
        timeline_after(LATE, arrive_late, late);
    } else {
        arrive_late(late);
    }
}

static void unplug(void)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (wire_broken((board_wire_t)i, GONE) && bench.ports[i].fd >= 0) {
            pace_forget(&bench.ports[i]);
            port_close(&bench.ports[i]);
        }
    }
}

/* ---- the throttle pin ---- */

static void record(sim_time_t when, bool level)
{
    char row[48];
    const int length = snprintf(row, sizeof row, "%lld,%d\n", (long long)((bench.before + when) / SIM_US),
                                level);

    if (write(bench.pulses, row, (size_t)length) < 0 && errno != EAGAIN) {
        perror(order.lines.pulses);
    }
}

static void pulse(sim_time_t high_ns)
{
    const sim_time_t now = timeline_now();
    const bool inverted = broken(PULSE_INVERTED);

    if (bench.pulses < 0 || broken(PULSE_MISSING)) {
        return;
    }
    if (broken(PULSE_LONG)) {
        high_ns = (sim_time_t)((double)high_ns * LONG_PULSE);
    }
    record(now - high_ns, !inverted);
    record(now, inverted);
}

/* Read as well: a FIFO opens without waiting for its reader. */
static bool open_recording(const char *path, int *file)
{
    if (path == NULL) {
        return true;
    }
    *file = open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0644);
    return *file >= 0 || complain(strerror(errno), path);
}

/* All of them are open: what was in one is gone from here on. */
static bool begin_recording(const char *path, const char *unit, const char *first, int file)
{
    char head[160];
    const int length = snprintf(
        head, sizeof head,
        "; CSV generated by plomada board, as by libsigrok 0.5.2\n; Channels (1/1): D0\n"
        "; Samplerate: 1 MHz\n%s,logic\n0,%s\n",
        unit, first);

    if (path == NULL) {
        return true;
    }
    (void)!ftruncate(file, 0); /* a FIFO has no length */
    return write(file, head, (size_t)length) > 0 || complain(strerror(errno), path);
}

static bool open_recordings(void)
{
    bool fine = open_recording(order.lines.pulses, &bench.pulses);

    for (int i = 0; i < BOARD_WIRES; i++) {
        fine = fine && open_recording(order.lines.bits[i], &bench.bits[i]);
    }
    return fine;
}

static bool begin_recordings(void)
{
    bool fine = begin_recording(order.lines.pulses, "microseconds", "0", bench.pulses);

    for (int i = 0; i < BOARD_WIRES; i++) {
        fine = fine && begin_recording(order.lines.bits[i], "nanoseconds", "1", bench.bits[i]);
    }
    return fine;
}

/* ---- life ---- */

static void on_power_cycle(int signal_number)
{
    (void)signal_number;
    power_cycle = 1;
}

static void keep_storage(void)
{
    const char *error = order.storage != NULL ? flash_store(order.storage) : NULL;

    if (error != NULL) {
        complain(error, order.storage);
    }
}

static void power_on(void)
{
    static const board_probes_t probes = {.pulse = pulse};
    board_config_t config = board_config(order.seed);

    config.quadrotor.anchored = true;
    if (!isnan(order.defect_s[SLOW_CODE])) {
        config.costs = costs_stretch(&bench.costs, config.costs, SLOW);
    }
    flash_cut_power_after(isnan(order.defect_s[NO_STORAGE]) ? -1 : 0);
    board_probe(BOARD_PROBE_TIMING, &probes);
    board_power_on(&config, NULL, NULL);
    if (!isnan(order.defect_s[NO_WATCHDOG])) {
        chip_watchdog_connect(NULL, NULL);
    }
    if (order.usb != NULL) {
        board_connect_usb(out_usb, NULL);
    }
    pace_begin();
    kernel_set_pacer(pace_wait);
    for (int i = 0; i < BOARD_WIRES; i++) {
        board_connect((board_wire_t)i, out, &bench.ports[i]);
        if (bench.ports[i].fd >= 0) {
            pace_watch(&bench.ports[i], in, &bench.ports[i]);
        }
    }
}

static void power_off(void)
{
    bench.before += timeline_now();
    kernel_set_pacer(NULL);
    board_power_off();
    keep_storage();
    if (!isnan(order.defect_s[FORGETFUL])) {
        flash_blank();
    }
}

static void look_at_the_clock(void)
{
    const sim_time_t lag = pace_lag();

    bench.worst_lag = lag > bench.worst_lag ? lag : bench.worst_lag;
}

static void live(void)
{
    const sim_time_t end = order.duration_s > 0.0 ? (sim_time_t)(order.duration_s * 1e9) : SIM_NEVER;

    power_on();
    while (!pace_interrupted() && bench.before + timeline_now() < end) {
        (void)kernel_run_until(timeline_now() +
                               STEP); /* false: the firmware stopped, the watchdog will restart it */
        look_at_the_clock();
        unplug();
        if (power_cycle) {
            power_cycle = 0;
            power_off();
            power_on();
        }
    }
    power_off();
    fprintf(stderr, "plomada board: this PC was at most %.0f ms behind the wall clock\n",
            (double)bench.worst_lag * 1e-6);
}

static bool open_wire(port_t *port, unsigned long rate, const char *path, bool *linked)
{
    const char *error = port_open_pty(port, rate);

    if (error == NULL) {
        error = port_link(port, path);
        *linked = error == NULL;
    }
    return error == NULL || complain(error, path);
}

/* Signals are caught before the links are there: who finds a link may send one at once. */
static bool open_wires(void)
{
    static const unsigned long rates[BOARD_WIRES] = {115200, 57600, 9600};
    bool fine = order.usb == NULL || open_wire(&bench.usb, 115200, order.usb, &bench.usb_linked);

    for (int i = 0; i < BOARD_WIRES && fine; i++) {
        fine = open_wire(&bench.ports[i], rates[i], order.lines.path[i], &bench.linked[i]);
    }
    return fine;
}

static void close_wire(port_t *port, const char *path, bool linked)
{
    if (linked) {
        port_unlink(port, path);
    }
    if (port->name[0] != '\0') {
        port_close(port);
    }
}

static void close_wires(void)
{
    close_wire(&bench.usb, order.usb, bench.usb_linked);
    for (int i = 0; i < BOARD_WIRES; i++) {
        close_wire(&bench.ports[i], order.lines.path[i], bench.linked[i]);
    }
}

static bool files_apart(void)
{
    const lines_t *lines = &order.lines;
    const output_use_t uses[] = {{"--storage", order.storage, true},
                                 {"--pulses", lines->pulses, true},
                                 {"--bits laser", lines->bits[BOARD_LASER], true},
                                 {"--bits imu", lines->bits[BOARD_IMU], true},
                                 {"--bits xbee", lines->bits[BOARD_RADIO], true}};

    return output_apart("board", uses, sizeof uses / sizeof uses[0]);
}

static bool load_storage(void)
{
    const char *error = order.storage != NULL ? flash_load(order.storage) : NULL;

    return error == NULL || complain(error, order.storage);
}

int command_board(int argc, char **argv)
{
    bool begun;

    if (!read_arguments(argc, argv)) {
        fprintf(stderr, "`plomada board --help` tells more.\n");
        return 2;
    }
    if (order.lines.help) {
        fputs(usage, stdout);
        fputs(defect_help, stdout);
        return 0;
    }
    noise_init(&bench.noise, order.seed, "nonsense");
    pace_begin();
    (void)signal(SIGUSR1, on_power_cycle);
    begun = files_apart() && load_storage() && open_recordings() && open_wires() && begin_recordings();
    if (begun) {
        printf("board: %s %s %s\n", order.lines.path[BOARD_LASER], order.lines.path[BOARD_IMU],
               order.lines.path[BOARD_RADIO]);
        fflush(stdout);
        live();
    }
    close_wires();
    pace_end();
    return begun ? 0 : 2;
}
