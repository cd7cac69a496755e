#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "control/altitude.h"
#include "scanner.h"
#include "scip.h"
#include "drivers/scip_layout.h"
#include "scip_reader.h"

#define STEPS (SCIP_STEP_MAX + 1U)
#define SCANS_MIN 10
#define SCANS_MAX 500
#define GOOD_PART 0.9   /* of the scans, at each step */
#define STABLE_MM 40.0  /* between the quartiles of a step's distances */
#define FRONT_REACH 60U /* steps to either side of the front that can look at the front mirror */
#define MARGIN 5U
#define RUN_MIN (2U * MARGIN + 1U)
#define LIVE_S 4.0
#define LIVE_PATIENCE_S 30.0

static const char usage[] =
    "usage: plomada scip mirrors FILE|DEVICE --height M [--tolerance MM]\n\n"
    "Finds the steps that look at each mirror, from a recording or from a scanner on a serial port, with the "
    "vehicle level\n"
    "and its landing gear M metres above a flat floor (0..3). A step looks at a mirror when\n"
    "  - at least 10 scans hold it, and 90 % of them with a good distance,\n"
    "  - its distances are stable: at most 40 mm between their quartiles,\n"
    "  - their median, times the cosine of the step's angle to the mirror's axis, is within MM (default 40) "
    "of\n"
    "    the mirror's d + height + l: as delivered, of the parameters DF and LF, D1 and L1 (aft), D2 and L2 "
    "(fore).\n"
    "Steps up to 60 from the front (384) can only look at the front mirror, smaller ones at the aft, larger "
    "ones at the\n"
    "fore. The longest row of neighbouring steps is the mirror, its window 5 steps inside either end.\n\n"
    "Prints a table, and the commands that tell the firmware.\n"
    "Exit status: 0 every mirror of a LAYOUT was found, 1 not, 2 usage or unreadable input.\n";

enum { OPT_HEIGHT = 1, OPT_TOLERANCE, OPT_HELP };

static const struct option long_options[] = {
    {"height", required_argument, NULL, OPT_HEIGHT},
    {"tolerance", required_argument, NULL, OPT_TOLERANCE},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

typedef struct {
    const char *source;
    double height_m, tolerance_mm;
    bool help;
} order_t;

/* All good distances of each step. */
typedef struct {
    unsigned scans[STEPS]; /* that hold the step */
    unsigned good[STEPS];
    uint16_t distance_mm[STEPS][SCANS_MAX];
} survey_t;

/* A row of neighbouring steps that look at one mirror. */
typedef struct {
    unsigned first, last, steps; /* steps 0: none */
    double median_mm;
} row_t;

static const char *const mirror_names[] = {"front", "fore", "aft"};
/* In the order of their steps. */
static const mirror_t ascending[] = {MIRROR_AFT, MIRROR_FRONT, MIRROR_FORE};
_Static_assert(sizeof mirror_names / sizeof mirror_names[0] == MIRROR_COUNT, "every mirror has a name");
_Static_assert(sizeof ascending / sizeof ascending[0] == MIRROR_COUNT, "and a place in the order");

/* ---- the survey ---- */

static void add_scan(void *context, const scip_scan_t *scan)
{
    survey_t *survey = context;
    const unsigned furthest_mm = scan->characters == 3 ? SCIP_DMAX_MM : SCIP_FAR_2_MM - 1U;

    if (scan->cluster != 1) {
        return;
    }
    for (uint16_t i = 0; i < scan->points; i++) {
        const unsigned step = scan->first_step + i;

        if (survey->scans[step] == SCANS_MAX) {
            continue;
        }
        survey->scans[step]++;
        if (scan->distance_mm[i] >= SCIP_CODE_LIMIT_MM && scan->distance_mm[i] <= furthest_mm) {
            survey->distance_mm[step][survey->good[step]++] = scan->distance_mm[i];
        }
    }
}

static int by_distance(const void *a, const void *b)
{
    return *(const uint16_t *)a - *(const uint16_t *)b;
}

static bool stable_median(survey_t *survey, unsigned step, double *median_mm)
{
    const unsigned count = survey->good[step];
    uint16_t *sorted = survey->distance_mm[step];

    if (survey->scans[step] < SCANS_MIN || count < GOOD_PART * survey->scans[step]) {
        return false;
    }
    qsort(sorted, count, sizeof sorted[0], by_distance);
    *median_mm = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
    return sorted[(3 * count - 1) / 4] - sorted[count / 4] <= STABLE_MM;
}

/* ---- mirrors ---- */

static mirror_t mirror_at(unsigned step)
{
    if (step + FRONT_REACH < SCIP_STEP_FRONT) {
        return MIRROR_AFT;
    }
    return step > SCIP_STEP_FRONT + FRONT_REACH ? MIRROR_FORE : MIRROR_FRONT;
}

/* The rays of a mirror are a fan: a ray that is off the mirror's axis goes on as far off the plumb line, and
 * is longer by 1 / cos. At 3 m that is 44 mm at the rim. The axes: 90 degrees to either side of the front on
 * the bracket of three mirrors, 42.5 degrees on that of two beams. */
static double plumb_part(unsigned step)
{
    static const double axes_deg[] = {-90.0, -42.5, 0.0, 42.5, 90.0};
    const double step_deg = 360.0 / 1024.0, at_deg = ((double)step - (double)SCIP_STEP_FRONT) * step_deg;
    double aside_deg = 180.0;

    for (size_t i = 0; i < sizeof axes_deg / sizeof axes_deg[0]; i++) {
        aside_deg = fmin(aside_deg, fabs(at_deg - axes_deg[i]));
    }
    return cos(aside_deg * (M_PI / 180.0));
}

static double expected_mm(mirror_t mirror, const order_t *order)
{
    const altitude_geometry_t geometry = altitude_geometry_default();
    const mirror_geometry_t *place = &geometry.mirror[mirror];

    return (double)place->distance_mm + 1000.0 * order->height_m + (double)place->leg_mm;
}

static void keep_longest(row_t *longest, const row_t *row)
{
    if (row->steps > longest->steps) {
        *longest = *row;
        longest->median_mm /= row->steps;
    }
}

static void find_rows(survey_t *survey, const order_t *order, row_t rows[MIRROR_COUNT])
{
    row_t row = {0, 0, 0, 0.0};
    double median_mm;

    for (unsigned step = 0; step < STEPS; step++) {
        const mirror_t mirror = mirror_at(step);
        const bool stable = stable_median(survey, step, &median_mm);
        const double plumb_mm = stable ? median_mm * plumb_part(step) : 0.0;
        const bool fits = stable && fabs(plumb_mm - expected_mm(mirror, order)) <= order->tolerance_mm;

        if (!fits || (row.steps > 0 && mirror != mirror_at(row.first))) {
            row.steps = 0;
        }
        if (fits) {
            row = row.steps == 0 ? (row_t){step, step, 1, plumb_mm}
                                 : (row_t){row.first, step, row.steps + 1, row.median_mm + plumb_mm};
            keep_longest(&rows[mirror], &row);
        }
    }
}

static bool found(const row_t *row)
{
    return row->steps >= RUN_MIN;
}

static void print_table(const row_t rows[MIRROR_COUNT], const order_t *order)
{
    printf("%-7s %-9s %-6s %-10s %-12s %s\n", "mirror", "steps", "count", "median_mm", "expected_mm",
           "window");
    for (int i = 0; i < MIRROR_COUNT; i++) {
        const mirror_t mirror = ascending[i];
        const row_t *row = &rows[mirror];

        if (found(row)) {
            printf("%-7s %3u..%-4u %-6u %-10.1f %-12.1f %u..%u\n", mirror_names[mirror], row->first,
                   row->last, row->steps, row->median_mm, expected_mm(mirror, order), row->first + MARGIN,
                   row->last - MARGIN);
        } else {
            printf("%-7s %-9s %-6s %-10s %-12.1f -\n", mirror_names[mirror], "-", "-", "-",
                   expected_mm(mirror, order));
        }
    }
}

/* LAYOUT with these mirrors; LAYOUT_COUNT: none. */
static unsigned layout_of(const row_t rows[MIRROR_COUNT])
{
    const bool front = found(&rows[MIRROR_FRONT]), fore = found(&rows[MIRROR_FORE]),
               aft = found(&rows[MIRROR_AFT]);

    if (fore && aft) {
        return front ? LAYOUT_THREE : LAYOUT_TWO;
    }
    return front && !fore && !aft ? LAYOUT_FRONT : LAYOUT_COUNT;
}

static bool print_setting(parameter_id_t id, unsigned value)
{
    const parameter_row_t *row = &parameter_table[id];
    const bool fits = value >= row->minimum && value <= row->maximum;

    if (fits) {
        printf("#%s %u\n", row->name, value);
    } else {
        printf("%s would be %u: the firmware takes %g to %g\n", row->name, value, (double)row->minimum,
               (double)row->maximum);
    }
    return fits;
}

/* One reach for all mirrors: that of the narrowest, so that no window leaves its mirror. */
static bool print_steps(const row_t rows[MIRROR_COUNT])
{
    static const parameter_id_t middles[] = {
        [MIRROR_FRONT] = PARAMETER_SF, [MIRROR_FORE] = PARAMETER_S2, [MIRROR_AFT] = PARAMETER_S1};
    unsigned reach = (unsigned)parameter_table[PARAMETER_SW].maximum;
    bool fit = true;

    for (int i = 0; i < MIRROR_COUNT; i++) {
        const row_t *row = &rows[ascending[i]];

        if (found(row)) {
            const unsigned half = (row->steps - 1) / 2 - MARGIN;

            reach = half < reach ? half : reach;
            fit = print_setting(middles[ascending[i]], (row->first + row->last) / 2) && fit;
        }
    }
    return print_setting(PARAMETER_SW, reach) && fit;
}

static bool print_layout(const row_t rows[MIRROR_COUNT])
{
    const unsigned layout = layout_of(rows);

    if (layout == LAYOUT_COUNT) {
        printf("\nno LAYOUT has these mirrors\n");
        return false;
    }
    printf("\n#LAYOUT %s\n", parameter_table[PARAMETER_LAYOUT].choices[layout]);
    return print_steps(rows);
}

/* ---- input ---- */

static void feed(void *context, bool from_sensor, long long t_us, const unsigned char *octets, size_t count)
{
    (void)t_us;
    if (from_sensor) {
        scip_reader_feed(context, octets, count);
    }
}

static const char *read_device(scip_reader_t *reader, const char *device)
{
    const scanner_config_t config = {device, 115200, SCIP_STEP_FIRST, SCIP_STEP_LAST, feed, reader};
    const char *error = scanner_open(&config);

    if (error != NULL) {
        return error;
    }
    if (scanner_start(LIVE_PATIENCE_S)) {
        scanner_run(LIVE_S);
        scanner_stop();
    }
    scanner_close();
    return NULL;
}

static const char *read_source(scip_reader_t *reader, const char *source)
{
    struct stat status;

    if (stat(source, &status) == 0 && S_ISCHR(status.st_mode)) {
        return read_device(reader, source);
    }
    return scip_reader_file(reader, source);
}

static int run(const order_t *order)
{
    static scip_reader_t reader;
    static survey_t survey;
    row_t rows[MIRROR_COUNT] = {{0, 0, 0, 0.0}};
    const char *error;

    scip_reader_init(&reader, add_scan, &survey);
    error = read_source(&reader, order->source);
    if (error != NULL) {
        fprintf(stderr, "plomada scip mirrors: %s: %s\n", order->source, error);
        return 2;
    }
    scip_reader_print(&reader, stderr);
    find_rows(&survey, order, rows);
    print_table(rows, order);
    return print_layout(rows) ? 0 : 1;
}

/* ---- arguments ---- */

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada scip mirrors: %s: %s\n", subject, what);
    return false;
}

static bool read_number(const char *text, double largest, double *value)
{
    char *end;

    *value = strtod(text, &end);
    return *text != '\0' && *end == '\0' && *value >= 0.0 && *value <= largest;
}

static bool read_option(order_t *order, int option, const char *argument)
{
    switch (option) {
    case OPT_HEIGHT:
        return read_number(argument, 3.0, &order->height_m) || complain("not a height, 0..3 m", argument);
    case OPT_TOLERANCE:
        return read_number(argument, 1000.0, &order->tolerance_mm) ||
               complain("not a tolerance, 0..1000 mm", argument);
    case OPT_HELP:
        order->help = true;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(order_t *order, int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (!read_option(order, option, optarg)) {
            return false;
        }
    }
    if (order->help) {
        return true;
    }
    if (optind + 1 != argc) {
        return complain("one FILE or DEVICE is needed", "mirrors");
    }
    order->source = argv[optind];
    return !isnan(order->height_m) || complain("is needed", "--height");
}

int scip_mirrors(int argc, char **argv)
{
    order_t order = {.height_m = (double)NAN, .tolerance_mm = 40.0};

    if (!read_arguments(&order, argc, argv)) {
        fprintf(stderr, "`plomada scip mirrors --help` tells more.\n");
        return 2;
    }
    if (order.help) {
        fputs(usage, stdout);
        return 0;
    }
    return run(&order);
}
