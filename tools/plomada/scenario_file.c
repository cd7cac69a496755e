#include "scenario_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "control/parameters.h"
#include "input.h"
#include "nearest.h"
#include "sim/scenarios/flight.h"
#include "sim/scenarios/plant.h"

#define LINE_MAX_OCTETS 256
#define WORDS_MAX \
    14 /* place lift X Y LENGTH WIDTH TRAVEL SPEED START STAY turned DEG, and two to be told of */
#define PLACE_N 16384
#define DURATION_MAX_S 7200.0          /* twice the longest flight of tools/campaign/healthy.toml */
#define BYTE_ORDER_MARK "\xEF\xBB\xBF" /* some editors begin a text with it */

static struct {
    scenario_t scenario;
    int settings, plant, later;       /* how many */
    int line;                         /* that is read; of the whole file: 0 */
    int typed_on[SCENARIO_LATER_MAX]; /* the line of each at; 0: of the scenario that it is like */
    int count;                        /* of the words of this line */
    char *word[WORDS_MAX];
    char place[PLACE_N];
    char message[240];
} reading;

static const char *told(const char *what, const char *word)
{
    snprintf(reading.message, sizeof reading.message, "%s: %s", word, what);
    return reading.message;
}

static char *kept(const char *text)
{
    char *copy = strdup(text);

    if (copy == NULL) {
        abort();
    }
    return copy;
}

static const char *read_number(const char *text, double least, double most, double *value)
{
    char *end;

    *value = strtod(text, &end);
    if (*text == '\0' || *end != '\0') {
        return told("not a number", text);
    }
    return *value >= least && *value <= most ? NULL : told("out of range", text);
}

static const char *meant(const char *what, const char *typed, const char *const words[], size_t count)
{
    const char *near = nearest(typed, words, count);

    if (near == NULL) {
        return told(what, typed);
    }
    snprintf(reading.message, sizeof reading.message, "%s: %s; did you mean %s?", typed, what, near);
    return reading.message;
}

static const char *read_like(void)
{
    const scenario_t *other = scenario_find(reading.word[1]);

    if (other == NULL) {
        return told("no such scenario, see `plomada list`", reading.word[1]);
    }
    if (reading.settings + reading.plant + reading.later > 0) {
        return "like comes before set and at";
    }
    if (other->bench) {
        return told("has no flight to be like", reading.word[1]);
    }
    const char *name = reading.scenario.name;
    const char *place = reading.scenario.place;
    reading.scenario = *other;
    reading.scenario.name = name;
    reading.scenario.place = place != NULL ? place : other->place;
    reading.scenario.fate = FATE_EITHER;
    reading.scenario.expectation_count = 0;
    while (reading.settings < SCENARIO_SETTINGS_MAX && other->settings[reading.settings] != NULL) {
        reading.settings++;
    }
    while (reading.later < SCENARIO_LATER_MAX && other->later[reading.later].name != NULL) {
        reading.later++;
    }
    return NULL;
}

static const char *read_name(void)
{
    reading.scenario.name = kept(reading.word[1]);
    return NULL;
}

/* In the place of one of that name, or behind the others. */
static const char *put(const char **list, int *count, int room, const char *setting)
{
    const size_t name = strcspn(setting, " ") + 1U;
    int at = 0;

    while (at < *count && strncmp(list[at], setting, name) != 0) {
        at++;
    }
    if (at == room - 1) {
        return "too many";
    }
    list[at] = setting;
    *count += at == *count;
    return NULL;
}

static const char *read_set(void)
{
    const char *error = flight_check(reading.word[1], reading.word[2]);
    char setting[LINE_MAX_OCTETS];

    if (error == NULL && strcasecmp(reading.word[1], "SETR") == 0) {
        error = "is no setting: reference, or at";
    }
    if (error != NULL) {
        return told(error, reading.word[1]);
    }
    snprintf(setting, sizeof setting, "%s %s", reading.word[1], reading.word[2]);
    return strncmp(setting, "plant.", 6) == 0
               ? put(reading.scenario.plant, &reading.plant, SCENARIO_PLANT_MAX, kept(setting))
               : put(reading.scenario.settings, &reading.settings, SCENARIO_SETTINGS_MAX, kept(setting));
}

/* The radio takes its time, and nobody types before the scenario begins. */
static const char *too_early(const later_line_t *line, const char *value)
{
    const double soonest_s = flight_soonest_s(&reading.scenario, reading.word[2], value);

    if (line->t_s >= soonest_s) {
        return NULL;
    }
    snprintf(reading.message, sizeof reading.message, "%s: too early, that line takes until %.3f",
             reading.word[1], ceil(fmax(soonest_s, 0.0) * 1e3) * 1e-3);
    return reading.message;
}

/* Those of the firmware's #HELP; a test asks it. */
static const char *const verbs[] = {"SETR",     "ARM",  "STOP",      "LAND", "GET",   "SAVE",    "LOAD",
                                    "DEFAULTS", "LOG",  "CALIBRATE", "RC",   "VOLTS", "LASER",   "IMU",
                                    "MIRRORS",  "PERF", "STREAM",    "HANG", "PING",  "VERSION", "HELP"};
#define VERB_COUNT (sizeof verbs / sizeof verbs[0])

static const char *check_verb(const char *name)
{
    const char *names[VERB_COUNT + PARAMETER_COUNT];
    size_t count = 0;

    for (; count < VERB_COUNT; count++) {
        if (strcasecmp(verbs[count], name) == 0) {
            return NULL;
        }
        names[count] = verbs[count];
    }
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        names[count++] = parameter_table[i].name;
    }
    return meant("no such command", name, names, count);
}

static const char *read_at(void)
{
    later_line_t *line = &reading.scenario.later[reading.later];
    char value[LINE_MAX_OCTETS] = "";
    const char *error = read_number(reading.word[1], 0.0, DURATION_MAX_S, &line->t_s);

    for (int i = 3; i < reading.count; i++) {
        snprintf(value + strlen(value), sizeof value - strlen(value), "%s%s", i == 3 ? "" : " ",
                 reading.word[i]);
    }
    if (error == NULL && plant_known(reading.word[2])) {
        error = told("a figure of the plant is not typed; set it", reading.word[2]);
    }
    if (error == NULL && flight_knows(reading.word[2])) {
        error = flight_check(reading.word[2], value);
        error = error == NULL ? NULL : told(error, reading.word[2]);
    } else if (error == NULL) {
        error = check_verb(reading.word[2]);
    }
    if (error == NULL && reading.later == SCENARIO_LATER_MAX - 1) {
        error = "too many";
    }
    error = error == NULL ? too_early(line, value) : error;
    if (error == NULL) {
        line->name = kept(reading.word[2]);
        line->value = kept(value);
        reading.typed_on[reading.later++] = reading.line;
    }
    return error;
}

static const char *read_reference(void)
{
    const char *error = flight_check("SETR", reading.word[1]);

    reading.scenario.reference_m = strtod(reading.word[1], NULL);
    return error == NULL ? NULL : told(error, reading.word[1]);
}

static const char *read_platform(void)
{
    reading.scenario.platform = strcmp(reading.word[1], "yes") == 0;
    return reading.scenario.platform || strcmp(reading.word[1], "no") == 0
               ? NULL
               : told("yes or no", reading.word[1]);
}

/* A line of a place file, behind the others. */
static const char *read_place(void)
{
    static place_file_t file;
    char line[LINE_MAX_OCTETS] = "";

    for (int i = 1; i < reading.count; i++) {
        snprintf(line + strlen(line), sizeof line - strlen(line), "%s ", reading.word[i]);
    }
    if (strlen(reading.place) + strlen(line) + 2 > sizeof reading.place) {
        return "too many";
    }
    strcat(strcat(reading.place, line), "\n");
    reading.scenario.place = reading.place;
    return place_file_read(&file, reading.place, 1) ? NULL : told(file.message, "place");
}

static const char *read_land(void)
{
    return read_number(reading.word[1], METRICS_REFERENCE_S, DURATION_MAX_S, &reading.scenario.land_s);
}

static const char *read_end(void)
{
    return read_number(reading.word[1], METRICS_REFERENCE_S, DURATION_MAX_S, &reading.scenario.end_s);
}

static const char *read_expect(void)
{
    expectation_t *e = &reading.scenario.expectations[reading.scenario.expectation_count];
    int metric = 0;

    while (metric < METRIC_COUNT && strcmp(metric_names[metric], reading.word[1]) != 0) {
        metric++;
    }
    if (metric == METRIC_COUNT) {
        return meant("no such metric", reading.word[1], metric_names, METRIC_COUNT);
    }
    if (reading.scenario.expectation_count == SCENARIO_EXPECTATIONS_MAX) {
        return "too many";
    }
    const char *error = read_number(reading.word[2], -HUGE_VAL, HUGE_VAL, &e->minimum);
    e->metric = (metric_t)metric;
    reading.scenario.expectation_count++;
    return error != NULL ? error : read_number(reading.word[3], e->minimum, HUGE_VAL, &e->maximum);
}

static const char *read_fate(void)
{
    static const char *const fates[] = {
        [FATE_SUCCEEDS] = "succeeds", [FATE_FAILS] = "fails", [FATE_EITHER] = "either"};

    for (int i = FATE_SUCCEEDS; i <= FATE_EITHER; i++) {
        if (strcmp(fates[i], reading.word[1]) == 0) {
            reading.scenario.fate = (scenario_fate_t)i;
            return NULL;
        }
    }
    return told("succeeds, fails or either", reading.word[1]);
}

static const struct {
    const char *name;
    int least, most; /* words, itself included */
    const char *(*read)(void);
    const char *form;
} keywords[] = {
    {"like", 2, 2, read_like, "like SCENARIO"},
    {"name", 2, 2, read_name, "name NAME"},
    {"set", 3, 3, read_set, "set NAME VALUE"},
    {"at", 3, WORDS_MAX, read_at, "at SECONDS COMMAND [VALUE]"},
    {"reference", 2, 2, read_reference, "reference METRES"},
    {"platform", 2, 2, read_platform, "platform yes|no"},
    {"place", 2, WORDS_MAX, read_place, "place WORD NUMBER..."},
    {"land", 2, 2, read_land, "land SECONDS"},
    {"end", 2, 2, read_end, "end SECONDS"},
    {"expect", 4, 4, read_expect, "expect METRIC LEAST MOST"},
    {"fate", 2, 2, read_fate, "fate succeeds|fails|either"},
};
#define KEYWORD_COUNT (sizeof keywords / sizeof keywords[0])

static const char *no_such_keyword(void)
{
    const char *names[KEYWORD_COUNT];

    for (size_t i = 0; i < KEYWORD_COUNT; i++) {
        names[i] = keywords[i].name;
    }
    return meant("no such word here", reading.word[0], names, KEYWORD_COUNT);
}

static const char *read_words(void)
{
    for (size_t i = 0; i < KEYWORD_COUNT; i++) {
        if (strcmp(keywords[i].name, reading.word[0]) == 0) {
            const bool right = reading.count >= keywords[i].least && reading.count <= keywords[i].most;
            return right ? keywords[i].read() : told("that is its form", keywords[i].form);
        }
    }
    return no_such_keyword();
}

/* last: nothing comes behind it. */
static const char *read_line(char *text, bool last)
{
    char *rest = text;
    char *comment = strchr(text, '#');

    if (strchr(text, '\n') == NULL && strlen(text) == LINE_MAX_OCTETS - 1) {
        return "line too long";
    }
    if (strchr(text, '\n') == NULL && !last) {
        return "not text";
    }
    if (comment != NULL) {
        *comment = '\0';
    }
    reading.count = 0;
    for (char *word; (word = strtok_r(rest, " \t\r\n", &rest)) != NULL;) {
        if (reading.count == WORDS_MAX) {
            return "too many words";
        }
        reading.word[reading.count++] = word;
    }
    return reading.count == 0 ? NULL : read_words();
}

/* A command that would never be typed. Those of the scenario that it is like may be: who ends earlier cannot
 * take them away. */
static const char *behind_the_end(const scenario_t *s)
{
    for (int i = 0; i < reading.later; i++) {
        if (reading.typed_on[i] > 0 && s->later[i].t_s >= s->end_s) {
            reading.line = reading.typed_on[i];
            snprintf(reading.message, sizeof reading.message,
                     "at %g %s: not before the end, %g s: it would never be typed", s->later[i].t_s,
                     s->later[i].name, s->end_s);
            return reading.message;
        }
    }
    return NULL;
}

/* What only the whole file shows. */
static const char *check(void)
{
    const scenario_t *s = &reading.scenario;

    reading.line = 0;
    if (!s->bench && s->reference_m <= 0.0) {
        return "no reference";
    }
    if (!s->bench && s->land_s <= METRICS_REFERENCE_S) {
        return "no land";
    }
    return s->end_s > s->land_s ? behind_the_end(s) : "end is not after land";
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash == NULL ? path : slash + 1;
}

bool scenario_file_named(const char *name)
{
    return strpbrk(name, "./") != NULL;
}

const scenario_t *scenario_file_read(const char *command, const char *path)
{
    FILE *in = input_open(path);
    char text[LINE_MAX_OCTETS];
    const char *error = in == NULL ? strerror(errno) : NULL;

    memset(&reading, 0, sizeof reading);
    reading.scenario.summary = "";
    reading.scenario.fate = FATE_EITHER;
    while (error == NULL && fgets(text, sizeof text, in) != NULL) {
        const size_t mark = reading.line++ == 0 && strncmp(text, BYTE_ORDER_MARK, 3) == 0 ? 3 : 0;

        error = read_line(text + mark, feof(in) != 0);
    }
    if (in != NULL && error == NULL && ferror(in) != 0) {
        error = strerror(errno);
        reading.line = 0;
    }
    if (reading.scenario.name == NULL) {
        reading.scenario.name = kept(name_of(path));
    }
    if (in != NULL && fclose(in) == 0 && error == NULL) {
        error = check();
    }
    if (error != NULL && reading.line > 0) {
        fprintf(stderr, "plomada %s: %s:%d: %s\n", command, path, reading.line, error);
    } else if (error != NULL) {
        fprintf(stderr, "plomada %s: %s: %s\n", command, path, error);
    }
    return error == NULL ? &reading.scenario : NULL;
}
