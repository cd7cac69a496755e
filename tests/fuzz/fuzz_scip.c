/* Fuzz target of the SCIP parser. The input is octets from the line, with operations between them (80H..88H),
 * because sums and echoes are hard to guess. Two parsers hear the same, one octet by octet and one in bursts;
 * every event is checked against what was sent. A broken promise aborts. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_info.h"
#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "tests/support/scip_frames.h"

#define POINTS_MAX 40 /* memory of a scan; one of the requests has more */
#define SENT_MAX 41
#define CANARY 0xC0DEU
#define LOG_MAX 4096
#define FRAME_MAX 256
#define PENDING_MAX 512

typedef struct {
    scip_parser_t parser;
    scip_scan_t scan[2];
    uint16_t points[2][POINTS_MAX + 1];
    unsigned events[SCIP_DAMAGED + 1];
    unsigned stored; /* scans seen complete while there was a memory for them */
} side_t;

static side_t single, burst;
static scip_info_t info;
static uint8_t heard[LOG_MAX]; /* all octets since the line was last broken, the latest LOG_MAX of them */
static size_t heard_n;
static octet_t pending[PENDING_MAX];
static size_t pending_n;
static unsigned line_sum;
static uint32_t clock_ms;
static unsigned counted_left;

#define REQUIRE(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, #condition); \
            abort(); \
        } \
    } while (0)

/* ---- what was sent, encoded anew from what was delivered ---- */

static size_t put_echo(uint8_t *frame, const scip_request_t *request, unsigned remaining)
{
    const octet_t *echo = scip_request_echo(request);
    const size_t length = request->echo_length;

    for (size_t i = 0; i < length; i++) {
        frame[i] = (uint8_t)echo[i];
    }
    if (request->scan_octets != 0 && request->range.scans != 0) {
        frame[length - 2] = (uint8_t)(48 + remaining / 10);
        frame[length - 1] = (uint8_t)(48 + remaining % 10);
    }
    frame[length] = '\n';
    return length + 1;
}

static size_t put_frame(uint8_t *frame, const scip_request_t *request, unsigned remaining, uint32_t stamp_ms,
                        const uint16_t *distance_mm)
{
    char data[3 * SENT_MAX], echo[FRAME_MAX], text[FRAME_MAX];

    for (unsigned i = 0; i < request->points; i++) {
        scip_frames_encode(data + i * request->characters, distance_mm[i], request->characters);
    }
    echo[put_echo((uint8_t *)echo, request, remaining) - 1] = '\0';
    const size_t length = scip_frames_frame(text, echo, stamp_ms, data,
                                            (size_t)request->characters * request->points);

    memcpy(frame, text, length);
    return length;
}

static bool saturated(const scip_scan_t *scan)
{
    for (unsigned i = 0; i < scan->points; i++) {
        if (scan->distance_mm[i] == UINT16_MAX) {
            return true;
        }
    }
    return false;
}

static void check_scan(const side_t *side)
{
    const scip_scan_t *scan = side->parser.scan;
    const scip_request_t *asked = &side->parser.awaited;
    uint8_t frame[FRAME_MAX];

    REQUIRE(scan != NULL && scan->points == asked->points && scan->points <= POINTS_MAX);
    REQUIRE(scan->characters == asked->characters && scan->first_step == asked->range.first_step);
    REQUIRE(scan->timestamp_ms <= 0xFFFFFFU && scan->remaining <= 99);
    const size_t length = put_frame(frame, asked, scan->remaining, scan->timestamp_ms, scan->distance_mm);
    REQUIRE(length == (asked->scan_octets != 0 ? asked->scan_octets : asked->reply_octets));
    REQUIRE(heard_n >= length && heard_n <= LOG_MAX);
    REQUIRE(saturated(scan) || memcmp(heard + heard_n - length, frame, length) == 0);
    const scip_group_t group = {scan->first_step, asked->range.last_step};
    const scip_group_mean_t mean = scip_group_mean(scan, &group);
    REQUIRE(mean.good_rays <= scan->points && mean.spread_mm <= 5580);
    REQUIRE(mean.good_rays == 0 || (mean.mean_mm >= 20.0F && mean.mean_mm <= 5600.0F));
    REQUIRE(scip_group_step_mm(scan, &group) <= mean.spread_mm);
}

static void check_text(const side_t *side)
{
    REQUIRE(side->parser.text_length <= side->parser.line_length && side->parser.line_length < SCIP_LINE_MAX);
    scip_info_take(&info, &side->parser);
    REQUIRE(memchr(info.vendor, 0, SCIP_INFO_TEXT) != NULL && memchr(info.state, 0, SCIP_INFO_TEXT) != NULL);
    const scip_limits_t limits = scip_info_limits(&info);
    REQUIRE(limits.amin <= limits.afrt && limits.afrt <= limits.amax && limits.amax <= limits.ares);
    REQUIRE(scip_limits_step(&limits, scip_limits_mdeg(&limits, limits.afrt)) == limits.afrt);
}

static void check_reply(const side_t *side)
{
    const scip_reply_t *reply = &side->parser.reply;

    REQUIRE(reply->legacy || (reply->status[0] >= 0x30 && reply->status[0] <= 0x6F));
    REQUIRE(reply->legacy || (reply->status[1] >= 0x30 && reply->status[1] <= 0x6F));
    REQUIRE(reply->timestamp_ms <= 0xFFFFFFU);
}

static void check_counters(const side_t *side)
{
    const scip_counters_t *counters = &side->parser.counters;
    uint32_t damaged = 0;

    for (int cause = 0; cause < SCIP_DAMAGE_COUNT; cause++) {
        damaged += counters->damaged[cause];
    }
    REQUIRE(damaged == side->events[SCIP_DAMAGED] && counters->damaged[SCIP_DAMAGE_NONE] == 0);
    REQUIRE(counters->replies == side->events[SCIP_REPLY] && counters->notices == side->events[SCIP_NOTICE]);
    REQUIRE(counters->legacy == side->events[SCIP_LEGACY] && counters->scans >= side->events[SCIP_SCAN]);
    REQUIRE(side->points[0][POINTS_MAX] == CANARY && side->points[1][POINTS_MAX] == CANARY);
}

static void note(side_t *side, scip_event_t event)
{
    side->events[event]++;
    switch (event) {
    case SCIP_SCAN:
        check_scan(side);
        break;
    case SCIP_REPLY:
    case SCIP_NOTICE:
        check_reply(side);
        break;
    case SCIP_TEXT:
        check_text(side);
        break;
    case SCIP_DAMAGED:
        REQUIRE(side->parser.last_damage > SCIP_DAMAGE_NONE && side->parser.last_damage < SCIP_DAMAGE_COUNT);
        break;
    default:
        break;
    }
}

/* ---- feeding ---- */

/* What waits is fed to the second parser in one burst; both must then agree. */
static void settle(void)
{
    size_t at = 0;

    while (at < pending_n) {
        scip_event_t event;
        const size_t taken = scip_parser_feed_run(&burst.parser, pending + at, pending_n - at, &event);
        REQUIRE(taken > 0 && taken <= pending_n - at);
        at += taken;
        burst.events[event] += event != SCIP_NOTHING;
    }
    pending_n = 0;
    for (int event = SCIP_NOTHING + 1; event <= SCIP_DAMAGED; event++) {
        REQUIRE(burst.events[event] == single.events[event]);
    }
    REQUIRE(memcmp(&burst.parser.counters, &single.parser.counters, sizeof single.parser.counters) == 0);
    check_counters(&single);
    check_counters(&burst);
}

static void hear(uint8_t octet)
{
    if (heard_n == LOG_MAX) {
        memmove(heard, heard + LOG_MAX / 2, LOG_MAX / 2);
        heard_n = LOG_MAX / 2;
    }
    heard[heard_n++] = octet;
    line_sum = octet == '\n' ? 0 : line_sum + octet;
    pending[pending_n++] = octet;
    const scip_event_t event = scip_parser_feed(&single.parser, octet);
    if (event != SCIP_NOTHING) {
        note(&single, event);
    }
    if (pending_n == PENDING_MAX) {
        settle();
    }
}

static void hear_all(const uint8_t *octets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hear(octets[i]);
    }
}

/* ---- operations ---- */

static void expect(uint8_t choice)
{
    static const scip_kind_t plain[] = {SCIP_LASER_OFF_1, SCIP_SWITCH,     SCIP_STOP,  SCIP_TIME_READ,
                                        SCIP_VERSION,     SCIP_PARAMETERS, SCIP_STATE, SCIP_RESET};
    static const scip_range_t ranges[] = {{372, 406, 1, 0, 0}, {384, 384, 1, 0, 0},  {372, 403, 1, 0, 9},
                                          {100, 199, 3, 1, 0}, {372, 406, 1, 0, 99}, {0, 40, 1, 0, 0}};
    scip_request_t request;
    bool built;

    settle();
    if (choice < 0x80) {
        const scip_kind_t kind = (scip_kind_t)(SCIP_STREAM_2 + choice % 4);
        built = scip_request_scan(&request, kind, &ranges[choice / 4 % (sizeof ranges / sizeof ranges[0])]);
    } else {
        built = scip_request(&request, plain[choice % (sizeof plain / sizeof plain[0])]);
    }
    REQUIRE(built);
    counted_left = request.range.scans;
    scip_parser_expect(&single.parser, &request);
    scip_parser_expect(&burst.parser, &request);
}

static void choose_memory(uint8_t choice)
{
    settle();
    scip_parser_scan_into(&single.parser, choice % 3 == 2 ? NULL : &single.scan[choice % 3]);
    scip_parser_scan_into(&burst.parser, choice % 3 == 2 ? NULL : &burst.scan[choice % 3]);
}

static void break_line(void)
{
    settle();
    scip_parser_line_broken(&single.parser);
    scip_parser_line_broken(&burst.parser);
    heard_n = 0;
    line_sum = 0;
}

static void hear_frame(uint8_t seed, bool faulty)
{
    const scip_request_t *request = &single.parser.awaited;
    uint16_t distance_mm[SENT_MAX];
    uint8_t frame[FRAME_MAX];

    if (request->characters == 0) {
        return;
    }
    for (unsigned i = 0; i < request->points; i++) {
        distance_mm[i] = (uint16_t)((seed * 157U + i * (seed % 7U)) % 4096U);
    }
    clock_ms += 100;
    counted_left = counted_left == 0 ? request->range.scans : counted_left;
    counted_left -= counted_left > 0;
    const size_t length = put_frame(frame, request, counted_left, clock_ms & 0xFFFFFF, distance_mm);
    if (faulty) {
        frame[seed % length] ^= (uint8_t)(1U << (seed / 8 % 8));
    }
    hear_all(frame, length);
}

static void hear_echo(void)
{
    uint8_t echo[SCIP_REQUEST_MAX + 1];

    if (single.parser.awaited.echo_length != 0) {
        hear_all(echo, put_echo(echo, &single.parser.awaited, counted_left));
    }
}

static void operate(uint8_t operation, uint8_t argument)
{
    switch (operation) {
    case 0x80:
        hear(argument);
        break;
    case 0x81:
        expect(argument);
        break;
    case 0x82:
        choose_memory(argument);
        break;
    case 0x83:
        break_line();
        break;
    case 0x84:
        hear((uint8_t)(48 + (line_sum & 63)));
        hear('\n');
        break;
    case 0x85:
        hear_echo();
        break;
    case 0x86:
        hear_all((const uint8_t *)"99b\n", 4);
        break;
    default:
        hear_frame(argument, operation == 0x88);
        break;
    }
}

static void start(side_t *side)
{
    memset(side, 0, sizeof *side);
    for (int i = 0; i < 2; i++) {
        side->scan[i] = (scip_scan_t){.distance_mm = side->points[i], .capacity = POINTS_MAX};
        side->points[i][POINTS_MAX] = CANARY;
    }
    scip_parser_init(&side->parser);
    scip_parser_scan_into(&side->parser, &side->scan[0]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    start(&single);
    start(&burst);
    scip_info_init(&info);
    heard_n = pending_n = 0;
    line_sum = counted_left = 0;
    clock_ms = 0;
    expect(0);
    for (size_t i = 0; i < size; i++) {
        if (data[i] >= 0x80 && data[i] <= 0x88) {
            const uint8_t operation = data[i];
            const bool has_argument = operation < 0x83 || operation > 0x86;
            i += has_argument;
            operate(operation, has_argument && i < size ? data[i] : 0);
        } else {
            hear(data[i]);
        }
    }
    settle();
    return 0;
}
