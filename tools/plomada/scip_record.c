#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "output.h"
#include "scanner.h"
#include "scip.h"
#include "scip_reader.h"
#include "drivers/scip_layout.h"

#define START_PATIENCE_S 30.0
#define TEXT_MAX 1024
#define BURST_US 2000
#define FILES 4
#define FLUSH_US 1000000 /* what the end of this program or of the disk may cost */

static const char usage[] =
    "usage: plomada scip record DEVICE FILE [OPTION]...\n\n"
    "Brings the scanner on a serial port to SCIP2.0 and streaming (MS), from whatever state it is in, and "
    "records:\n"
    "  FILE       what the sensor sent, raw\n"
    "  FILE.tx    what was sent to it\n"
    "  FILE.csv   when: dir,t_us,offset,length\n"
    "  FILE.md    the birth certificate: device, firmware, date, command\n\n"
    "  --seconds S    of scans (default 10); Ctrl-C ends it earlier\n"
    "  --rate N       19200, 57600, 115200, 250000, 500000 or 750000 bit/s (default 115200; many RS232 "
    "adapters cannot do\n"
    "                 250000 and more)\n"
    "  --steps A..B   0..768 (default 44..725)\n"
    "  --force        overwrites files that are there already\n\n"
    "Once a second all files are brought up to date, and stderr shows the scans per second: a recording that "
    "is cut off, by\n"
    "a kill or a full disk, lacks its last second at most.\n\n"
    "Exit status: 0 recorded, 1 no scans, or the port went away; 2 usage, the port or a file cannot be "
    "opened or written.\n";

enum { OPT_SECONDS = 1, OPT_RATE, OPT_STEPS, OPT_FORCE, OPT_HELP };

static const struct option long_options[] = {
    {"seconds", required_argument, NULL, OPT_SECONDS},
    {"rate", required_argument, NULL, OPT_RATE},
    {"steps", required_argument, NULL, OPT_STEPS},
    {"force", no_argument, NULL, OPT_FORCE},
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
    bool force, help;
    FILE *rx, *tx, *csv, *certificate;
    char date[32];
    unsigned long rx_octets, tx_octets;
    burst_t burst;
    long long flushed_us;
    unsigned long flushed_scans;
    bool failed;          /* a file cannot be written */
    scip_reader_t reader; /* of what is recorded: it counts what `scip decode` will find */
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
    static const unsigned long rates[] = {19200, 57600, 115200, 250000, 500000, 750000};
    char *end;

    recording->scanner.rate = strtoul(text, &end, 10);
    for (size_t i = 0; *end == '\0' && i < sizeof rates / sizeof rates[0]; i++) {
        if (recording->scanner.rate == rates[i]) {
            return true;
        }
    }
    return complain("not one of 19200, 57600, 115200, 250000, 500000, 750000", text);
}

static bool read_steps(recording_t *recording, const char *text)
{
    unsigned first, last;
    int used = -1;

    if (sscanf(text, "%4u..%4u%n", &first, &last, &used) != 2 || text[used] != '\0' || first > last ||
        last > SCIP_STEP_MAX_URG04LX) {
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
    case OPT_FORCE:
        recording->force = true;
        return true;
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

/* All of them, or none. */
static bool open_files(recording_t *recording)
{
    static const char *const suffixes[FILES] = {"", ".tx", ".csv", ".md"};
    static char path[FILES][4096];
    static output_t output[FILES];
    output_t *outputs[FILES];

    for (size_t i = 0; i < FILES; i++) {
        snprintf(path[i], sizeof path[i], "%s%s", recording->path, suffixes[i]);
        if (!recording->force && access(path[i], F_OK) == 0) {
            return complain("is there already; --force overwrites it", path[i]);
        }
        output[i].path = path[i];
        outputs[i] = &output[i];
    }
    if (!output_open_all(outputs, FILES)) {
        return false;
    }
    recording->rx = output[0].file;
    recording->tx = output[1].file;
    recording->csv = output[2].file;
    recording->certificate = output[3].file;
    return true;
}

static bool close_file(FILE *file)
{
    const bool failed = file == NULL || ferror(file) != 0;

    return file != NULL && fclose(file) == 0 && !failed;
}

static bool close_files(recording_t *recording)
{
    const bool rx = close_file(recording->rx), tx = close_file(recording->tx),
               csv = close_file(recording->csv);

    return close_file(recording->certificate) && rx && tx && csv && !recording->failed;
}

static void write_burst(recording_t *recording)
{
    burst_t *burst = &recording->burst;

    if (burst->length > 0) {
        fprintf(recording->csv, "%s,%lld,%lu,%zu\n", burst->from_sensor ? "rx" : "tx", burst->t_us,
                burst->offset, burst->length);
    }
    burst->length = 0;
}

static void write_text(FILE *out, const char *title, const char *text)
{
    fprintf(out, "\n%s\n\n```\n%s```\n", title, *text != '\0' ? text : "(no answer)\n");
}

static void write_head(const recording_t *recording, FILE *out)
{
    const scanner_config_t *scanner = &recording->scanner;
    const char *name = strrchr(recording->path, '/');

    name = name == NULL ? recording->path : name + 1;
    fprintf(out, "# %s: birth certificate\n\n", name);
    fprintf(out, "| | |\n|---|---|\n");
    fprintf(out, "| recorded | %s, from `%s` |\n", recording->date, scanner->device);
    fprintf(out, "| by | `plomada scip record %s %s --seconds %g --rate %lu --steps %u..%u` |\n",
            scanner->device, recording->path, recording->seconds, scanner->rate, scanner->first_step,
            scanner->last_step);
    fprintf(out, "| rate of the stream | %lu bit/s, %.2f scans per second of the sensor's clock |\n",
            scanner_rate(), scanner_scans_per_s());
    fprintf(out, "| octets | %lu from the sensor, %lu to it |\n", recording->rx_octets, recording->tx_octets);
    fprintf(out, "| scans | %lu good, %lu replies or scans damaged |\n", recording->reader.totals.scans,
            scip_reader_damaged(&recording->reader));
}

/* Over what was written before. `whole`: the recording came to its end. */
static void write_certificate(const recording_t *recording, bool whole)
{
    FILE *out = recording->certificate;

    rewind(out);
    write_head(recording, out);
    if (!whole) {
        fprintf(out, "\n**Cut off**: this recording did not come to its end.\n");
    } else {
        write_text(out, "The sensor says of itself (VV):", recording->version);
        write_text(out, "and of its limits (PP):", recording->parameters);
    }
    fprintf(
        out,
        "\nTo be filled in: what stood where, who held the sensor, under which licence this may be used.\n");
    if (fflush(out) == 0) {
        (void)!ftruncate(fileno(out), ftell(out));
    }
}

static void show_progress(recording_t *recording, long long t_us)
{
    const unsigned long scans = recording->reader.totals.scans;
    const double lasted_s = (double)(t_us - recording->flushed_us) * 1e-6;

    fprintf(stderr, "%s%6.1f s: %.1f scans/s, %lu scans, %lu damaged%s", isatty(STDERR_FILENO) ? "\r" : "",
            (double)t_us * 1e-6, (double)(scans - recording->flushed_scans) / lasted_s, scans,
            scip_reader_damaged(&recording->reader), isatty(STDERR_FILENO) ? "" : "\n");
    recording->flushed_scans = scans;
}

/* The table last: it never tells of octets that are not there. */
static void bring_up_to_date(recording_t *recording)
{
    write_burst(recording);
    if (fflush(recording->rx) != 0 || fflush(recording->tx) != 0 || fflush(recording->csv) != 0) {
        complain(strerror(errno), recording->path);
        recording->failed = true;
        return;
    }
    write_certificate(recording, false);
}

static void count_alone(void *context, const scip_scan_t *scan)
{
    (void)context;
    (void)scan;
}

static void keep(void *context, bool from_sensor, long long t_us, const unsigned char *octets, size_t count)
{
    recording_t *recording = context;
    unsigned long *total = from_sensor ? &recording->rx_octets : &recording->tx_octets;
    burst_t *burst = &recording->burst;

    if (recording->failed) {
        return;
    }
    if (burst->length == 0 || burst->from_sensor != from_sensor || t_us - burst->t_us >= BURST_US) {
        write_burst(recording);
        *burst = (burst_t){from_sensor, t_us, *total, 0};
    }
    fwrite(octets, 1, count, from_sensor ? recording->rx : recording->tx);
    if (from_sensor) {
        scip_reader_feed(&recording->reader, octets, count);
    }
    burst->length += count;
    *total += count;
    if (t_us - recording->flushed_us >= FLUSH_US) {
        bring_up_to_date(recording);
        show_progress(recording, t_us);
        recording->flushed_us = t_us;
    }
}

/* ---- the recording ---- */

static void run_to_the_end(recording_t *recording)
{
    double left_s = recording->seconds;

    while (left_s > 0.0 && !recording->failed && !scanner_is_gone()) {
        const double part_s = left_s < 0.2 ? left_s : 0.2;

        if (!scanner_run(part_s)) {
            return;
        }
        left_s -= part_s;
    }
}

static bool record(recording_t *recording)
{
    const time_t now = time(NULL);
    bool whole;

    strftime(recording->date, sizeof recording->date, "%Y-%m-%d %H:%M:%S UTC", gmtime(&now));
    if (scanner_start(START_PATIENCE_S)) {
        run_to_the_end(recording);
    }
    whole = !scanner_is_gone() && !recording->failed;
    if (whole && recording->reader.totals.scans > 0 && scanner_stop()) {
        scanner_ask(SCIP_VERSION, recording->version, sizeof recording->version);
        scanner_ask(SCIP_PARAMETERS, recording->parameters, sizeof recording->parameters);
    }
    if (!recording->failed) {
        bring_up_to_date(recording);
    }
    if (!recording->failed) {
        write_certificate(recording, whole);
    }
    return whole;
}

static void tell(const recording_t *recording)
{
    fprintf(stderr, "%sscans: %lu\ndamaged: %lu\noctets: %lu\n", isatty(STDERR_FILENO) ? "\n" : "",
            recording->reader.totals.scans, scip_reader_damaged(&recording->reader), recording->rx_octets);
}

static int run(recording_t *recording)
{
    const char *error;
    bool whole, written;

    scip_reader_init(&recording->reader, count_alone, NULL);
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
    whole = record(recording);
    scanner_close();
    written = close_files(recording);
    tell(recording);
    if (!written) {
        complain("not written whole", recording->path);
        return 2;
    }
    return whole && recording->reader.totals.scans > 0 ? 0 : 1;
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
