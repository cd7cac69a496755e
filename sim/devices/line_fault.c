#include "sim/devices/line_fault.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/noise.h"

#define ARGUMENT_MS_MAX 600000UL
#define STATUS_FIRST 21UL
#define STATUS_LAST 98UL

const char *const line_fault_names[] = {"drop", "flip", "dup", "stray", "delay", "mute", "restart", "status"};
_Static_assert(sizeof line_fault_names / sizeof line_fault_names[0] == LINE_FAULT_KIND_COUNT,
               "every fault has a name");

const char line_fault_help[] = "  KIND@N          strikes octet N that the sensor sends, counted from 0\n"
                               "  KIND:P          strikes each octet with probability P, 0..1\n"
                               "    drop@1234     the octet is lost\n"
                               "    flip:1e-4     one of its bits is wrong\n"
                               "    dup@1234      it comes twice\n"
                               "    stray:1e-4    a foreign octet comes before it\n"
                               "    delay@N:MS    it and what follows is held back for MS milliseconds\n"
                               "    mute@N:MS     it and what follows for MS milliseconds is lost\n"
                               "    restart@N     the sensor loses its power for a moment and boots again\n"
                               "    status@N:CODE the sensor reports trouble: 50..97 ends the stream, 21..49 "
                               "stops it for a second (98 resumes)\n";

typedef struct {
    line_fault_spec_t spec;
    noise_t chance;
} entry_t;

typedef struct {
    unsigned octet;
    double bit_ns;
} held_t;

struct fault {
    line_fault_ends_t ends;
    entry_t *entries;
    int entry_count;
    noise_t content;
    unsigned long seed;
    uint64_t position;
    unsigned strikes[LINE_FAULT_KIND_COUNT];
    sim_time_t line_free; /* end of the latest stop bit on the wire */
    sim_time_t held_until, mute_until;
    held_t *queue; /* what waits for the line: from head up to tail */
    size_t head, tail, capacity;
    timeline_id_t event;
};

/* ---- specifications ---- */

static bool takes_argument(line_fault_kind_t kind)
{
    return kind == LINE_FAULT_DELAY || kind == LINE_FAULT_MUTE || kind == LINE_FAULT_STATUS;
}

static const char *parse_kind(line_fault_spec_t *spec, const char *text, size_t length)
{
    for (int i = 0; i < LINE_FAULT_KIND_COUNT; i++) {
        if (strlen(line_fault_names[i]) == length && memcmp(line_fault_names[i], text, length) == 0) {
            spec->kind = (line_fault_kind_t)i;
            return NULL;
        }
    }
    return "no such kind of fault";
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static const char *parse_when(line_fault_spec_t *spec, const char **text)
{
    const char *from = *text + 1;
    char *end;

    spec->by_probability = **text == ':';
    if (spec->by_probability) {
        spec->probability = strtod(from, &end);
        *text = end;
        return end != from && spec->probability >= 0.0 && spec->probability <= 1.0
                   ? NULL
                   : "not a probability, 0..1";
    }
    spec->position = strtoull(from, &end, 10);
    *text = end;
    return is_digit(*from) ? NULL : "not a position, 0, 1, 2 ...";
}

static const char *parse_argument(line_fault_spec_t *spec, const char *text)
{
    unsigned long value;
    char *end;

    if (!takes_argument(spec->kind)) {
        return *text == '\0' ? NULL : "nothing may follow";
    }
    if (*text != ':' || !is_digit(text[1])) {
        return spec->kind == LINE_FAULT_STATUS ? "needs :CODE" : "needs :MS";
    }
    value = strtoul(text + 1, &end, 10);
    spec->argument = (unsigned)value;
    if (spec->kind == LINE_FAULT_STATUS) {
        return *end == '\0' && value >= STATUS_FIRST && value <= STATUS_LAST ? NULL : "not a code, 21..98";
    }
    return *end == '\0' && value >= 1 && value <= ARGUMENT_MS_MAX ? NULL : "not a time, 1..600000 ms";
}

const char *line_fault_parse(line_fault_spec_t *spec, const char *text)
{
    size_t length = strcspn(text, "@:");
    const char *rest = text + length;
    const char *error;

    memset(spec, 0, sizeof *spec);
    if (*rest == '\0') {
        return "not of the form KIND@POSITION or KIND:PROBABILITY";
    }
    error = parse_kind(spec, text, length);
    if (error == NULL) {
        error = parse_when(spec, &rest);
    }
    return error != NULL ? error : parse_argument(spec, rest);
}

/* ---- the wire ---- */

static void deliver(line_fault_t *fault, held_t held)
{
    fault->line_free = timeline_now();
    fault->ends.sink(fault->ends.sink_context, held.octet, held.bit_ns);
}

static sim_time_t turn_of(const line_fault_t *fault, double bit_ns)
{
    sim_time_t turn = fault->line_free + llround(10.0 * bit_ns);

    turn = turn > fault->held_until ? turn : fault->held_until;
    return turn > timeline_now() ? turn : timeline_now();
}

static void release(void *context);

static void await_line(line_fault_t *fault)
{
    if (fault->event == 0 && fault->head < fault->tail) {
        fault->event = timeline_at(turn_of(fault, fault->queue[fault->head].bit_ns), release, fault);
    }
}

static void release(void *context)
{
    line_fault_t *fault = context;
    held_t held = fault->queue[fault->head++];

    fault->event = 0;
    deliver(fault, held);
    await_line(fault);
}

static void *grown(void *memory, size_t size)
{
    memory = realloc(memory, size);
    if (memory == NULL) {
        abort();
    }
    return memory;
}

static void make_room(line_fault_t *fault)
{
    if (fault->head == fault->tail) {
        fault->head = fault->tail = 0;
    }
    if (fault->tail == fault->capacity) {
        fault->capacity = 2 * fault->capacity + 64;
        fault->queue = grown(fault->queue, fault->capacity * sizeof fault->queue[0]);
    }
}

static void pass(line_fault_t *fault, unsigned octet, double bit_ns)
{
    held_t held = {octet, bit_ns};

    if (fault->head == fault->tail && turn_of(fault, bit_ns) <= timeline_now()) {
        deliver(fault, held);
        return;
    }
    make_room(fault);
    fault->queue[fault->tail++] = held;
    await_line(fault);
}

/* ---- strikes ---- */

static bool strikes(entry_t *entry, uint64_t position)
{
    if (entry->spec.by_probability) {
        return noise_uniform(&entry->chance, 0.0, 1.0) < entry->spec.probability;
    }
    return entry->spec.position == position;
}

static sim_time_t argument_time(const line_fault_spec_t *spec)
{
    return timeline_now() + (sim_time_t)spec->argument * SIM_MS;
}

static bool muted(const line_fault_t *fault)
{
    return timeline_now() < fault->mute_until;
}

static void stray(line_fault_t *fault, double bit_ns)
{
    unsigned octet = (unsigned)(noise_bits(&fault->content) & 0xFFU);

    if (!muted(fault)) {
        pass(fault, octet, bit_ns);
    }
}

/* How often the octet comes after this: 1 as before, 0 not at all, 2 twice. */
static int strike(line_fault_t *fault, const line_fault_spec_t *spec, unsigned *octet, double bit_ns)
{
    fault->strikes[spec->kind]++;
    switch (spec->kind) {
    case LINE_FAULT_DROP:
        return 0;
    case LINE_FAULT_FLIP:
        *octet ^= 1U << (noise_bits(&fault->content) & 7U);
        return 1;
    case LINE_FAULT_DUPLICATE:
        return 2;
    case LINE_FAULT_STRAY:
        stray(fault, bit_ns);
        return 1;
    case LINE_FAULT_DELAY:
        fault->held_until = argument_time(spec);
        return 1;
    case LINE_FAULT_MUTE:
        fault->mute_until = argument_time(spec);
        return 0;
    case LINE_FAULT_RESTART:
        if (fault->ends.restart != NULL) {
            fault->ends.restart(fault->ends.device_context);
        }
        return 0;
    default:
        if (fault->ends.status != NULL) {
            fault->ends.status(fault->ends.device_context, spec->argument);
        }
        return 1;
    }
}

void line_fault_octet(void *context, unsigned octet, double bit_ns)
{
    line_fault_t *fault = context;
    uint64_t position = fault->position++;
    int copies = muted(fault) ? 0 : 1;

    for (int i = 0; i < fault->entry_count; i++) {
        entry_t *entry = &fault->entries[i];

        if (strikes(entry, position)) {
            copies *= strike(fault, &entry->spec, &octet, bit_ns);
        }
    }
    for (; copies > 0; copies--) {
        pass(fault, octet, bit_ns);
    }
}

unsigned line_fault_strikes(const line_fault_t *fault, line_fault_kind_t kind)
{
    return fault->strikes[kind];
}

uint64_t line_fault_octets(const line_fault_t *fault)
{
    return fault->position;
}

/* ---- life ---- */

static void append(line_fault_t *fault, const line_fault_spec_t *spec, unsigned long seed)
{
    char name[32];

    fault->entries = grown(fault->entries, ((size_t)fault->entry_count + 1) * sizeof fault->entries[0]);
    fault->entries[fault->entry_count].spec = *spec;
    snprintf(name, sizeof name, "fault %d", fault->entry_count);
    noise_init(&fault->entries[fault->entry_count].chance, seed, name);
    fault->entry_count++;
}

line_fault_t *line_fault_create(const line_fault_spec_t *specs, int count, unsigned long seed,
                                const line_fault_ends_t *ends)
{
    line_fault_t *fault = grown(NULL, sizeof *fault);

    memset(fault, 0, sizeof *fault);
    fault->ends = *ends;
    fault->seed = seed;
    fault->line_free = -SIM_S;
    noise_init(&fault->content, seed, "fault content");
    for (int i = 0; i < count; i++) {
        append(fault, &specs[i], seed);
    }
    return fault;
}

void line_fault_add(line_fault_t *fault, const line_fault_spec_t *spec)
{
    line_fault_spec_t next = *spec;

    next.position = fault->position;
    append(fault, &next, fault->seed);
}

void line_fault_destroy(line_fault_t *fault)
{
    if (fault == NULL) {
        return;
    }
    timeline_cancel(fault->event);
    free(fault->queue);
    free(fault->entries);
    free(fault);
}
