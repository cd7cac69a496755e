/* Why a replay is the same run. The firmware sees nothing of the world but octets, three pins and its
 * flash, and time is virtual: with the same at the same instants it does the same. Two things must not differ
 * by a nanosecond: the instants, so they are kept as integers, and the order of what happens at one instant.
 * The timeline runs things of one instant in the order in which they were posted, so an octet is posted here
 * when a device's transmitter would post it: one octet's length before it arrives. Post them all at the
 * beginning, and an octet that ends together with a clock tick comes before it instead of after. */
#include "sim/tape.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/ti/f021/flash.h"

#define FIRST_LINE "plomada-recording 2"
#define FIRST_LINE_BEFORE "plomada-recording 1" /* without an end line */
#define END "end"
#define CELLS (FLASH_SECTORS * FLASH_SECTOR_CELLS)
#define ERASED 0xFFFFU
#define CELLS_A_LINE 16
#define RUN_MAX 48
#define LINE_MAX_OCTETS 4096
#define TIME_MOST (INT64_C(1000000) * SIM_S) /* eleven days: a run with one instant beyond is none */
#define LENGTH_MOST_NS 1e8                   /* ten bits at 100 bit/s */

static const char *const wire_words[] = {"laser", "imu", "radio"};
_Static_assert(sizeof wire_words / sizeof wire_words[0] == BOARD_WIRES, "every wire has a word");

/* Recording
 * ------------------------------------------------------------------------------------------------------ */

/* Octets without a pause between them. */
typedef struct {
    sim_time_t first, last;
    double length_ns;
    int count;
    unsigned char octets[RUN_MAX];
} run_t;

static struct {
    FILE *out;
    run_t runs[BOARD_WIRES];
} recorder;

static void write_run(board_wire_t wire)
{
    run_t *run = &recorder.runs[wire];

    if (run->count == 0) {
        return;
    }
    fprintf(recorder.out, "octets %s %" PRId64 " %.17g ", wire_words[wire], run->first, run->length_ns);
    for (int i = 0; i < run->count; i++) {
        fprintf(recorder.out, "%02X", run->octets[i]);
    }
    fputc('\n', recorder.out);
    run->count = 0;
}

static void octet_came(board_wire_t wire, unsigned octet, double bit_ns)
{
    run_t *run = &recorder.runs[wire];
    const double length_ns = 10.0 * bit_ns;
    const bool follows = run->count > 0 && run->count < RUN_MAX && run->length_ns == length_ns &&
                         timeline_now() == run->last + (sim_time_t)llround(length_ns);

    if (!follows) {
        write_run(wire);
        run->first = timeline_now();
        run->length_ns = length_ns;
    }
    run->last = timeline_now();
    run->octets[run->count++] = (unsigned char)octet;
}

static void selected(bool firmware)
{
    fprintf(recorder.out, "select %" PRId64 " %d\n", timeline_now(), firmware ? 1 : 0);
}

static void stick_level(bool high)
{
    fprintf(recorder.out, "stick %" PRId64 " %d\n", timeline_now(), high ? 1 : 0);
}

static void battery_volts(long microvolts)
{
    fprintf(recorder.out, "battery %" PRId64 " %ld\n", timeline_now(), microvolts);
}

static void write_flash(void)
{
    static unsigned short cells[CELLS];

    flash_read_all(cells);
    for (int at = 0; at < CELLS; at += CELLS_A_LINE) {
        bool erased = true;

        for (int i = at; i < at + CELLS_A_LINE; i++) {
            erased = erased && cells[i] == ERASED;
        }
        if (!erased) {
            fprintf(recorder.out, "flash %d ", at);
            for (int i = at; i < at + CELLS_A_LINE; i++) {
                fprintf(recorder.out, "%04X", cells[i]);
            }
            fputc('\n', recorder.out);
        }
    }
}

void tape_record(FILE *out)
{
    memset(&recorder, 0, sizeof recorder);
    recorder.out = out;
    fputs(FIRST_LINE "\n", out);
    write_flash();
    if (!board_stick_level()) {
        stick_level(false);
    }
    board_probe(BOARD_PROBE_TAPE, &(board_probes_t){.octet = octet_came,
                                                    .selector = selected,
                                                    .stick = stick_level,
                                                    .battery = battery_volts});
}

void tape_key(const char *key, const char *value)
{
    fprintf(recorder.out, "%s %s\n", key, value);
}

void tape_truth(const tape_truth_t *truth)
{
    fprintf(recorder.out, "truth %.17g %.17g %.17g %.9g %.17g %.17g %.17g\n", truth->height_m,
            truth->altitude_m, truth->terrain_m, truth->thrust_n, truth->x_m, truth->y_m, truth->heading_rad);
}

void tape_stop(void)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        write_run((board_wire_t)i);
    }
    fprintf(recorder.out, END " %" PRId64 "\n", timeline_now());
    board_probe(BOARD_PROBE_TAPE, NULL);
    recorder.out = NULL;
}

/* Reading
 * -------------------------------------------------------------------------------------------------------- */

typedef struct {
    sim_time_t time; /* end of the stop bit */
    double length_ns;
    unsigned char octet;
} moment_t;

typedef struct {
    void *items;
    size_t count, room, size;
} list_t;

typedef struct {
    char key[16];
    char value[112];
} entry_t;

typedef enum { PIN_SELECT, PIN_STICK, PIN_BATTERY, PINS } pin_t;
static const struct {
    const char *word;
    long most;
    const char *form;
} pins[PINS] = {
    [PIN_SELECT] = {"select", 1, "select T_NS 0|1"},
    [PIN_STICK] = {"stick", 1, "stick T_NS 0|1"},
    [PIN_BATTERY] = {"battery", 5000000, "battery T_NS MICROVOLTS"},
};

typedef struct {
    sim_time_t time;
    pin_t pin;
    long value; /* a level, or microvolts */
} level_t;

struct tape {
    list_t octets[BOARD_WIRES], keys, truth, levels;
    unsigned short cells[CELLS];
    bool has_end, torn; /* its kind of recording has an end line; the last line is not whole */
};

static void *append(list_t *list, size_t size)
{
    if (list->count == list->room) {
        list->room = list->room == 0 ? 64 : 2 * list->room;
        list->size = size;
        list->items = realloc(list->items, list->room * size);
        if (list->items == NULL) {
            abort();
        }
    }
    return (char *)list->items + size * list->count++;
}

static bool hex(const char *text, int digits, unsigned *value)
{
    *value = 0;
    for (int i = 0; i < digits; i++) {
        const char *all = "0123456789ABCDEF", *found = text[i] == '\0' ? NULL : strchr(all, text[i]);

        if (found == NULL) {
            return false;
        }
        *value = 16U * *value + (unsigned)(found - all);
    }
    return true;
}

static sim_time_t last_octet(const list_t *octets)
{
    return octets->count == 0 ? 0 : ((const moment_t *)octets->items)[octets->count - 1].time;
}

static sim_time_t last_level(const list_t *levels)
{
    return levels->count == 0 ? 0 : ((const level_t *)levels->items)[levels->count - 1].time;
}

static const char *read_octets(tape_t *tape, const char *rest)
{
    char word[8];
    double length_ns;
    int64_t time;
    int used = 0;
    int wire = 0;
    unsigned octet;

    if (sscanf(rest, "%7s %" SCNd64 " %lf %n", word, &time, &length_ns, &used) != 3 || !(length_ns > 0.0) ||
        time < 0) {
        return "octets WIRE T_NS LENGTH_NS HEX";
    }
    while (wire < BOARD_WIRES && strcmp(word, wire_words[wire]) != 0) {
        wire++;
    }
    if (wire == BOARD_WIRES) {
        return "no such wire";
    }
    if (length_ns > LENGTH_MOST_NS || time > TIME_MOST) {
        return "beyond what a run lasts";
    }
    if (time < last_octet(&tape->octets[wire])) {
        return "before the octet before it on this wire";
    }
    for (rest += used; *rest != '\0'; rest += 2) {
        if (!hex(rest, 2, &octet)) {
            return "not hex";
        }
        *(moment_t *)append(&tape->octets[wire], sizeof(moment_t)) = (moment_t){time, length_ns,
                                                                                (unsigned char)octet};
        time += (sim_time_t)llround(length_ns);
    }
    return NULL;
}

static const char *read_flash(tape_t *tape, const char *rest)
{
    int at, used = 0;
    unsigned cell;

    if (sscanf(rest, "%d %n", &at, &used) != 1 || at < 0 || at > CELLS - CELLS_A_LINE) {
        return "flash OFFSET CELLS";
    }
    for (int i = 0; i < CELLS_A_LINE; i++) {
        if (!hex(rest + used + 4 * i, 4, &cell)) {
            return "not hex";
        }
        tape->cells[at + i] = (unsigned short)cell;
    }
    return NULL;
}

static const char *read_level(tape_t *tape, pin_t pin, const char *rest)
{
    int64_t time;
    long value;

    if (sscanf(rest, "%" SCNd64 " %ld", &time, &value) != 2 || time < 0 || value < 0 ||
        value > pins[pin].most) {
        return pins[pin].form;
    }
    if (time > TIME_MOST) {
        return "beyond what a run lasts";
    }
    if (time < last_level(&tape->levels)) {
        return "before the level before it";
    }
    *(level_t *)append(&tape->levels, sizeof(level_t)) = (level_t){time, pin, value};
    return NULL;
}

static const char *read_truth(tape_t *tape, const char *rest)
{
    tape_truth_t row = {.thrust_n = NAN, .x_m = NAN, .y_m = NAN, .heading_rad = NAN};

    if (sscanf(rest, "%lf %lf %lf %lf %lf %lf %lf", &row.height_m, &row.altitude_m, &row.terrain_m,
               &row.thrust_n, &row.x_m, &row.y_m, &row.heading_rad) < 3) {
        return "truth HEIGHT ABS TERRAIN";
    }
    *(tape_truth_t *)append(&tape->truth, sizeof row) = row;
    return NULL;
}

static const char *read_key(tape_t *tape, const char *key, const char *value)
{
    entry_t *kept = append(&tape->keys, sizeof *kept);

    if (strlen(key) >= sizeof kept->key || strlen(value) >= sizeof kept->value) {
        return "too long";
    }
    strcpy(kept->key, key);
    strcpy(kept->value, value);
    return NULL;
}

static const char *read_line(tape_t *tape, char *line)
{
    char *rest = strchr(line, ' ');

    if (rest == NULL) {
        return "no value";
    }
    *rest++ = '\0';
    if (strcmp(line, "octets") == 0) {
        return read_octets(tape, rest);
    }
    if (strcmp(line, "flash") == 0) {
        return read_flash(tape, rest);
    }
    for (int pin = 0; pin < PINS; pin++) {
        if (strcmp(line, pins[pin].word) == 0) {
            return read_level(tape, (pin_t)pin, rest);
        }
    }
    return strcmp(line, "truth") == 0 ? read_truth(tape, rest) : read_key(tape, line, rest);
}

/* False at the end of the file and at a last line without its end: what was cut off does not count. *torn:
 * there was such a line. *wrong: what is no line at all. */
static bool next_line(FILE *in, char line[LINE_MAX_OCTETS], bool *torn, const char **wrong)
{
    size_t length;

    if (fgets(line, LINE_MAX_OCTETS, in) == NULL) {
        return false;
    }
    length = strlen(line);
    if (length == 0 || line[length - 1] != '\n') {
        *torn = feof(in) != 0;
        *wrong = *torn ? NULL : "not text, or longer than any line of a recording";
        return *wrong != NULL;
    }
    line[length - 1] = '\0';
    return true;
}

static bool read_first(tape_t *tape, const char *line)
{
    tape->has_end = strcmp(line, FIRST_LINE) == 0;
    return tape->has_end || strcmp(line, FIRST_LINE_BEFORE) == 0;
}

tape_t *tape_read(FILE *in, const char **error)
{
    static char message[160];
    char line[LINE_MAX_OCTETS];
    tape_t *tape = calloc(1, sizeof *tape);
    const char *wrong = NULL;
    long number = 1;

    if (tape == NULL) {
        abort();
    }
    for (int i = 0; i < CELLS; i++) {
        tape->cells[i] = ERASED;
    }
    if (!next_line(in, line, &tape->torn, &wrong) || wrong != NULL || !read_first(tape, line)) {
        wrong = "not a recording of plomada";
    }
    while (wrong == NULL && next_line(in, line, &tape->torn, &wrong)) {
        number++;
        wrong = wrong != NULL ? wrong : read_line(tape, line);
    }
    if (wrong != NULL) {
        snprintf(message, sizeof message, "line %ld: %s", number, wrong);
        *error = message;
        tape_free(tape);
        return NULL;
    }
    return tape;
}

void tape_free(tape_t *tape)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        free(tape->octets[i].items);
    }
    free(tape->keys.items);
    free(tape->truth.items);
    free(tape->levels.items);
    free(tape);
}

const char *tape_value(const tape_t *tape, const char *key, size_t n)
{
    const entry_t *keys = tape->keys.items;

    for (size_t i = 0; i < tape->keys.count; i++) {
        if (strcmp(keys[i].key, key) == 0 && n-- == 0) {
            return keys[i].value;
        }
    }
    return NULL;
}

bool tape_truth_row(const tape_t *tape, size_t row, tape_truth_t *truth)
{
    if (row >= tape->truth.count) {
        return false;
    }
    *truth = ((const tape_truth_t *)tape->truth.items)[row];
    return true;
}

tape_state_t tape_state(const tape_t *tape)
{
    if (tape->has_end && tape_value(tape, END, 0) != NULL) {
        return TAPE_WHOLE;
    }
    return tape->has_end || tape->torn ? TAPE_CUT : TAPE_UNTOLD;
}

sim_time_t tape_end(const tape_t *tape)
{
    sim_time_t end = 0;

    for (int i = 0; i < BOARD_WIRES; i++) {
        const moment_t *octets = tape->octets[i].items;
        const size_t count = tape->octets[i].count;

        if (count > 0 && octets[count - 1].time > end) {
            end = octets[count - 1].time;
        }
    }
    return end;
}

/* Playing
 * -------------------------------------------------------------------------------------------------------- */

typedef struct {
    board_wire_t wire;
    const moment_t *next, *end;
} reel_t;

static struct {
    const tape_t *tape;
    reel_t reels[BOARD_WIRES];
    size_t level;
} player;

static void octet_ends(void *context);

static void octet_begins(void *context)
{
    const reel_t *reel = context;

    timeline_at(reel->next->time, octet_ends, context);
}

static void await_octet(reel_t *reel)
{
    if (reel->next == reel->end) {
        return;
    }
    const sim_time_t begin = reel->next->time - (sim_time_t)llround(reel->next->length_ns);

    if (begin <= timeline_now()) {
        octet_begins(reel);
    } else {
        timeline_at(begin, octet_begins, reel);
    }
}

static void octet_ends(void *context)
{
    reel_t *reel = context;
    const moment_t *now = reel->next;

    reel->next++;
    await_octet(reel);
    board_octet(reel->wire, now->octet, now->length_ns / 10.0);
}

static void await_level(void);

static void set_level(void *unused)
{
    (void)unused;
    const level_t *level = &((const level_t *)player.tape->levels.items)[player.level];

    if (level->pin == PIN_BATTERY) {
        board_battery_pin(level->value);
    } else if (level->pin == PIN_STICK) {
        board_stick_pin(level->value == 1);
    } else {
        board_select(level->value == 1);
    }
    player.level++;
    await_level();
}

static void await_level(void)
{
    if (player.level < player.tape->levels.count) {
        timeline_at(((const level_t *)player.tape->levels.items)[player.level].time, set_level, NULL);
    }
}

static void nowhere(void *context, unsigned octet)
{
    (void)context;
    (void)octet;
}

void tape_restore_flash(const tape_t *tape)
{
    flash_write_all(tape->cells);
}

void tape_play(const tape_t *tape, board_terminal_t heard, void *heard_context)
{
    player.tape = tape;
    player.level = 0;
    for (int i = 0; i < BOARD_WIRES; i++) {
        const moment_t *octets = tape->octets[i].items;

        board_connect((board_wire_t)i, i == BOARD_RADIO ? heard : nowhere, heard_context);
        player.reels[i] = (reel_t){(board_wire_t)i, octets,
                                   octets == NULL ? NULL : octets + tape->octets[i].count};
        await_octet(&player.reels[i]);
    }
    await_level();
}

/* Typing otherwise
 * ----------------------------------------------------------------------------------------------- */

#define TYPED_MAX 96

/* A line that the operator sent: where it is among the radio's octets. */
typedef struct {
    size_t first, end; /* end: behind its line feed */
} typed_t;

/* The next whole line from `from` on; false when there is none. */
static bool next_typed(const tape_t *tape, size_t from, typed_t *line)
{
    const moment_t *octets = tape->octets[BOARD_RADIO].items;

    for (size_t i = from; i < tape->octets[BOARD_RADIO].count; i++) {
        if (octets[i].octet == '\n') {
            *line = (typed_t){from, i + 1};
            return true;
        }
    }
    return false;
}

static bool names(const tape_t *tape, const typed_t *line, const char *name)
{
    const moment_t *octets = tape->octets[BOARD_RADIO].items;
    const size_t length = strlen(name);

    if (line->end - line->first < length + 3 || octets[line->first].octet != '#' ||
        octets[line->first + 1 + length].octet != ' ') {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        if ((octets[line->first + 1 + i].octet & 0xDFU) != ((unsigned char)name[i] & 0xDFU)) {
            return false;
        }
    }
    return true;
}

/* Puts text in place of the octets of a line, from the instant at which that began. False: it would run into
 * what comes next. */
static bool splice(tape_t *tape, const typed_t *line, const char *text, sim_time_t begin, double length_ns)
{
    list_t *radio = &tape->octets[BOARD_RADIO];
    const size_t length = strlen(text), behind = radio->count - line->end;
    const sim_time_t step = (sim_time_t)llround(length_ns);
    moment_t *octets = radio->items;

    if (behind > 0 && begin + (sim_time_t)length * step > octets[line->end].time - step) {
        return false;
    }
    for (size_t i = line->end - line->first; i < length; i++) {
        (void)append(radio, sizeof(moment_t));
    }
    octets = radio->items;
    memmove(octets + line->first + length, octets + line->end, behind * sizeof *octets);
    for (size_t i = 0; i < length; i++) {
        octets[line->first + i] = (moment_t){begin + (sim_time_t)(i + 1) * step, length_ns,
                                             (unsigned char)text[i]};
    }
    radio->count = line->first + length + behind;
    return true;
}

/* Just before the first #SETR, where the radio was silent for long enough. */
static bool insert(tape_t *tape, const char *text)
{
    const moment_t *octets = tape->octets[BOARD_RADIO].items;
    typed_t line = {0, 0};

    while (next_typed(tape, line.end, &line) && !names(tape, &line, "SETR")) {
    }
    if (line.end == 0 || !names(tape, &line, "SETR")) {
        return false;
    }
    const moment_t first = octets[line.first];
    const sim_time_t step = (sim_time_t)llround(first.length_ns);
    const sim_time_t begin = first.time - (sim_time_t)(strlen(text) + 4) * step;
    const bool room = begin >= 0 && (line.first == 0 || octets[line.first - 1].time <= begin);
    const typed_t nothing = {line.first, line.first};

    return room && splice(tape, &nothing, text, begin, first.length_ns);
}

bool tape_retype(tape_t *tape, const char *name, const char *value)
{
    char text[TYPED_MAX];
    typed_t line = {0, 0};
    bool typed = false;

    if (snprintf(text, sizeof text, "#%s %s\n", name, value) >= (int)sizeof text) {
        return false;
    }
    while (next_typed(tape, line.end, &line)) {
        if (names(tape, &line, name)) {
            const moment_t first = ((const moment_t *)tape->octets[BOARD_RADIO].items)[line.first];

            if (!splice(tape, &line, text, first.time - (sim_time_t)llround(first.length_ns),
                        first.length_ns)) {
                return false;
            }
            line.end = line.first + strlen(text);
            typed = true;
        }
    }
    return typed || insert(tape, text);
}
