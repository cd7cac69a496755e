#include "scip_reader.h"

#include <errno.h>
#include <string.h>

#include "flexiport.h"

#define STREAM_ECHO 15U
#define SINGLE_ECHO 12U

static const char *const damage_names[] = {"", "sum", "length", "echo", "character", "sequence"};
_Static_assert(sizeof damage_names / sizeof damage_names[0] == SCIP_DAMAGE_COUNT, "every cause has a name");

/* ---- echo lines ---- */

static bool digits(const octet_t *text, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (text[i] < '0' || text[i] > '9') {
            return false;
        }
    }
    return true;
}

static uint16_t number(const octet_t *text, size_t count)
{
    unsigned value = 0;

    for (size_t i = 0; i < count; i++) {
        value = 10 * value + (text[i] - (unsigned)'0');
    }
    return (uint16_t)value;
}

static bool ends_in(const octet_t *line, size_t length, char family, size_t echo_length)
{
    const octet_t *echo = line + length - echo_length;

    return length >= echo_length && echo[0] == (octet_t)family && (echo[1] == 'S' || echo[1] == 'D') &&
           digits(echo + 2, echo_length - 2);
}

/* Length of the echo that the line ends in, or 0. */
static size_t echo_at_end(const octet_t *line, size_t length)
{
    if (ends_in(line, length, 'M', STREAM_ECHO)) {
        return STREAM_ECHO;
    }
    return ends_in(line, length, 'G', SINGLE_ECHO) ? SINGLE_ECHO : 0;
}

static scip_kind_t kind_of(const octet_t *echo)
{
    if (echo[0] == 'M') {
        return echo[1] == 'S' ? SCIP_STREAM_2 : SCIP_STREAM_3;
    }
    return echo[1] == 'S' ? SCIP_SINGLE_2 : SCIP_SINGLE_3;
}

/* The request behind an echo. In an answer the count of a run is as asked for; in a frame it is what remains,
 * so at least one more was asked for. */
static bool request_of(const octet_t *echo, size_t length, bool frame, scip_request_t *request)
{
    const uint16_t cluster = number(echo + 10, 2);
    scip_range_t range = {number(echo + 2, 4), number(echo + 6, 4), cluster == 0 ? 1 : cluster, 0, 0};

    if (length == STREAM_ECHO) {
        range.interval = number(echo + 12, 1);
        range.scans = number(echo + 13, 2);
        range.scans = (uint16_t)(range.scans + (frame && range.scans > 0 && range.scans < 99));
    }
    if (!scip_request_scan(request, kind_of(echo), &range)) {
        return false;
    }
    memcpy(request->text, echo,
           length * sizeof echo[0]); /* cluster 00 means 01, and is echoed as it was sent */
    return true;
}

/* A run's counter has fallen. That it has fallen to 00 at once rather says that the run was an endless one.
 */
static bool count_follows(const scip_reader_t *reader, unsigned remaining)
{
    return remaining + 1U == reader->remaining || (remaining > 0 && remaining < reader->remaining);
}

/* True when the parser, in a stream, takes this echo as the next one's. */
static bool continues(const scip_reader_t *reader, const octet_t *echo, size_t length, bool frame)
{
    const scip_request_t *awaited = &reader->parser.awaited;
    const bool counted = awaited->range.scans > 0;
    const size_t fixed = counted ? length - 2 : length;

    if (!reader->awaiting || length != awaited->echo_length ||
        memcmp(echo, scip_request_echo(awaited), fixed * sizeof echo[0]) != 0) {
        return false;
    }
    return !counted || (frame && count_follows(reader, number(echo + fixed, 2)));
}

/* ---- lines ---- */

static scip_event_t feed_line(scip_reader_t *reader, const octet_t *line, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        (void)scip_parser_feed(&reader->parser, line[i]);
    }
    return scip_parser_feed(&reader->parser, SCIP_LINE_FEED);
}

static bool accepted(const scip_parser_t *parser)
{
    return parser->reply.status[0] == '0' && parser->reply.status[1] == '0';
}

static bool is_stream(const scip_parser_t *parser)
{
    return parser->awaited.scan_octets > 0;
}

static void take_event(scip_reader_t *reader, scip_event_t event)
{
    switch (event) {
    case SCIP_SCAN:
        reader->totals.scans++;
        reader->awaiting = is_stream(&reader->parser);
        reader->take(reader->context, &reader->scan);
        break;
    case SCIP_REPLY:
        reader->totals.answers++;
        reader->awaiting = is_stream(&reader->parser) && accepted(&reader->parser);
        break;
    case SCIP_NOTICE:
        reader->totals.notices++;
        break;
    case SCIP_NOTHING:
        return;
    default:
        break;
    }
    reader->within = false;
}

/* ---- packets that are no scans ---- */

typedef struct {
    const char *symbol, *what;
} command_name_t;

static const command_name_t command_names[] = {
    {"ME", "distances with intensities, which are not read"},
    {"GE", "single scans with intensities, which are not read"},
    {"HE", "several echoes with intensities, which are not read"},
    {"HD", "several echoes, which are not read"},
    {"NE", "several echoes with intensities, which are not read"},
    {"ND", "several echoes, which are not read"},
    {"MS", "of steps beyond 1080, or malformed"},
    {"MD", "of steps beyond 1080, or malformed"},
    {"GS", "of steps beyond 1080, or malformed"},
    {"GD", "of steps beyond 1080, or malformed"},
    {"VV", "what the sensor is"},
    {"PP", "its limits"},
    {"II", "its state"},
    {"BM", "laser on"},
    {"QT", "laser off"},
    {"RS", "reset"},
    {"TM", "its clock"},
    {"SS", "bit rate"},
    {"CR", "motor speed"},
    {"HS", "sensitivity"},
    {"SCIP2.", "from SCIP1.1 to SCIP2.0"},
    {"V", "what the sensor is, in SCIP1.1"},
    {"L", "laser on or off, in SCIP1.1"},
    {"G", "a scan in SCIP1.1, which is not read"},
};

static const char *meaning(const char *symbol)
{
    for (size_t i = 0; i < sizeof command_names / sizeof command_names[0]; i++) {
        if (strncmp(symbol, command_names[i].symbol, strlen(command_names[i].symbol)) == 0) {
            return command_names[i].what;
        }
    }
    return "no command that is known here";
}

static bool is_letter(octet_t octet)
{
    return octet >= 'A' && octet <= 'Z';
}

/* The command that a line echoes: its first letters, "?" when there are none. */
static void symbol_of(const octet_t *line, size_t length, char symbol[SCIP_READER_SYMBOL])
{
    static const char change[] = "SCIP2.0";
    size_t letters = 0, same = 0;

    while (letters < 2 && letters < length && is_letter(line[letters])) {
        letters++;
    }
    while (same < strlen(change) && same < length && line[same] == (octet_t)change[same]) {
        same++;
    }
    letters = same == strlen(change) ? same : letters;
    for (size_t i = 0; i < letters; i++) {
        symbol[i] = (char)line[i];
    }
    strcpy(symbol + letters, letters > 0 ? "" : "?");
}

static void count_skipped(scip_reader_t *reader)
{
    char symbol[SCIP_READER_SYMBOL];
    size_t i = 0;

    symbol_of(reader->line, reader->length, symbol);
    while (i + 1 < SCIP_READER_SYMBOLS && reader->skipped[i].count > 0 &&
           strcmp(reader->skipped[i].symbol, symbol) != 0) {
        i++;
    }
    if (reader->skipped[i].count == 0) {
        strcpy(reader->skipped[i].symbol, i + 1 < SCIP_READER_SYMBOLS ? symbol : "?");
    }
    reader->skipped[i].count++;
}

/* A packet's first line: when it is VV, PP or II the lines behind it tell of the sensor. */
static void begin_skipped(scip_reader_t *reader)
{
    static const scip_kind_t kinds[] = {SCIP_VERSION, SCIP_PARAMETERS, SCIP_STATE};
    scip_request_t request;

    count_skipped(reader);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        (void)scip_request(&request, kinds[i]);
        if (reader->length == request.echo_length &&
            memcmp(reader->line, scip_request_echo(&request), reader->length * sizeof reader->line[0]) == 0) {
            scip_parser_line_broken(&reader->text);
            scip_parser_expect(&reader->text, &request);
        }
    }
}

static void feed_text(scip_reader_t *reader)
{
    for (size_t i = 0; i < reader->length; i++) {
        (void)scip_parser_feed(&reader->text, reader->line[i]);
    }
    if (scip_parser_feed(&reader->text, SCIP_LINE_FEED) == SCIP_TEXT) {
        scip_info_take(&reader->info, &reader->text);
    }
}

static void skip_held(scip_reader_t *reader, const octet_t *echo, size_t length)
{
    const size_t line_length = reader->length;
    octet_t line[SCIP_READER_LINE];

    memcpy(line, reader->line, line_length * sizeof line[0]);
    memcpy(reader->line, echo, length * sizeof line[0]);
    reader->length = length;
    count_skipped(reader);
    memcpy(reader->line, line, line_length * sizeof line[0]);
    reader->length = line_length;
    reader->skipping = true;
}

/* The held echo, now that the line behind it is there: its status. */
static void begin_reply(scip_reader_t *reader)
{
    const size_t length = echo_at_end(reader->echo, reader->echo_length);
    const octet_t *echo = reader->echo + reader->echo_length - length;
    const bool frame = reader->length > 0 && reader->line[0] != '0';
    scip_request_t request;

    reader->holding = false;
    if (!continues(reader, echo, length, frame)) {
        if (!request_of(echo, length, frame, &request)) {
            skip_held(reader, echo, length);
            return;
        }
        scip_parser_expect(&reader->parser, &request);
        reader->awaiting = true;
    }
    reader->remaining = number(echo + length - 2, 2);
    reader->within = true;
    take_event(reader, feed_line(reader, reader->echo, reader->echo_length));
}

static void hold(scip_reader_t *reader)
{
    memcpy(reader->echo, reader->line, reader->length * sizeof reader->line[0]);
    reader->echo_length = reader->length;
    reader->holding = true;
    reader->totals.skipped += reader->skipping;
    reader->skipping = reader->in_rest = false;
}

static void skip(scip_reader_t *reader)
{
    if (reader->length == 0) {
        reader->totals.skipped += reader->skipping;
        reader->skipping = reader->in_rest = false;
    } else if (!reader->in_rest) {
        if (!reader->skipping) {
            begin_skipped(reader);
        }
        reader->skipping = true;
    }
    feed_text(reader);
}

/* A line that does not belong to the reply: the echo of the next one, or what is left of this one. */
static void take_foreign_line(scip_reader_t *reader)
{
    if (echo_at_end(reader->line, reader->length) > 0) {
        scip_parser_line_broken(&reader->parser);
        hold(reader);
    } else {
        reader->in_rest = reader->length > 0;
    }
}

static void line_complete(scip_reader_t *reader)
{
    scip_event_t event;

    if (reader->holding) {
        begin_reply(reader);
    }
    if (reader->within) {
        event = feed_line(reader, reader->line, reader->length);
        take_event(reader, event);
        if (event == SCIP_DAMAGED) {
            take_foreign_line(reader);
        }
    } else if (echo_at_end(reader->line, reader->length) > 0) {
        hold(reader);
    } else {
        skip(reader);
    }
}

/* ---- input ---- */

void scip_reader_init(scip_reader_t *reader, scip_reader_take_t take, void *context)
{
    memset(reader, 0, sizeof *reader);
    reader->take = take;
    reader->context = context;
    reader->scan.distance_mm = reader->distance_mm;
    reader->scan.capacity = SCIP_POINTS_MAX;
    scip_info_init(&reader->info);
    scip_parser_init(&reader->text);
    scip_parser_init(&reader->parser);
    scip_parser_scan_into(&reader->parser, &reader->scan);
}

void scip_reader_feed(scip_reader_t *reader, const unsigned char *octets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (octets[i] == SCIP_LINE_FEED) {
            line_complete(reader);
            reader->length = 0;
            continue;
        }
        if (reader->length == SCIP_READER_LINE) {
            reader->length = SCIP_READER_LINE / 2;
            memcpy(reader->line, reader->line + reader->length, reader->length * sizeof reader->line[0]);
        }
        reader->line[reader->length++] = octets[i];
    }
}

void scip_reader_end(scip_reader_t *reader)
{
    reader->totals.unfinished = reader->within || reader->holding;
}

static void take_octets(void *context, const unsigned char *octets, size_t count)
{
    scip_reader_feed(context, octets, count);
}

static const char *read_all(scip_reader_t *reader, FILE *file)
{
    static unsigned char octets[65536];
    size_t count = fread(octets, 1, sizeof octets, file);
    flexiport_t log;
    const bool is_log = flexiport_begin(&log, octets, count);

    for (; count > 0; count = fread(octets, 1, sizeof octets, file)) {
        if (!is_log) {
            scip_reader_feed(reader, octets, count);
        } else if (!flexiport_feed(&log, octets, count, take_octets, reader)) {
            return "a log of flexiport, broken in the middle";
        }
    }
    scip_reader_end(reader);
    return ferror(file) ? strerror(errno) : NULL;
}

const char *scip_reader_file(scip_reader_t *reader, const char *path)
{
    const char *error;
    FILE *file;

    if (strcmp(path, "-") == 0) {
        return read_all(reader, stdin);
    }
    file = fopen(path, "rb");
    if (file == NULL) {
        return strerror(errno);
    }
    error = read_all(reader, file);
    fclose(file);
    return error;
}

static const char *sensor_name(const scip_reader_t *reader)
{
    const scip_info_t *info = &reader->info;

    if (info->model[0] != '\0') {
        return info->model;
    }
    return info->product[0] != '\0' ? info->product : "not told in this recording";
}

unsigned long scip_reader_damaged(const scip_reader_t *reader)
{
    unsigned long damaged = 0;

    for (int i = SCIP_DAMAGE_NONE + 1; i < SCIP_DAMAGE_COUNT; i++) {
        damaged += reader->parser.counters.damaged[i];
    }
    return damaged;
}

void scip_reader_print(const scip_reader_t *reader, FILE *out)
{
    const scip_reader_totals_t *totals = &reader->totals;

    fprintf(out, "scans: %lu\ndamaged: %lu", totals->scans, scip_reader_damaged(reader));
    for (int i = SCIP_DAMAGE_NONE + 1; i < SCIP_DAMAGE_COUNT; i++) {
        fprintf(out, " %s:%lu", damage_names[i], (unsigned long)reader->parser.counters.damaged[i]);
    }
    fprintf(out, "\nanswers: %lu\nnotices: %lu\nsensor: %s\nskipped packets: %lu\n", totals->answers,
            totals->notices, sensor_name(reader), totals->skipped);
    for (size_t i = 0; i < SCIP_READER_SYMBOLS && reader->skipped[i].count > 0; i++) {
        fprintf(out, "  %-8s %5lu  %s\n", reader->skipped[i].symbol, reader->skipped[i].count,
                meaning(reader->skipped[i].symbol));
    }
    if (totals->unfinished) {
        fprintf(out, "the last reply is unfinished\n");
    }
}
