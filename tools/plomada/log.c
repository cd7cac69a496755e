/* What people save of a flight, as CSV: a terminal's text, or the console log of XCTU with its payloads in
 * hex, with none, one or several dumps of `#LOG` among telemetry and answers. Every row of a dump carries its
 * number and a sum (drivers/line_sum.h), so nothing is guessed: a damaged row is left out and named, and so
 * is one that is missing. */
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "drivers/line_sum.h"
#include "input.h"
#include "output.h"
#include "saved.h"

#define MARK "OK LOG "
#define NAMED_MAX 8 /* rows that a message names one by one */

static const char usage[] =
    "usage: plomada log FILE... [-o DIR|-] [--force]\n\n"
    "Writes the #LOG dumps in what was saved of a flight as CSV. The first dump of flight.txt becomes "
    "flight.csv, further\n"
    "ones flight-2.csv and so on; that of flight.csv becomes flight-log.csv. FILE is text as a terminal "
    "saved it, or a\n"
    "console log of XCTU (its payloads in hex); telemetry and other answers between the rows do not "
    "matter.\n\n"
    "  -o DIR              where to (default: beside FILE); - is stdout, for a single dump\n"
    "  --force             a CSV that is there already is overwritten. Without it another log of that name "
    "is refused, and\n"
    "                      nothing is written. Two dumps of one name are refused in any case, and so is a "
    "FILE as output\n\n"
    "Each row is checked by its own sum. What is damaged or missing is left out and named on stderr. A log "
    "of no records is\n"
    "named, and not written.\n\n"
    "Exit status: 0 every dump is whole, 1 something is missing, 2 usage, no dump that has a record, a file "
    "that is there\n"
    "already, or one that cannot be read or written.\n";

/* A dump: its rows by their number; row 0 is the titles. */
typedef struct {
    char **rows;
    size_t count, room;
    long announced; /* records, as the firmware said before the first row; -1: not heard */
    bool ended;
} dump_t;

typedef struct {
    dump_t *dumps;
    size_t count;
    size_t damaged; /* rows whose sum is wrong */
    bool cut;       /* the file ends within a row */
} harvest_t;

typedef struct {
    const char *file;
    harvest_t harvest;
} source_t;

static struct {
    char **files;
    int count;
    const char *directory;
    bool force;
} order;

static void *resized(void *memory, size_t octets)
{
    void *now = realloc(memory, octets);

    if (now == NULL) {
        abort();
    }
    return now;
}

static dump_t *new_dump(harvest_t *harvest)
{
    harvest->dumps = resized(harvest->dumps, (harvest->count + 1) * sizeof *harvest->dumps);
    harvest->dumps[harvest->count] = (dump_t){.announced = -1};
    return &harvest->dumps[harvest->count++];
}

static void keep_row(harvest_t *harvest, unsigned long number, const char *text, size_t length)
{
    dump_t *dump = harvest->count == 0 ? NULL : &harvest->dumps[harvest->count - 1];

    /* A number that is known already belongs to another dump, whose announcement was lost. */
    if (dump == NULL || dump->ended || (number < dump->count && dump->rows[number] != NULL)) {
        dump = new_dump(harvest);
    }
    if (number >= dump->room) {
        const size_t room = 2 * (number + 1);

        dump->rows = resized(dump->rows, room * sizeof *dump->rows);
        memset(dump->rows + dump->room, 0, (room - dump->room) * sizeof *dump->rows);
        dump->room = room;
    }
    dump->rows[number] = resized(NULL, length + 1);
    memcpy(dump->rows[number], text, length);
    dump->rows[number][length] = '\0';
    dump->count = number + 1 > dump->count ? number + 1 : dump->count;
}

static bool sum_holds(const char *line, size_t length)
{
    char digits[LINE_SUM_DIGITS];

    line_sum_write(digits, line_sum(line, (uint16_t)length));
    return memcmp(digits, line + length + 1, LINE_SUM_DIGITS) == 0;
}

/* A line behind `OK LOG `, which begins with a digit. */
static void read_row(harvest_t *harvest, const char *line)
{
    const char *star = strrchr(line, '*');
    char *text;
    const unsigned long number = strtoul(line + strlen(MARK), &text, 10);

    if (star == NULL || strlen(star) != 1 + LINE_SUM_DIGITS || *text != ' ' || number > 1000000UL ||
        !sum_holds(line, (size_t)(star - line))) {
        harvest->damaged++;
        return;
    }
    keep_row(harvest, number, text + 1, (size_t)(star - text - 1));
}

static void read_line(harvest_t *harvest, const char *line)
{
    const char *rest = line + strlen(MARK);

    if (strncmp(line, MARK, strlen(MARK)) != 0) {
        return;
    }
    if (strncmp(rest, "records:", 8) == 0) {
        new_dump(harvest)->announced = strtol(rest + 8, NULL, 10);
    } else if (strncmp(rest, "END", 3) == 0 && harvest->count > 0) {
        harvest->dumps[harvest->count - 1].ended = true;
    } else if (isdigit((unsigned char)*rest)) {
        read_row(harvest, line);
    }
}

static void take_line(void *harvest, const char *line)
{
    read_line(harvest, line);
}

static void read_file(FILE *in, harvest_t *harvest)
{
    char rest[SAVED_LINE];

    saved_read(in, take_line, harvest, rest);
    harvest->cut = strncmp(rest, MARK, strlen(MARK)) == 0;
}

/* Telling
 * ----------------------------------------------------------------------------------------------------------
 */

/* Rows that should be there: up to the last one that came, or that was announced. */
static size_t rows_due(const dump_t *dump)
{
    return dump->announced >= 0 && (size_t)dump->announced + 1 > dump->count ? (size_t)dump->announced + 1
                                                                             : dump->count;
}

static size_t missing(const dump_t *dump)
{
    const size_t due = rows_due(dump);
    size_t count = due > dump->count ? due - dump->count : 0;

    for (size_t i = 0; i < dump->count; i++) {
        count += dump->rows[i] == NULL ? 1 : 0;
    }
    return count;
}

static bool has_row(const dump_t *dump, size_t row)
{
    return row < dump->count && dump->rows[row] != NULL;
}

static size_t records(const dump_t *dump)
{
    return rows_due(dump) - 1 - missing(dump);
}

/* Nothing was recorded, and nothing is missing. */
static bool is_empty(const dump_t *dump)
{
    return has_row(dump, 0) && rows_due(dump) == 1 && (dump->announced == 0 || dump->ended);
}

static void name_missing(const char *file, size_t number, const dump_t *dump)
{
    const size_t due = rows_due(dump);
    int named = 0;

    fprintf(stderr, "%s, dump %zu: %zu of %zu rows are missing:", file, number, missing(dump), due);
    for (size_t i = 0; i < due && named < NAMED_MAX; i++) {
        size_t last = i;

        if (has_row(dump, i)) {
            continue;
        }
        while (last + 1 < due && !has_row(dump, last + 1)) {
            last++;
        }
        fprintf(stderr, last == i ? " %zu" : " %zu..%zu", i, last);
        named++;
        i = last;
    }
    fputs(named == NAMED_MAX ? " ...\n" : "\n", stderr);
}

static bool whole(const char *file, const harvest_t *harvest)
{
    bool nothing_lost = harvest->damaged == 0 && !harvest->cut;

    if (harvest->damaged > 0) {
        fprintf(stderr, "%s: %zu rows with a wrong sum are left out\n", file, harvest->damaged);
    }
    if (harvest->cut) {
        fprintf(stderr, "%s: ends within a row, which is left out\n", file);
    }
    for (size_t i = 0; i < harvest->count; i++) {
        if (missing(&harvest->dumps[i]) > 0) {
            name_missing(file, i + 1, &harvest->dumps[i]);
            nothing_lost = false;
        } else if (is_empty(&harvest->dumps[i])) {
            nothing_lost = false; /* plan() has said so */
        } else if (!harvest->dumps[i].ended) {
            fprintf(stderr, "%s, dump %zu: its end was not received\n", file, i + 1);
            nothing_lost = false;
        }
    }
    return nothing_lost;
}

/* Writing
 * ----------------------------------------------------------------------------------------------------------
 */

static bool to_stdout(void)
{
    return order.directory != NULL && strcmp(order.directory, "-") == 0;
}

/* FILE without its directory and ending, in DIR; -2 and so on for a further dump. Never FILE itself. */
static void name_output(char path[PATH_MAX], const char *file, size_t number)
{
    const char *slash = strrchr(file, '/'), *base = slash == NULL ? file : slash + 1,
               *dot = strrchr(base, '.');
    const int length = (int)(dot == NULL || dot == base ? strlen(base) : (size_t)(dot - base));
    char further[24] = "";

    if (number > 1) {
        snprintf(further, sizeof further, "-%zu", number);
    }
    if (to_stdout()) {
        strcpy(path, "-");
    } else if (order.directory != NULL) {
        snprintf(path, PATH_MAX, "%s/%.*s%s.csv", order.directory, length, base, further);
    } else {
        snprintf(path, PATH_MAX, "%.*s%.*s%s.csv", (int)(base - file), file, length, base, further);
    }
    if (strcmp(path, file) == 0) {
        strcpy(strrchr(path, '.'), "-log.csv");
    }
}

static void write_rows(const dump_t *dump, FILE *out)
{
    for (size_t i = 0; i < dump->count; i++) {
        if (dump->rows[i] != NULL) {
            fprintf(out, "%s\n", dump->rows[i]);
        }
    }
}

/* Whether the file has this dump already, and nothing else. */
static bool has_it(const char *path, const dump_t *dump)
{
    char *text = NULL;
    size_t length = 0, at = 0;
    FILE *memory = open_memstream(&text, &length), *file = fopen(path, "r");
    int c = EOF;

    if (memory == NULL) {
        abort();
    }
    write_rows(dump, memory);
    fclose(memory);
    while (file != NULL && (c = fgetc(file)) != EOF && at < length && c == (unsigned char)text[at]) {
        at++;
    }
    free(text);
    return file != NULL && fclose(file) == 0 && c == EOF && at == length;
}

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada log: %s: %s\n", subject, what);
    return false;
}

/* One dump, and where it goes. */
typedef struct {
    const dump_t *dump;
    char path[PATH_MAX];
} planned_t;

static planned_t *planned;
static size_t planned_count;

static void plan(const source_t *source)
{
    for (size_t i = 0; i < source->harvest.count; i++) {
        const dump_t *dump = &source->harvest.dumps[i];

        if (!has_row(dump, 0)) {
            fprintf(stderr, "%s, dump %zu: the row with the titles is missing: not written\n", source->file,
                    i + 1);
        } else if (records(dump) == 0) {
            fprintf(stderr, "%s, dump %zu: %s: not written\n", source->file, i + 1,
                    is_empty(dump) ? "the log is empty" : "none of its records came");
        } else {
            planned = resized(planned, (planned_count + 1) * sizeof *planned);
            planned[planned_count].dump = dump;
            name_output(planned[planned_count++].path, source->file, i + 1);
        }
    }
}

/* What another flight left is never replaced unasked, and what is read here never. */
static bool is_free(size_t number)
{
    const char *path = planned[number].path;

    for (int i = 0; i < order.count; i++) {
        if (output_same(path, order.files[i])) {
            return complain("is read here; -o DIR writes elsewhere", path);
        }
    }
    for (size_t i = 0; i < number; i++) {
        if (output_same(path, planned[i].path)) {
            return complain(to_stdout()
                                ? "several dumps do not go to stdout together"
                                : "two dumps would have this name; give each FILE an -o DIR of its own",
                            path);
        }
    }
    return order.force || to_stdout() || access(path, F_OK) != 0 || has_it(path, planned[number].dump) ||
           complain("is there already, and is another log; -o DIR writes elsewhere, --force overwrites it",
                    path);
}

static bool all_free(void)
{
    bool fine = true;

    for (size_t i = 0; i < planned_count; i++) {
        fine = is_free(i) && fine;
    }
    return fine;
}

static bool write_dump(const planned_t *one)
{
    output_t output = {.path = one->path};
    const bool there = !to_stdout() && has_it(one->path, one->dump);

    if (!there && !output_open(&output)) {
        return false;
    }
    if (!there) {
        write_rows(one->dump, output.file);
    }
    if (!output_close(&output)) {
        return false;
    }
    if (!to_stdout()) {
        printf("%s: %zu rows\n", one->path, records(one->dump));
    }
    return true;
}

static void release(harvest_t *harvest)
{
    for (size_t i = 0; i < harvest->count; i++) {
        for (size_t row = 0; row < harvest->dumps[i].count; row++) {
            free(harvest->dumps[i].rows[row]);
        }
        free(harvest->dumps[i].rows);
    }
    free(harvest->dumps);
}

static int worse(int one, int other)
{
    return one > other ? one : other;
}

/* 2: there is nothing to write. */
static int read_source(source_t *source)
{
    FILE *in = input_open(source->file);
    const size_t before = planned_count;

    if (in == NULL) {
        (void)complain(strerror(errno), source->file);
        return 2;
    }
    read_file(in, &source->harvest);
    fclose(in);
    if (source->harvest.count == 0) {
        (void)complain("no row of a #LOG dump in it", source->file);
        return 2;
    }
    plan(source);
    return planned_count > before ? 0 : 2;
}

/* Everything is read and named before anything is written. */
static int convert(source_t *sources)
{
    int status = 0;

    for (int i = 0; i < order.count; i++) {
        sources[i].file = order.files[i];
        status = worse(status, read_source(&sources[i]));
    }
    if (!all_free()) {
        return 2;
    }
    for (size_t i = 0; i < planned_count; i++) {
        if (!write_dump(&planned[i])) {
            return 2;
        }
    }
    for (int i = 0; i < order.count; i++) {
        status = worse(status, whole(sources[i].file, &sources[i].harvest) ? 0 : 1);
    }
    return status;
}

static int run(void)
{
    source_t *sources = calloc((size_t)order.count, sizeof *sources);
    int status;

    if (sources == NULL) {
        abort();
    }
    status = convert(sources);
    for (int i = 0; i < order.count; i++) {
        release(&sources[i].harvest);
    }
    free(sources);
    free(planned);
    return status;
}

int command_log(int argc, char **argv)
{
    static const struct option long_options[] = {
        {"help", no_argument, NULL, 'h'}, {"force", no_argument, NULL, 'f'}, {NULL, 0, NULL, 0}};
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "o:h", long_options, NULL)) != -1) {
        switch (option) {
        case 'h':
            fputs(usage, stdout);
            return 0;
        case 'f':
            order.force = true;
            break;
        case 'o':
            order.directory = optarg;
            break;
        default:
            return 2;
        }
    }
    if (optind == argc) {
        fputs("plomada log: a FILE is needed; `plomada log --help` tells more.\n", stderr);
        return 2;
    }
    order.files = argv + optind;
    order.count = argc - optind;
    return run();
}
