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

#include "commands.h"
#include "drivers/line_sum.h"
#include "output.h"
#include "saved.h"

#define MARK "OK LOG "
#define NAMED_MAX 8 /* rows that a message names one by one */

static const char usage[] =
    "usage: plomada log FILE... [-o DIR|-]\n\n"
    "Writes the #LOG dumps in what was saved of a flight as CSV: FILE.csv, and FILE-2.csv and so on for "
    "further dumps.\n"
    "FILE is text as a terminal saved it, or a console log of XCTU (its payloads in hex); telemetry and "
    "other answers\n"
    "between the rows do not matter.\n\n"
    "  -o DIR              where to (default: beside FILE); - is stdout, for a single dump\n\n"
    "Each row is checked by its own sum. What is damaged or missing is left out and named on stderr.\n\n"
    "Exit status: 0 every dump is whole, 1 something is missing, 2 usage, no dump, or a file that cannot be "
    "read or\n"
    "written.\n";

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

/* FILE without its directory and ending, in DIR; -2 and so on for a further dump. Never FILE itself. */
static void name_output(char path[PATH_MAX], const char *file, const char *directory, size_t number)
{
    const char *slash = strrchr(file, '/'), *base = slash == NULL ? file : slash + 1,
               *dot = strrchr(base, '.');
    const int length = (int)(dot == NULL || dot == base ? strlen(base) : (size_t)(dot - base));
    char further[24] = "";

    if (number > 1) {
        snprintf(further, sizeof further, "-%zu", number);
    }
    if (directory != NULL) {
        snprintf(path, PATH_MAX, "%s/%.*s%s.csv", directory, length, base, further);
    } else {
        snprintf(path, PATH_MAX, "%.*s%.*s%s.csv", (int)(base - file), file, length, base, further);
    }
    if (strcmp(path, file) == 0) {
        strcpy(strrchr(path, '.'), "-log.csv");
    }
}

static bool write_dump(const dump_t *dump, const char *path)
{
    output_t output = {.path = path};

    if (!output_open(&output)) {
        return false;
    }
    for (size_t i = 0; i < dump->count; i++) {
        if (dump->rows[i] != NULL) {
            fprintf(output.file, "%s\n", dump->rows[i]);
        }
    }
    return output_close(&output);
}

static bool write_dumps(const char *file, const harvest_t *harvest, const char *directory)
{
    const bool to_stdout = directory != NULL && strcmp(directory, "-") == 0;

    if (to_stdout && harvest->count > 1) {
        fprintf(stderr, "plomada log: %s: %zu dumps do not go to stdout together\n", file, harvest->count);
        return false;
    }
    for (size_t i = 0; i < harvest->count; i++) {
        char path[PATH_MAX];

        name_output(path, file, directory, i + 1);
        if (!has_row(&harvest->dumps[i], 0)) {
            fprintf(stderr, "%s, dump %zu: the row with the titles is missing: not written\n", file, i + 1);
            continue;
        }
        if (!write_dump(&harvest->dumps[i], to_stdout ? "-" : path)) {
            return false;
        }
        if (!to_stdout) {
            printf("%s: %zu rows\n", path, rows_due(&harvest->dumps[i]) - 1 - missing(&harvest->dumps[i]));
        }
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

static int convert(const char *file, const char *directory)
{
    harvest_t harvest = {.dumps = NULL};
    FILE *in = fopen(file, "r");
    int status = 2;

    if (in == NULL) {
        fprintf(stderr, "plomada log: %s: %s\n", file, strerror(errno));
        return 2;
    }
    read_file(in, &harvest);
    fclose(in);
    if (harvest.count == 0) {
        fprintf(stderr, "plomada log: %s: no row of a #LOG dump in it\n", file);
    } else if (write_dumps(file, &harvest, directory)) {
        status = whole(file, &harvest) ? 0 : 1;
    }
    release(&harvest);
    return status;
}

int command_log(int argc, char **argv)
{
    static const struct option long_options[] = {{"help", no_argument, NULL, 'h'}, {NULL, 0, NULL, 0}};
    const char *directory = NULL;
    int option, status = 0;

    optind = 1;
    while ((option = getopt_long(argc, argv, "o:h", long_options, NULL)) != -1) {
        if (option == 'h') {
            fputs(usage, stdout);
            return 0;
        }
        if (option != 'o') {
            return 2;
        }
        directory = optarg;
    }
    if (optind == argc) {
        fputs("plomada log: a FILE is needed; `plomada log --help` tells more.\n", stderr);
        return 2;
    }
    for (int i = optind; i < argc; i++) {
        const int one = convert(argv[i], directory);

        status = one > status ? one : status;
    }
    return status;
}
