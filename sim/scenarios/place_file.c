#include "sim/scenarios/place_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_N 200
#define WORDS_N 16
#define NUMBERS_N 8
#define NAMES_N 2
#define TURNED "turned"
#define OF "of"
#define DEG (M_PI / 180.0)
#define BOARD_M 0.03 /* chosen: of a table */
#define LEG_M 0.04   /* chosen */
#define WALL_M 0.1   /* chosen: its thickness */
#define STEPS_MAX 40.0
#define BARS_FROM_M 0.5         /* as seed_course.c has them: the vehicle takes off from an even spot */
#define TURN_RADPS (45.0 * DEG) /* chosen: a pilot's calm turn */

/* A line, taken apart. */
typedef struct {
    place_file_t *file;
    const char *verb;
    const char *name[NAMES_N];
    double value[NUMBERS_N];
    double turned_rad;
    bool is_turned;
    surface_t surface; /* of the thing; without a name: plain */
} order_t;

typedef struct {
    const char *name;
    double least, most;
} argument_t;

typedef struct {
    const char *name;
    argument_t arguments[NUMBERS_N]; /* no name ends */
    bool (*obey)(const order_t *order);
    bool turns, has_surface;
    int names; /* come before the numbers */
} verb_t;

static bool put(const order_t *order, place_block_t block)
{
    block.surface = order->surface;
    if (place_add(&order->file->place, &block)) {
        return true;
    }
    snprintf(order->file->message, sizeof order->file->message, "%s: more than %d blocks", order->verb,
             PLACE_BLOCKS_MAX);
    return false;
}

/* The block of a line that begins with X Y LENGTH WIDTH. */
static place_block_t block_of(const order_t *order, double near_m, double far_m)
{
    return (place_block_t){.x_m = order->value[0],
                           .y_m = order->value[1],
                           .heading_rad = order->turned_rad,
                           .length_m = order->value[2],
                           .width_m = order->value[3],
                           .near_top_m = near_m,
                           .far_top_m = far_m};
}

static bool obey_rough(const order_t *order)
{
    order->file->place.rough = (place_rough_t){1e-3 * order->value[0], order->value[1]};
    return true;
}

static bool obey_bars(const order_t *order)
{
    order->file->place.bars = (place_bars_t){.height_m = 1e-3 * order->value[0],
                                             .period_m = order->value[1],
                                             .share = order->value[2],
                                             .from_m = BARS_FROM_M};
    return true;
}

static bool obey_block(const order_t *order)
{
    return put(order, block_of(order, order->value[4], order->value[4]));
}

static bool obey_ramp(const order_t *order)
{
    return put(order, block_of(order, order->value[4], order->value[5]));
}

/* A block whose middle stands `along` and `across` of the thing's own X Y. */
static place_block_t shifted(const order_t *order, place_block_t block, double along_m, double across_m)
{
    const double c = cos(order->turned_rad), s = sin(order->turned_rad);

    block.x_m = order->value[0] + c * along_m - s * across_m;
    block.y_m = order->value[1] + s * along_m + c * across_m;
    return block;
}

static bool obey_stairs(const order_t *order)
{
    const double run_m = order->value[3], rise_m = order->value[4];
    bool fits = true;

    for (int i = 0; fits && i < (int)order->value[2]; i++) {
        const place_block_t step = {.heading_rad = order->turned_rad,
                                    .length_m = run_m,
                                    .width_m = order->value[5],
                                    .near_top_m = (i + 1) * rise_m,
                                    .far_top_m = (i + 1) * rise_m};
        fits = put(order, shifted(order, step, (i + 0.5) * run_m, 0.0));
    }
    return fits;
}

static bool obey_table(const order_t *order)
{
    place_block_t board = block_of(order, order->value[4], order->value[4]);
    const double along_m = 0.5 * (order->value[2] - LEG_M), across_m = 0.5 * (order->value[3] - LEG_M);
    bool fits;

    board.bottom_m = fmax(order->value[4] - BOARD_M, 0.0);
    fits = put(order, board);
    for (int i = 0; fits && i < 4; i++) {
        const place_block_t leg = {.heading_rad = order->turned_rad,
                                   .length_m = LEG_M,
                                   .width_m = LEG_M,
                                   .near_top_m = board.bottom_m,
                                   .far_top_m = board.bottom_m};
        fits = put(order, shifted(order, leg, i & 1 ? along_m : -along_m, i & 2 ? across_m : -across_m));
    }
    return fits;
}

static bool obey_post(const order_t *order)
{
    return put(order, (place_block_t){.x_m = order->value[0],
                                      .y_m = order->value[1],
                                      .heading_rad = order->turned_rad,
                                      .length_m = order->value[2],
                                      .width_m = order->value[2],
                                      .near_top_m = order->value[3],
                                      .far_top_m = order->value[3]});
}

static bool obey_wall(const order_t *order)
{
    const double dx = order->value[2] - order->value[0], dy = order->value[3] - order->value[1];

    return put(order, (place_block_t){.x_m = order->value[0] + 0.5 * dx,
                                      .y_m = order->value[1] + 0.5 * dy,
                                      .heading_rad = atan2(dy, dx),
                                      .length_m = hypot(dx, dy),
                                      .width_m = WALL_M,
                                      .near_top_m = order->value[4],
                                      .far_top_m = order->value[4]});
}

static bool obey_lift(const order_t *order)
{
    place_block_t lift = block_of(order, 0.0, 0.0);

    lift.bottom_m = -order->value[4]; /* what carries it comes up with it */
    lift.travel_m = order->value[4];
    lift.travel_mps = order->value[5];
    lift.travel_start_s = order->value[6];
    lift.stay_s = order->value[7];
    return put(order, lift);
}

static bool obey_foot(const order_t *order)
{
    place_block_t foot = block_of(order, order->value[4], order->value[4]);

    foot.there = (span_t){order->value[5], order->value[6]};
    return put(order, foot);
}

static bool obey_go(const order_t *order)
{
    course_t *course = &order->file->course;

    if (course->count == COURSE_LEGS_MAX) {
        snprintf(order->file->message, sizeof order->file->message, "go: more than %d legs", COURSE_LEGS_MAX);
        return false;
    }
    course->legs[course->count++] = (course_leg_t){.start_s = order->value[0],
                                                   .x_m = order->value[1],
                                                   .y_m = order->value[2],
                                                   .speed_mps = order->value[3],
                                                   .heading_rad = order->turned_rad,
                                                   .turn_radps = order->is_turned ? TURN_RADPS : 0.0};
    return true;
}

/* The file's own surfaces win. */
static const surface_t *surface_named(const place_file_t *file, const char *name)
{
    for (int i = 0; i < file->surface_count; i++) {
        if (strcmp(file->surfaces[i].name, name) == 0) {
            return &file->surfaces[i];
        }
    }
    return surface_find(name);
}

static bool read_surface(const order_t *order, const char *name, surface_t *surface)
{
    const surface_t *found = surface_named(order->file, name);

    if (found == NULL) {
        snprintf(order->file->message, sizeof order->file->message, "%.40s: no surface %.40s", order->verb,
                 name);
        return false;
    }
    *surface = *found;
    return true;
}

static bool obey_floor(const order_t *order)
{
    order->file->place.tile_m = 0.0;
    return read_surface(order, order->name[0], &order->file->place.floor[0]);
}

static bool obey_carried(const order_t *order)
{
    order->file->course.carried = true;
    return true;
}

static bool obey_tiles(const order_t *order)
{
    order->file->place.tile_m = order->value[0];
    return read_surface(order, order->name[0], &order->file->place.floor[0]) &&
           read_surface(order, order->name[1], &order->file->place.floor[1]);
}

static bool obey_sun(const order_t *order)
{
    const place_sun_t sun = {.x_m = order->value[0],
                             .y_m = order->value[1],
                             .heading_rad = order->turned_rad,
                             .length_m = order->value[2],
                             .width_m = order->value[3],
                             .strength = order->value[4]};

    if (place_shine(&order->file->place, &sun)) {
        return true;
    }
    snprintf(order->file->message, sizeof order->file->message, "sun: more than %d", PLACE_SUNS_MAX);
    return false;
}

static bool obey_surface(const order_t *order)
{
    place_file_t *file = order->file;
    surface_t surface = {.reflectance = order->value[0],
                         .gloss = order->value[1],
                         .clear = order->value[2],
                         .offset_mm = order->value[3],
                         .depth_mm = order->value[4]};

    if (strlen(order->name[0]) >= SURFACE_NAME_N || file->surface_count == PLACE_FILE_SURFACES_MAX ||
        surface.reflectance + surface.gloss + surface.clear > 1.0 ||
        strcmp(order->name[0], surface_plain.name) == 0) {
        snprintf(file->message, sizeof file->message,
                 "surface: at most %d, names shorter than %d and not plain, light shared out at most once",
                 PLACE_FILE_SURFACES_MAX, SURFACE_NAME_N);
        return false;
    }
    snprintf(surface.name, sizeof surface.name, "%s", order->name[0]);
    file->surfaces[file->surface_count++] = surface;
    return true;
}

#define X_Y \
    {"X", -100, 100}, \
    { \
        "Y", -100, 100 \
    }
#define SIZE(name) \
    { \
        name, 0.001, 100 \
    }
#define SECONDS(name) \
    { \
        name, 0, 100000 \
    }

static const verb_t verbs[] = {
    {"rough", {{"RMS_MM", 0, 1000}, {"CORRELATION_M", 0.001, 100}}, obey_rough, false, false, 0},
    {"bars", {{"HEIGHT_MM", -1000, 1000}, SIZE("PERIOD"), {"SHARE", 0, 1}}, obey_bars, false, false, 0},
    {"block", {X_Y, SIZE("LENGTH"), SIZE("WIDTH"), SIZE("HEIGHT")}, obey_block, true, true, 0},
    {"ramp",
     {X_Y, SIZE("LENGTH"), SIZE("WIDTH"), {"NEAR", 0, 100}, {"FAR", 0, 100}},
     obey_ramp,
     true,
     true,
     0},
    {"stairs",
     {X_Y, {"STEPS", 1, STEPS_MAX}, SIZE("RUN"), SIZE("RISE"), SIZE("WIDTH")},
     obey_stairs,
     true,
     true,
     0},
    {"table", {X_Y, SIZE("LENGTH"), SIZE("WIDTH"), SIZE("HEIGHT")}, obey_table, true, true, 0},
    {"post", {X_Y, SIZE("THICKNESS"), SIZE("HEIGHT")}, obey_post, true, true, 0},
    {"wall",
     {{"X1", -100, 100}, {"Y1", -100, 100}, {"X2", -100, 100}, {"Y2", -100, 100}, SIZE("HEIGHT")},
     obey_wall,
     false,
     true,
     0},
    {"lift",
     {X_Y,
      SIZE("LENGTH"),
      SIZE("WIDTH"),
      SIZE("TRAVEL"),
      {"SPEED", 0.001, 10},
      SECONDS("START"),
      SECONDS("STAY")},
     obey_lift,
     true,
     true,
     0},
    {"foot",
     {X_Y, SIZE("LENGTH"), SIZE("WIDTH"), SIZE("HEIGHT"), SECONDS("START"), SECONDS("SECONDS")},
     obey_foot,
     true,
     true,
     0},
    {"go", {SECONDS("START"), X_Y, {"SPEED", 0.01, 10}}, obey_go, true, false, 0},
    {"carried", {{NULL, 0, 0}}, obey_carried, false, false, 0},
    {"floor", {{NULL, 0, 0}}, obey_floor, false, false, 1},
    {"tiles", {SIZE("SIZE")}, obey_tiles, false, false, 2},
    {"sun", {X_Y, SIZE("LENGTH"), SIZE("WIDTH"), {"STRENGTH", 0, 1}}, obey_sun, true, false, 0},
    {"surface",
     {{"REFLECTANCE", 0, 1},
      {"GLOSS", 0, 1},
      {"CLEAR", 0, 1},
      {"OFFSET_MM", -1000, 1000},
      {"DEPTH_MM", 0, 1000}},
     obey_surface,
     false,
     false,
     1},
};
#define VERB_COUNT (sizeof verbs / sizeof verbs[0])

static bool fault(place_file_t *file, const char *verb, const char *subject, const char *what)
{
    snprintf(file->message, sizeof file->message, "%.40s: %.40s: %s", verb, subject, what);
    return false;
}

static bool read_number(place_file_t *file, const char *verb, const argument_t *argument, const char *word,
                        double *value)
{
    char *end;
    char limits[64];

    *value = strtod(word, &end);
    if (*word == '\0' || *end != '\0') {
        return fault(file, verb, argument->name, "not a number");
    }
    snprintf(limits, sizeof limits, "out of range %g..%g", argument->least, argument->most);
    return (*value >= argument->least && *value <= argument->most) ||
           fault(file, verb, argument->name, limits);
}

static const verb_t *find(const char *name)
{
    for (size_t i = 0; i < VERB_COUNT; i++) {
        if (strcmp(verbs[i].name, name) == 0) {
            return &verbs[i];
        }
    }
    return NULL;
}

static int arguments_of(const verb_t *verb)
{
    int count = 0;

    while (count < NUMBERS_N && verb->arguments[count].name != NULL) {
        count++;
    }
    return count;
}

static bool read_turned(order_t *order, const verb_t *verb, const char *word)
{
    static const argument_t degrees = {TURNED, -360, 360};
    double turned_deg;

    if (word == NULL) {
        return fault(order->file, verb->name, TURNED, "wants one angle, in degrees");
    }
    if (!read_number(order->file, verb->name, &degrees, word, &turned_deg)) {
        return false;
    }
    order->turned_rad = turned_deg * DEG;
    order->is_turned = true;
    return true;
}

/* What may stand behind the numbers, once each, in any order. */
static bool read_tail(order_t *order, const verb_t *verb, char *const *words, int count)
{
    for (int i = 0; i < count; i += 2) {
        const char *value = i + 1 < count ? words[i + 1] : NULL;
        const bool turned = verb->turns && !order->is_turned && strcmp(words[i], TURNED) == 0;
        const bool of = verb->has_surface && order->surface.name[0] == '\0' && strcmp(words[i], OF) == 0;

        if (!turned && !of) {
            return fault(order->file, verb->name, words[i], "one word too many");
        }
        if (of && value == NULL) {
            return fault(order->file, verb->name, OF, "wants a surface");
        }
        if (turned ? !read_turned(order, verb, value) : !read_surface(order, value, &order->surface)) {
            return false;
        }
    }
    return true;
}

static bool read_names(order_t *order, const verb_t *verb, char *const *words, int count)
{
    for (int i = 0; i < verb->names; i++) {
        if (i >= count) {
            return fault(order->file, verb->name, "NAME", "missing");
        }
        order->name[i] = words[i];
    }
    return true;
}

static bool read_numbers(order_t *order, const verb_t *verb, char *const *words, int count)
{
    for (int i = 0; i < arguments_of(verb); i++) {
        if (i >= count) {
            return fault(order->file, verb->name, verb->arguments[i].name, "missing");
        }
        if (!read_number(order->file, verb->name, &verb->arguments[i], words[i], &order->value[i])) {
            return false;
        }
    }
    return true;
}

static bool read_words(place_file_t *file, char *const *words, int count)
{
    const verb_t *verb = find(words[0]);
    order_t order = {.file = file, .verb = words[0]};

    if (verb == NULL) {
        snprintf(file->message, sizeof file->message, "%.40s: no such word", words[0]);
        return false;
    }
    const int numbers = 1 + verb->names, tail = numbers + arguments_of(verb);
    return read_names(&order, verb, words + 1, count - 1) &&
           read_numbers(&order, verb, words + numbers, count - numbers) &&
           read_tail(&order, verb, words + tail, count - tail) && verb->obey(&order);
}

static bool read_line(place_file_t *file, char *line)
{
    char *words[WORDS_N];
    int count = 0;

    line[strcspn(line, "#")] = '\0';
    for (char *word = strtok(line, " \t\r"); word != NULL; word = strtok(NULL, " \t\r")) {
        if (count == WORDS_N) {
            return fault(file, words[0], word, "one word too many");
        }
        words[count++] = word;
    }
    return count == 0 || read_words(file, words, count);
}

bool place_file_read(place_file_t *file, const char *text, unsigned long seed)
{
    char line[LINE_N + 1];

    memset(file, 0, sizeof *file);
    place_init(&file->place);
    while (*text != '\0') {
        const size_t length = strcspn(text, "\n");

        file->line++;
        if (length > LINE_N) {
            snprintf(file->message, sizeof file->message, "longer than %d characters", LINE_N);
            return false;
        }
        memcpy(line, text, length);
        line[length] = '\0';
        if (!read_line(file, line)) {
            return false;
        }
        text += length + (text[length] == '\n');
    }
    if (file->place.rough.rms_m > 0.0) {
        const place_rough_t rough = file->place.rough;

        place_roughen(&file->place, &rough, seed);
    }
    return true;
}
