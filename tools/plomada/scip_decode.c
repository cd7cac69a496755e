#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scip.h"
#include "scip_reader.h"

static const char usage[] =
    "usage: plomada scip decode FILE|- [OPTION]...\n\n"
    "Reads what a scanner sent, raw octets or a log of flexiport (.logr), and writes its scans as CSV with "
    "one header line:\n"
    "  time          s, the sensor's own clock; its 24 bits are continued\n"
    "  step_44 ...   mm as sent, one column for each step that any scan has; below 20 a code\n"
    "A scan without that step leaves its cell empty. With a cluster a value stands at its first step.\n\n"
    "  --long        one line for each point instead: time,step,angle_deg,distance_mm (angle: positive to "
    "the left of the\n"
    "                front, of the sensor's own PP where the recording has it, else of the URG-04LX; with "
    "steps above\n"
    "                768 of the UTM-30LX)\n"
    "  --no-codes    cells without a distance stay empty: codes, and 4095 of two characters (far or "
    "unknown)\n\n"
    "Echo lines in the stream say what was asked for: MS, MD, GS, GD. A damaged frame gives no line. The "
    "summary on stderr\n"
    "says which sensor it was and what was skipped, and why.\n\n"
    "Exit status: 0 scans were found, 1 none, 2 usage or unreadable file.\n";

enum { OPT_LONG = 1, OPT_NO_CODES, OPT_HELP };

static const struct option long_options[] = {
    {"long", no_argument, NULL, OPT_LONG},
    {"no-codes", no_argument, NULL, OPT_NO_CODES},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

#define STEPS (SCIP_STEP_MAX + 1U)

typedef struct {
    uint32_t time_ms;
    uint16_t first_step, cluster, points, characters;
    size_t begin; /* in the list of distances */
} record_t;

typedef struct {
    const char *path;
    bool points, no_codes, help;
    record_t *records;
    size_t count, capacity;
    uint16_t *distances;
    size_t used, room;
    bool has_step[STEPS];
} decode_t;

static void *grown(void *memory, size_t needed, size_t *capacity, size_t size)
{
    if (needed > *capacity) {
        *capacity = 2 * needed;
        memory = realloc(memory, *capacity * size);
        if (memory == NULL) {
            abort();
        }
    }
    return memory;
}

static void keep_scan(void *context, const scip_scan_t *scan)
{
    decode_t *decode = context;
    const uint32_t before = decode->count == 0 ? scan->timestamp_ms
                                               : decode->records[decode->count - 1].time_ms;

    decode->records = grown(decode->records, decode->count + 1, &decode->capacity, sizeof *decode->records);
    decode->distances = grown(decode->distances, decode->used + scan->points, &decode->room,
                              sizeof *decode->distances);
    decode->records[decode->count++] = (record_t){scip_unwrap_ms(before, scan->timestamp_ms),
                                                  scan->first_step,
                                                  scan->cluster,
                                                  scan->points,
                                                  scan->characters,
                                                  decode->used};
    memcpy(decode->distances + decode->used, scan->distance_mm, scan->points * sizeof *decode->distances);
    decode->used += scan->points;
    for (unsigned i = 0; i < scan->points; i++) {
        decode->has_step[scan->first_step + i * scan->cluster] = true;
    }
}

static void write_time(const record_t *record)
{
    printf("%lu.%03lu", (unsigned long)record->time_ms / 1000, (unsigned long)record->time_ms % 1000);
}

static void write_distance(const decode_t *decode, const record_t *record, unsigned point)
{
    const unsigned mm = decode->distances[record->begin + point];
    const bool is_code = mm < SCIP_CODE_LIMIT_MM || (record->characters == 2 && mm >= SCIP_FAR_2_MM);

    putchar(',');
    if (!decode->no_codes || !is_code) {
        printf("%u", mm);
    }
}

static void write_points(const decode_t *decode, const scip_limits_t *limits)
{
    printf("time,step,angle_deg,distance_mm\n");
    for (size_t i = 0; i < decode->count; i++) {
        const record_t *record = &decode->records[i];

        for (unsigned k = 0; k < record->points; k++) {
            const uint16_t step = (uint16_t)(record->first_step + k * record->cluster);

            write_time(record);
            printf(",%u,%.3f", step, scip_limits_mdeg(limits, step) / 1000.0);
            write_distance(decode, record, k);
            putchar('\n');
        }
    }
}

static void write_scan(const decode_t *decode, const record_t *record)
{
    write_time(record);
    for (unsigned step = 0; step < STEPS; step++) {
        const unsigned point = (step - record->first_step) / record->cluster;

        if (!decode->has_step[step]) {
            continue;
        }
        if (step < record->first_step || point >= record->points ||
            (step - record->first_step) % record->cluster != 0) {
            putchar(',');
        } else {
            write_distance(decode, record, point);
        }
    }
    putchar('\n');
}

static void write_scans(const decode_t *decode)
{
    printf("time");
    for (unsigned step = 0; step < STEPS; step++) {
        if (decode->has_step[step]) {
            printf(",step_%u", step);
        }
    }
    putchar('\n');
    for (size_t i = 0; i < decode->count; i++) {
        write_scan(decode, &decode->records[i]);
    }
}

/* Without the sensor's own PP its steps tell which kind it is. */
static scip_limits_t limits_of(const decode_t *decode, const scip_info_t *info)
{
    bool beyond = false;

    for (unsigned step = SCIP_STEP_MAX_URG04LX + 1; step < STEPS; step++) {
        beyond = beyond || decode->has_step[step];
    }
    return info->told.ares == 0 && beyond ? scip_limits_utm30lx : scip_info_limits(info);
}

static int run(decode_t *decode)
{
    static scip_reader_t reader;
    const char *error;
    scip_limits_t limits;

    scip_reader_init(&reader, keep_scan, decode);
    error = scip_reader_file(&reader, decode->path);
    if (error != NULL) {
        fprintf(stderr, "plomada scip decode: %s: %s\n", decode->path, error);
        return 2;
    }
    limits = limits_of(decode, &reader.info);
    if (decode->points) {
        write_points(decode, &limits);
    } else {
        write_scans(decode);
    }
    if (fflush(stdout) != 0 || ferror(stdout)) {
        perror("plomada scip decode: stdout");
        return 2;
    }
    scip_reader_print(&reader, stderr);
    return reader.totals.scans > 0 ? 0 : 1;
}

static bool read_option(decode_t *decode, int option)
{
    decode->points = decode->points || option == OPT_LONG;
    decode->no_codes = decode->no_codes || option == OPT_NO_CODES;
    decode->help = decode->help || option == OPT_HELP;
    return option != '?';
}

static bool read_arguments(decode_t *decode, int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (!read_option(decode, option)) {
            return false;
        }
    }
    decode->path = argv[optind];
    return decode->help || optind + 1 == argc;
}

int scip_decode(int argc, char **argv)
{
    static decode_t decode;
    int status;

    if (!read_arguments(&decode, argc, argv)) {
        fputs(usage, stderr);
        return 2;
    }
    if (decode.help) {
        fputs(usage, stdout);
        return 0;
    }
    status = run(&decode);
    free(decode.records);
    free(decode.distances);
    return status;
}
