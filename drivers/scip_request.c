#include "drivers/scip_request.h"

#include <stddef.h>

#define STREAM_FRAME 27U /* a frame's octets around its data blocks: echo, status, time stamp, line ends */
#define SINGLE_FRAME 24U /* octets of GS and GD without points, scip_request.h */
#define STREAM_REPLY 21U /* echo of 15 and LF, status of 3 and LF, LF */

typedef struct {
    const char *symbol;
    uint16_t reply_octets;
    uint16_t characters;
} command_t;

/* Symbol, octets of the reply when accepted (0: as many as there are points, or lines), characters a point.
 */
static const command_t commands[SCIP_KIND_COUNT] = {
    [SCIP_LASER_OFF_1] = {"L0", 6U, 0U},        [SCIP_SWITCH] = {"SCIP2.0", 11U, 0U},
    [SCIP_BIT_RATE] = {"SS", 14U, 0U},          [SCIP_STOP] = {"QT", 8U, 0U},
    [SCIP_LASER_ON] = {"BM", 8U, 0U},           [SCIP_RESET] = {"RS", 8U, 0U},
    [SCIP_TIME_ENTER] = {"TM0", 9U, 0U},        [SCIP_TIME_READ] = {"TM1", 15U, 0U},
    [SCIP_TIME_LEAVE] = {"TM2", 9U, 0U},        [SCIP_VERSION] = {"VV", 0U, 0U},
    [SCIP_PARAMETERS] = {"PP", 0U, 0U},         [SCIP_STATE] = {"II", 0U, 0U},
    [SCIP_STREAM_2] = {"MS", STREAM_REPLY, 2U}, [SCIP_STREAM_3] = {"MD", STREAM_REPLY, 3U},
    [SCIP_SINGLE_2] = {"GS", 0U, 2U},           [SCIP_SINGLE_3] = {"GD", 0U, 3U},
};

const uint32_t scip_bit_rates[SCIP_BIT_RATES] = {19200UL, 57600UL, 115200UL, 250000UL, 500000UL, 750000UL};

static bool is_stream(scip_kind_t kind)
{
    return kind == SCIP_STREAM_2 || kind == SCIP_STREAM_3;
}

static void append_symbol(scip_request_t *request, const char *symbol)
{
    while (*symbol != '\0') {
        request->text[request->text_length] = octet_of((uint16_t)*symbol);
        ++request->text_length;
        ++symbol;
    }
}

/* Fixed width, from the last digit on. */
static void append_number(scip_request_t *request, uint32_t number, uint16_t digits)
{
    uint16_t position = (uint16_t)(request->text_length + digits);
    request->text_length = position;
    while (digits > 0U) {
        --digits;
        --position;
        request->text[position] = octet_of((uint16_t)(0x30U + (uint16_t)(number % 10U)));
        number /= 10U;
    }
}

static void begin(scip_request_t *request, scip_kind_t kind)
{
    *request = (scip_request_t){.kind = kind};
    request->reply_octets = commands[kind].reply_octets;
    request->characters = commands[kind].characters;
    append_symbol(request, commands[kind].symbol);
}

/* What stands so far is what the sensor echoes. */
static void finish(scip_request_t *request)
{
    request->echo_length = request->text_length;
    request->text[request->text_length] = SCIP_LINE_FEED;
    ++request->text_length;
}

uint16_t scip_scan_octets(scip_kind_t kind, uint16_t points)
{
    uint16_t characters = (uint16_t)(commands[kind].characters * points);
    uint16_t blocks = (uint16_t)((characters + SCIP_BLOCK - 1U) / SCIP_BLOCK);
    if (commands[kind].characters == 0U) {
        return 0U;
    }
    return (uint16_t)((is_stream(kind) ? STREAM_FRAME : SINGLE_FRAME) + characters + 2U * blocks);
}

bool scip_request(scip_request_t *request, scip_kind_t kind)
{
    if (kind >= SCIP_KIND_COUNT || kind == SCIP_BIT_RATE || commands[kind].characters != 0U) {
        return false;
    }
    begin(request, kind);
    finish(request);
    return true;
}

bool scip_request_bit_rate(scip_request_t *request, uint32_t bit_rate)
{
    for (size_t i = 0U; i < SCIP_BIT_RATES; ++i) {
        if (scip_bit_rates[i] == bit_rate) {
            begin(request, SCIP_BIT_RATE);
            request->bit_rate = bit_rate;
            append_number(request, bit_rate, 6U);
            finish(request);
            return true;
        }
    }
    return false;
}

static bool in_range(const scip_range_t *range)
{
    return range->first_step <= range->last_step && range->last_step <= SCIP_STEP_MAX &&
           range->cluster >= 1U && range->cluster <= 99U && range->interval <= 9U && range->scans <= 99U;
}

bool scip_request_scan(scip_request_t *request, scip_kind_t kind, const scip_range_t *range)
{
    if (kind >= SCIP_KIND_COUNT || commands[kind].characters == 0U || !in_range(range)) {
        return false;
    }
    /* begin() clears the request. */
    const scip_range_t asked = *range; /* may be request->range */
    begin(request, kind);
    request->range = asked;
    request->points = (uint16_t)((asked.last_step - asked.first_step + asked.cluster) / asked.cluster);
    append_number(request, asked.first_step, 4U);
    append_number(request, asked.last_step, 4U);
    append_number(request, asked.cluster, 2U);
    if (is_stream(kind)) {
        append_number(request, asked.interval, 1U);
        append_number(request, asked.scans, 2U);
        request->scan_octets = scip_scan_octets(kind, request->points);
    } else {
        request->reply_octets = scip_scan_octets(kind, request->points);
    }
    finish(request);
    return true;
}

/* Moved from the end on, because both places overlap. */
static void put_in_front(scip_request_t *request, const char *text, uint16_t length)
{
    const uint16_t before = request->text_length;
    request->text_length = (uint16_t)(before + length);
    for (uint16_t i = 1U; i <= before; ++i) {
        request->text[request->text_length - i] = request->text[before - i];
    }
    for (uint16_t i = 0U; i < length; ++i) {
        request->text[i] = (octet_t)text[i];
    }
}

void scip_request_end_line_first(scip_request_t *request)
{
    if (request->text[0] != SCIP_LINE_FEED) {
        put_in_front(request, "\n", 1U);
    }
}

void scip_request_leave_time_first(scip_request_t *request)
{
    scip_request_end_line_first(request);
    put_in_front(request, "\nTM2", 4U);
}
