#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scanner.h"
#include "scip.h"
#include "drivers/scip_layout.h"

#define START_PATIENCE_S 30.0
#define TEXT_MAX 1024
#define BURST_US 2000

static const char usage[] =
    "usage: plomada scip record DEVICE FILE [OPTION]...\n\n"
    "Brings the scanner on a serial port to SCIP2.0 and streaming (MS), from whatever state it is in, and "
    "records:\n"
    "  FILE       what the sensor sent, raw\n"
    "  FILE.tx    what was sent to it\n"
    "  FILE.csv   when: dir,t_us,offset,length\n"
    "  FILE.md    the birth certificate: device, firmware, date, command\n\n"
    "  --seconds S    of scans (default 10); Ctrl-C ends it earlier\n"
    "  --rate N       19200, 57600, 115200 or 250000 bit/s (default 115200; many RS232 adapters cannot do "
    "250000)\n"
    "  --steps A..B   0..768 (default 44..725)\n\n"
    "Exit status: 0 recorded, 1 no scans, 2 usage, the port or a file cannot be opened.\n";

enum { OPT_SECONDS = 1, OPT_RATE, OPT_STEPS, OPT_HELP };

static const struct option long_options[] = {
    {"seconds", required_argument, NULL, OPT_SECONDS},
    {"rate", required_argument, NULL, OPT_RATE},
    {"steps", required_argument, NULL, OPT_STEPS},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

/* Octets of one direction that came within a moment: one line of the time table. */
typedef struct {
    bool from_sensor;
    long long t_us; /* of the first */
    unsigned long offset;
    size_t length; /* 0: none */
} burst_t;

typedef struct {
    scanner_config_t scanner;
    const char *path;
    double seconds;
    bool help;
    FILE *rx, *tx, *csv, *certificate;
    unsigned long rx_octets, tx_octets;
    burst_t burst;
    char version[TEXT_MAX], parameters[TEXT_MAX];
} recording_t;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada scip record: %s: %s\n", subject, what);
    return false;
}

/* ---- arguments ---- */

static bool read_seconds(recording_t *recording, const char *text)
{
    char *end;

    recording->seconds = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && recording->seconds > 0.0 && isfinite(recording->seconds)) ||
           complain("not a number of seconds", text);
}

static bool read_rate(recording_t *recording, const char *text)
{
    static const unsigned long rates[] = {19200, 57600, 115200, 250000};
    char *end;

    recording->scanner.rate = strtoul(text, &end, 10);
    for (size_t i = 0; *end == '\0' && i < sizeof rates / sizeof rates[0]; i++) {
        if (recording->scanner.rate == rates[i]) {
            return true;
        }
    }
    return complain("not one of 19200, 57600, 115200, 250000", text);
}

static bool read_steps(recording_t *recording, const char *text)
{
    unsigned first, last;
    int used = -1;

    if (sscanf(text, "%4u..%4u%n", &first, &last, &used) != 2 || text[used] != '\0' || first > last ||
        last > SCIP_STEP_MAX) {
        return complain("not of the form A..B with 0 <= A <= B <= 768", text);
    }
    recording->scanner.first_step = first;
    recording->scanner.last_step = last;
    return true;
}

static bool read_option(recording_t *recording, int option, const char *argument)
{
    switch (option) {
    case OPT_SECONDS:
        return read_seconds(recording, argument);
    case OPT_RATE:
        return read_rate(recording, argument);
    case OPT_STEPS:
        return read_steps(recording, argument);
    case OPT_HELP:
        recording->help = true;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(recording_t *recording, int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (!read_option(recording, option, optarg)) {
            return false;
        }
    }
    if (recording->help) {
        return true;
    }
    if (optind + 2 != argc) {
        return complain("DEVICE and FILE are needed", "record");
    }
    recording->scanner.device = argv[optind];
    recording->path = argv[optind + 1];
    return true;
}

/* ---- files ---- */

static FILE *open_file(const recording_t *recording, const char *suffix)
{
    char path[4096];
    FILE *file;

    snprintf(path, sizeof path, "%s%s", recording->path, suffix);
    file = fopen(path, "wb");
    if (file == NULL) {
        perror(path);
    }
    return file;
}

static bool open_files(recording_t *recording)
{
    recording->rx = open_file(recording, "");
    recording->tx = open_file(recording, ".tx");
    recording->csv = open_file(recording, ".csv");
    recording->certificate = open_file(recording, ".md");
    return recording->rx != NULL && recording->tx != NULL && recording->csv != NULL &&
           recording->certificate != NULL;
}

static bool close_file(FILE *file)
{
    const bool failed = ferror(file) != 0;

    return fclose(file) == 0 && !failed;
}

static bool close_files(recording_t *recording)
{
    const bool rx = close_file(recording->rx), tx = close_file(recording->tx),
               csv = close_file(recording->csv);

    return (close_file(recording->certificate) && rx && tx && csv) ||
           complain("not written whole", recording->path);
}

static void write_burst(recording_t *recording)
{
    const burst_t *burst = &recording->burst;

    if (burst->length > 0) {
        fprintf(recording->csv, "%s,%lld,%lu,%zu\n", burst->from_sensor ? "rx" : "tx", burst->t_us,
                burst->offset, burst->length);
    }
}

static void keep(void *context, bool from_sensor, long long t_us, const unsigned char *octets, size_t count)
{
    recording_t *recording = context;
    unsigned long *total = from_sensor ? &recording->rx_octets : &recording->tx_octets;
    burst_t *burst = &recording->burst;

    fwrite(octets, 1, count, from_sensor ? recording->rx : recording->tx);
    if (burst->length == 0 || burst->from_sensor != from_sensor || t_us - burst->t_us >= BURST_US) {
        write_burst(recording);
        *burst = (burst_t){from_sensor, t_us, *total, 0};
    }
    burst->length += count;
    *total += count;
}

static void write_text(FILE *out, const char *title, const char *text)
{
    fprintf(out, "\n%s\n\n```\n%s```\n", title, *text != '\0' ? text : "(no answer)\n");
}

static void write_certificate(const recording_t *recording, const char *date)
{
    const scanner_config_t *scanner = &recording->scanner;
    const char *name = strrchr(recording->path, '/');
    FILE *out = recording->certificate;

    name = name == NULL ? recording->path : name + 1;
    fprintf(out, "# %s: birth certificate\n\n", name);
    fprintf(out, "| | |\n|---|---|\n");
    fprintf(out, "| recorded | %s, from `%s` |\n", date, scanner->device);
    fprintf(out, "| by | `plomada scip record %s %s --seconds %g --rate %lu --steps %u..%u` |\n",
            scanner->device, recording->path, recording->seconds, scanner->rate, scanner->first_step,
            scanner->last_step);
    fprintf(out, "| rate of the stream | %lu bit/s |\n", scanner_rate());
    fprintf(out, "| octets | %lu from the sensor, %lu to it |\n", recording->rx_octets, recording->tx_octets);
    fprintf(out, "| scans | %lu good, %lu replies or scans damaged |\n", scanner_scans(), scanner_damaged());
    write_text(out, "The sensor says of itself (VV):", recording->version);
    write_text(out, "and of its limits (PP):", recording->parameters);
    fprintf(
        out,
        "\nTo be filled in: what stood where, who held the sensor, under which licence this may be used.\n");
}

/* ---- the recording ---- */

static void record(recording_t *recording)
{
    char date[32];
    const time_t now = time(NULL);

    strftime(date, sizeof date, "%Y-%m-%d %H:%M:%S UTC", gmtime(&now));
    if (scanner_start(START_PATIENCE_S)) {
        scanner_run(recording->seconds);
    }
    if (scanner_scans() > 0 && scanner_stop()) {
        scanner_ask(SCIP_VERSION, recording->version, sizeof recording->version);
        scanner_ask(SCIP_PARAMETERS, recording->parameters, sizeof recording->parameters);
    }
    write_certificate(recording, date);
}

static int run(recording_t *recording)
{
    const char *error;

    recording->scanner.tap = keep;
    recording->scanner.context = recording;
    error = scanner_open(&recording->scanner);
    if (error != NULL) {
        complain(error, recording->scanner.device);
        return 2;
    }
    if (!open_files(recording)) {
        scanner_close();
        return 2;
    }
    fprintf(recording->csv, "dir,t_us,offset,length\n");
    record(recording);
    write_burst(recording);
    scanner_close();
    if (!close_files(recording)) {
        return 2;
    }
    fprintf(stderr, "scans: %lu\ndamaged: %lu\noctets: %lu\n", scanner_scans(), scanner_damaged(),
            recording->rx_octets);
    return scanner_scans() > 0 ? 0 : 1;
}

int scip_record(int argc, char **argv)
{
    static recording_t recording = {
        .scanner = {.rate = 115200, .first_step = SCIP_STEP_FIRST, .last_step = SCIP_STEP_LAST},
        .seconds = 10.0,
    };

    if (!read_arguments(&recording, argc, argv)) {
        fprintf(stderr, "`plomada scip record --help` tells more.\n");
        return 2;
    }
    if (recording.help) {
        fputs(usage, stdout);
        return 0;
    }
    return run(&recording);
}
