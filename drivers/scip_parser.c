/* The parser works line by line. Its state is the kind of line that must come next. A line is checked when
 * its LF has arrived. A line of a scan that is complete in the given octets is checked in place, without a
 * copy. Every other line, and every line that fails a check, is first copied to parser->line. Both ways must
 * give the same result; the copy is the reference.
 *
 * The 6-bit sums are weak: one in 64 lines with random content passes. So the parser also checks the echo,
 * the exact lengths, the range of every character and the order of the time stamps. After damage it searches
 * the same line for the next echo, because the line may contain the beginning of the next frame. What breaks:
 * without any one of these checks the programs in tests/faults count wrong distances. */
#include "drivers/scip_parser.h"

#include <string.h>

#define STAMP_MASK ((uint32_t)0xFFFFFFUL)     /* 24 bits, SCIP2.0 */
#define STATUS_OCTETS 4U                      /* two characters, sum, LF */
#define TIME_OCTETS 6U                        /* four characters, sum, LF */
#define STAMP_STEP_MAX_MS ((uint32_t)10000UL) /* chosen: two frames of one stream are closer */

enum {
    HUNT, /* not synchronised: any line may end with the awaited echo */
    ECHO, /* synchronised with a stream: the next line is its echo */
    STATUS,
    TIME,
    TEXT,
    LEGACY_END, /* the empty line after "E" */
    REPLY_END,  /* the empty line after a reply without points */
    DATA,
    SCAN_END /* the empty line after the points */
};

/* Of a scan that was not asked for: what must come next. */
enum {
    FOREIGN_ECHO, /* any line */
    FOREIGN_STATUS,
    FOREIGN_TIME,
    FOREIGN_BLOCK,
    FOREIGN_MORE /* another block, or the empty line */
};

/* What is noted of a line's encoded characters: their sum, in two halves of 16 bits, and all their bits, by
 * which one outside 30H..6FH shows. */
typedef struct {
    uint32_t sums, bits;
} check_t;

static const check_t nothing_checked = {.sums = 0U};

#define FOUR_ZEROS ((uint32_t)0x30303030UL)   /* characters of value 0 */
#define OUTSIDE ((uint32_t)0xC0C0C0C0UL)      /* bits that no encoded character has, its 30H taken off */
#define EVERY_SECOND ((uint32_t)0x00FF00FFUL) /* of four characters */

static bool is_stream(const scip_request_t *request)
{
    return request->kind == SCIP_STREAM_2 || request->kind == SCIP_STREAM_3;
}

/* A run of so many scans, whose echo counts them down. */
static bool is_counted(const scip_request_t *request)
{
    return is_stream(request) && request->range.scans != 0U;
}

static bool has_status(const scip_parser_t *parser, char first, char second)
{
    return parser->reply.status[0] == (octet_t)first && parser->reply.status[1] == (octet_t)second;
}

static bool line_is_empty(const scip_parser_t *parser)
{
    return parser->line_length == 0U;
}

/* SCIP1.1 answers a line that it does not know with E. */
static bool line_is_refusal(const scip_parser_t *parser)
{
    return parser->line_length == 1U && parser->line[0] == (octet_t)'E';
}

/* The low six bits, as a character. */
static uint16_t sum_character(uint16_t sum)
{
    return (uint16_t)((sum & 0x3FU) + 0x30U);
}

static bool read_count(const octet_t *text, uint16_t *count)
{
    uint16_t tens = (uint16_t)(text[0] - 0x30U);
    uint16_t ones = (uint16_t)(text[1] - 0x30U);
    *count = (uint16_t)(10U * tens + ones);
    return tens <= 9U && ones <= 9U;
}

/* True when this is the awaited echo. The last two digits of a counted run's echo are the remaining scans. */
static bool take_echo_at(scip_parser_t *parser, const octet_t *text)
{
    const octet_t *echo = scip_request_echo(&parser->awaited);
    const uint16_t fixed = parser->echo_fixed;
    uint16_t remaining = 0U;
    if (memcmp(echo, text, fixed * sizeof echo[0]) != 0) {
        return false;
    }
    if (fixed < parser->awaited.echo_length && !read_count(&text[fixed], &remaining)) {
        return false;
    }
    parser->remaining = remaining;
    parser->state = STATUS;
    return true;
}

/* True when the line ends in the awaited echo. Octets in front of it may be what is left of a lost frame; the
 * echo of a stream that is in step, with none, is taken without this. */
static bool take_echo(scip_parser_t *parser)
{
    const uint16_t length = parser->awaited.echo_length;
    if (!parser->awaiting || parser->line_length < length ||
        !take_echo_at(parser, &parser->line[parser->line_length - length])) {
        return false;
    }
    parser->gap = true;
    return true;
}

/* For the caller who looks once: the latest cause. */
static void count_damage(scip_parser_t *parser, scip_damage_t cause)
{
    ++parser->counters.damaged[cause];
    parser->last_damage = cause;
}

/* No octet of SCIP: above 7FH, or zero. A much slower sender leaves zeros alone, its start bits. */
static bool is_strange(octet_t octet)
{
    return octet == 0U || octet > 0x7FU;
}

static uint16_t strange_in(const scip_parser_t *parser, uint16_t length)
{
    uint16_t strange = 0U;
    for (uint16_t i = 0U; i < length; ++i) {
        strange = (uint16_t)(strange + (is_strange(parser->line[i]) ? 1U : 0U));
    }
    return strange;
}

static void lose_foreign(scip_parser_t *parser)
{
    parser->foreign_line = FOREIGN_ECHO;
    parser->foreign_before = false;
}

/* Octets of a line that was taken for good are never strange. */
static scip_event_t damage(scip_parser_t *parser, scip_damage_t cause)
{
    if (parser->state == ECHO) {
        parser->foreign_line = FOREIGN_STATUS;
        parser->foreign_before = false;
    } else {
        lose_foreign(parser);
    }
    parser->counters.strange += strange_in(parser, parser->line_length);
    count_damage(parser, cause);
    parser->state = HUNT;
    parser->skipping = !take_echo(parser) && !line_is_empty(parser);
    return SCIP_DAMAGED;
}

/* Octets that are wrong where they lie are copied first, and looked at once more. */
static scip_event_t refuse(scip_parser_t *parser, const octet_t *text, scip_damage_t cause)
{
    return text == parser->line ? damage(parser, cause) : SCIP_DAMAGED;
}

static bool line_has(const scip_parser_t *parser, uint16_t characters)
{
    return parser->line_length == characters + 1U;
}

/* Six bits of an encoded value; the check notes the character. */
static inline uint32_t six_bits(check_t *check, octet_t character)
{
    const uint32_t bits = (uint32_t)octet_of(character) - 0x30U;
    check->sums += bits;
    check->bits |= bits;
    return bits;
}

/* 30H was taken off every character, and belongs to the sum. */
static scip_damage_t verdict(const check_t *check, uint16_t characters, octet_t sum)
{
    const uint32_t total = (check->sums >> 16) + check->sums + (uint32_t)0x30U * characters;
    if ((check->bits & OUTSIDE) != 0U) {
        return SCIP_DAMAGE_CHARACTER;
    }
    return sum == sum_character((uint16_t)total) ? SCIP_DAMAGE_NONE : SCIP_DAMAGE_SUM;
}

/* Nobody wants the points; the sum is checked all the same. */
static check_t pass(const octet_t *text, uint16_t characters)
{
    check_t check = nothing_checked;
    for (uint16_t i = 0U; i < characters; ++i) {
        (void)six_bits(&check, text[i]);
    }
    return check;
}

/* The status of a stream's scan: "99" and its sum. */
static bool is_scan_status(const octet_t *text)
{
    return text[0] == (octet_t)'9' && text[1] == (octet_t)'9' && text[2] == (octet_t)'b';
}

/* Of any line; the last character is the sum. */
static bool sum_is_right(const scip_parser_t *parser)
{
    const uint16_t characters = (uint16_t)(parser->line_length - 1U);
    const check_t check = pass(parser->line, characters);
    return verdict(&check, characters, parser->line[characters]) == SCIP_DAMAGE_NONE;
}

/* The line is not empty. */
static bool foreign_line_fits(const scip_parser_t *parser)
{
    switch (parser->foreign_line) {
    case FOREIGN_ECHO:
        return true;
    case FOREIGN_STATUS:
        return line_has(parser, 2U) && is_scan_status(parser->line);
    case FOREIGN_TIME:
        return line_has(parser, 4U) && sum_is_right(parser);
    default:
        return parser->line_length <= SCIP_BLOCK + 1U && sum_is_right(parser);
    }
}

static void follow_foreign(scip_parser_t *parser)
{
    if (!foreign_line_fits(parser)) {
        lose_foreign(parser);
    } else if (parser->foreign_line != FOREIGN_MORE) {
        ++parser->foreign_line;
    }
}

/* Damage may hit nothing but the echo of the awaited scan; hardly so twice in a row. */
static void end_foreign(scip_parser_t *parser)
{
    const bool whole = parser->foreign_line == FOREIGN_MORE;
    parser->counters.foreign += whole && parser->foreign_before ? 1U : 0U;
    parser->foreign_before = whole;
    parser->foreign_line = FOREIGN_ECHO;
}

static scip_event_t end_of_skipped(scip_parser_t *parser)
{
    bool after_text = parser->skipping;
    parser->skipping = false;
    if (line_is_empty(parser)) {
        parser->counters.stray += after_text ? 1U : 0U;
        end_foreign(parser);
        return SCIP_NOTHING;
    }
    if (take_echo(parser)) {
        return SCIP_NOTHING;
    }
    if (after_text && !parser->flowing && line_is_refusal(parser)) {
        parser->state = LEGACY_END;
        return SCIP_NOTHING;
    }
    parser->skipping = true;
    follow_foreign(parser);
    ++parser->counters.skipped_lines;
    parser->counters.strange += strange_in(parser, parser->line_length);
    return SCIP_NOTHING;
}

static scip_event_t end_of_echo(scip_parser_t *parser)
{
    const bool may_be_echo = parser->line_length == parser->awaited.echo_length;
    if ((may_be_echo && take_echo_at(parser, parser->line)) || take_echo(parser) || line_is_empty(parser)) {
        return SCIP_NOTHING;
    }
    return damage(parser, SCIP_DAMAGE_ECHO);
}

/* The 6-bit values of four characters, in four octets. A character below 30H borrows from the next one, and
 * shows all the same. */
static inline uint32_t four_values(const octet_t *text)
{
    const uint32_t first = octet_of(text[0]);
    const uint32_t second = octet_of(text[1]);
    const uint32_t third = octet_of(text[2]);
    const uint32_t fourth = octet_of(text[3]);
    return (first | (second << 8) | (third << 16) | (fourth << 24)) - FOUR_ZEROS;
}

/* Two values of two characters each, the first in the lower half. */
static inline uint32_t two_values(uint32_t four)
{
    return ((uint32_t)(four & EVERY_SECOND) << 6) | ((four >> 8) & EVERY_SECOND);
}

/* Of up to four times four characters, added up octet by octet. */
static inline void add_sums(check_t *check, uint32_t four)
{
    check->sums += (four & EVERY_SECOND) + ((four >> 8) & EVERY_SECOND);
}

/* Their answers in SCIP1.1 have one status character and no sum. */
static bool speaks_legacy(scip_kind_t kind)
{
    return kind == SCIP_LASER_OFF_1 || kind == SCIP_SWITCH;
}

/* A refusal has nothing behind it. */
static uint16_t state_after_status(const scip_parser_t *parser)
{
    if (!has_status(parser, '0', '0')) {
        return REPLY_END;
    }
    switch (parser->awaited.kind) {
    case SCIP_SINGLE_2:
    case SCIP_SINGLE_3:
    case SCIP_TIME_READ:
        return TIME;
    case SCIP_VERSION:
    case SCIP_PARAMETERS:
    case SCIP_STATE:
        return TEXT;
    default:
        return REPLY_END;
    }
}

static bool take_scan_status(scip_parser_t *parser, const octet_t *text)
{
    if (!is_scan_status(text) || !is_stream(&parser->awaited)) {
        return false;
    }
    parser->state = TIME;
    return true;
}

static scip_event_t end_of_status(scip_parser_t *parser)
{
    const octet_t *line = parser->line;
    check_t check = nothing_checked;
    if (line_is_refusal(parser)) {
        parser->state = LEGACY_END;
        return SCIP_NOTHING;
    }
    if (parser->line_length == 1U && speaks_legacy(parser->awaited.kind)) {
        parser->reply = (scip_reply_t){.status = {line[0], 0U}, .legacy = true};
        parser->state = REPLY_END;
        return SCIP_NOTHING;
    }
    if (!line_has(parser, 2U)) {
        return damage(parser, SCIP_DAMAGE_LENGTH);
    }
    (void)six_bits(&check, line[0]);
    (void)six_bits(&check, line[1]);
    const scip_damage_t cause = verdict(&check, 2U, line[2]);
    if (cause != SCIP_DAMAGE_NONE) {
        return damage(parser, cause);
    }
    parser->reply = (scip_reply_t){.status = {line[0], line[1]}};
    if (is_counted(&parser->awaited) && has_status(parser, '0', '0') &&
        parser->remaining != parser->awaited.range.scans) {
        return damage(parser, SCIP_DAMAGE_ECHO);
    }
    parser->state = state_after_status(parser);
    return SCIP_NOTHING;
}

/* Without memory scans are counted only. */
static bool has_room(const scip_parser_t *parser)
{
    return parser->scan == NULL || parser->scan->capacity >= parser->awaited.points;
}

static void begin_data(scip_parser_t *parser, uint32_t stamp)
{
    parser->timestamp_ms = stamp;
    parser->characters_left = (uint16_t)(parser->awaited.characters * parser->awaited.points);
    parser->partial = 0U;
    parser->state = DATA;
}

/* 24 bits in four characters. */
static uint32_t read_stamp(const octet_t *text, check_t *check)
{
    const uint32_t four = four_values(text);
    const uint32_t halves = two_values(four);
    const uint32_t upper = halves & 0xFFFFU;
    add_sums(check, four);
    check->bits |= four;
    return (upper << 12) | (halves >> 16);
}

static scip_event_t take_time(scip_parser_t *parser, const octet_t *text)
{
    check_t check = nothing_checked;
    const uint32_t stamp = read_stamp(text, &check);
    const scip_damage_t cause = verdict(&check, 4U, text[4]);
    if (cause != SCIP_DAMAGE_NONE) {
        return refuse(parser, text, cause);
    }
    if (parser->awaited.kind == SCIP_TIME_READ) {
        parser->reply.timestamp_ms = stamp;
        parser->state = REPLY_END;
        return SCIP_NOTHING;
    }
    if (!has_room(parser)) {
        return refuse(parser, text, SCIP_DAMAGE_LENGTH);
    }
    begin_data(parser, stamp);
    return SCIP_NOTHING;
}

static scip_event_t end_of_time(scip_parser_t *parser)
{
    return line_has(parser, 4U) ? take_time(parser, parser->line) : damage(parser, SCIP_DAMAGE_LENGTH);
}

/* Two points. Returns their characters' values. */
static inline uint32_t decode_two(uint16_t *out, const octet_t *text)
{
    const uint32_t four = four_values(text);
    const uint32_t two = two_values(four);
    out[0] = (uint16_t)(two & 0xFFFFU);
    out[1] = (uint16_t)(two >> 16);
    return four;
}

/* Eight points; the sums of four characters still fit into an octet. */
static inline void decode_eight(check_t *check, uint16_t *out, const octet_t *text)
{
    const uint32_t first = decode_two(out, text);
    const uint32_t second = decode_two(&out[2], &text[4]);
    const uint32_t third = decode_two(&out[4], &text[8]);
    const uint32_t fourth = decode_two(&out[6], &text[12]);
    check->bits |= first | second | third | fourth;
    add_sums(check, first + second + third + fourth);
}

/* Two characters a point never straddle a block. */
static check_t decode_pairs(uint16_t *out, const octet_t *text, uint16_t characters)
{
    const size_t points = characters / 2U;
    check_t check = nothing_checked;
    size_t i = points % 2U;
    if (i != 0U) {
        const uint32_t upper = six_bits(&check, text[0]);
        out[0] = (uint16_t)((upper << 6) | six_bits(&check, text[1]));
    }
    for (; (points - i) % 8U != 0U; i += 2U) {
        const uint32_t four = decode_two(&out[i], &text[2U * i]);
        check.bits |= four;
        add_sums(&check, four);
    }
    for (; i < points; i += 8U) {
        decode_eight(&check, &out[i], &text[2U * i]);
    }
    return check;
}

/* *partial: the `begun` characters of a point that straddles two blocks. */
static check_t decode_triples(uint16_t *out, uint16_t begun, uint32_t *partial, const octet_t *text,
                              uint16_t characters)
{
    check_t check = nothing_checked;
    uint32_t point = *partial;
    for (uint16_t i = 0U; i < characters; ++i) {
        point = (point << 6) | six_bits(&check, text[i]);
        ++begun;
        if (begun == 3U) {
            *out = (uint16_t)(point > 0xFFFFU ? 0xFFFFU : point);
            ++out;
            point = 0U;
            begun = 0U;
        }
    }
    *partial = point;
    return check;
}

/* The next characters of the scan. Of a block that is in doubt only points have changed that nobody has
 * seen. */
static check_t decode(const scip_parser_t *parser, uint32_t *partial, const octet_t *text,
                      uint16_t characters)
{
    const scip_request_t *request = &parser->awaited;
    if (parser->scan == NULL) {
        return pass(text, characters);
    }
    uint16_t *points = parser->scan->distance_mm;
    if (request->characters == 2U) {
        return decode_pairs(&points[request->points - parser->characters_left / 2U], text, characters);
    }
    const uint16_t done = (uint16_t)(3U * request->points - parser->characters_left);
    return decode_triples(&points[done / 3U], done % 3U, partial, text, characters);
}

/* All blocks but the last have 64. */
static uint16_t characters_of_block(const scip_parser_t *parser)
{
    return parser->characters_left < SCIP_BLOCK ? parser->characters_left : (uint16_t)SCIP_BLOCK;
}

/* A quick look at the octet where the awaited echo would begin. */
static bool may_end_in_echo(const scip_parser_t *parser, const octet_t *line, size_t line_length)
{
    const uint16_t length = parser->awaited.echo_length;
    return line_length >= length && line[line_length - length] == parser->echo_first;
}

/* A line of a block's length. What is left of a frame that was cut short may, with the next frame's echo
 * behind it, have that length and a right sum. */
static scip_event_t take_block(scip_parser_t *parser, const octet_t *text, uint16_t characters)
{
    uint32_t partial = parser->partial;
    const check_t check = decode(parser, &partial, text, characters);
    const scip_damage_t cause = verdict(&check, characters, text[characters]);
    if (may_end_in_echo(parser, text, characters + 1U) && (text != parser->line || take_echo(parser))) {
        return refuse(parser, text, SCIP_DAMAGE_LENGTH);
    }
    if (cause != SCIP_DAMAGE_NONE) {
        return refuse(parser, text, cause);
    }
    parser->partial = partial;
    parser->characters_left = (uint16_t)(parser->characters_left - characters);
    if (parser->characters_left == 0U) {
        parser->state = SCAN_END;
    }
    return SCIP_NOTHING;
}

static scip_event_t end_of_data(scip_parser_t *parser)
{
    const uint16_t characters = characters_of_block(parser);
    return line_has(parser, characters) ? take_block(parser, parser->line, characters)
                                        : damage(parser, SCIP_DAMAGE_LENGTH);
}

static bool stamp_follows(const scip_parser_t *parser)
{
    if (parser->stamps == 0U) {
        return true;
    }
    if (parser->timestamp_ms == parser->last_stamps_ms[0]) {
        return false;
    }
    for (uint16_t i = 0U; i < parser->stamps; ++i) {
        if (((parser->timestamp_ms - parser->last_stamps_ms[i]) & STAMP_MASK) <= STAMP_STEP_MAX_MS) {
            return true;
        }
    }
    return false;
}

/* Of the counter of a counted run. */
static bool has_fallen_by_one(const scip_parser_t *parser)
{
    return parser->remaining + 1U == parser->latest_remaining;
}

/* The counter has no sum, so it is held against the one before only when that one is beyond doubt. */
static bool counter_follows(const scip_parser_t *parser)
{
    return !is_counted(&parser->awaited) || parser->gap || !parser->in_step || has_fallen_by_one(parser);
}

/* A stamp follows when it is ahead of one of the last two seen, so a wrong one whose sum was right harms no
 * later one. No two frames in a row are dropped here, so a restarted clock or a wrong counter costs one scan.
 */
static bool take_sequence(scip_parser_t *parser)
{
    bool follows = parser->doubted || (stamp_follows(parser) && counter_follows(parser));
    parser->last_stamps_ms[1] = parser->last_stamps_ms[0];
    parser->last_stamps_ms[0] = parser->timestamp_ms;
    if (parser->stamps < 2U) {
        ++parser->stamps;
    }
    parser->doubted = !follows;
    if (follows) {
        parser->in_step = !parser->gap && has_fallen_by_one(parser);
        parser->latest_remaining = parser->remaining;
        parser->gap = false;
    }
    return follows;
}

/* The description comes with the points, and only now: until the last sum nothing of it is true. */
static scip_event_t deliver(const scip_parser_t *parser)
{
    scip_scan_t *scan = parser->scan;
    if (scan == NULL) {
        return SCIP_NOTHING;
    }
    scan->points = parser->awaited.points;
    scan->characters = parser->awaited.characters;
    scan->first_step = parser->awaited.range.first_step;
    scan->cluster = parser->awaited.range.cluster;
    scan->remaining = parser->remaining;
    scan->timestamp_ms = parser->timestamp_ms;
    return SCIP_SCAN;
}

static scip_event_t end_of_scan(scip_parser_t *parser)
{
    if (!line_is_empty(parser)) {
        return damage(parser, SCIP_DAMAGE_LENGTH);
    }
    if (is_stream(&parser->awaited)) {
        parser->flowing = true;
        parser->state = ECHO;
        if (!take_sequence(parser)) {
            count_damage(parser, SCIP_DAMAGE_SEQUENCE);
            return SCIP_DAMAGED;
        }
    } else {
        parser->awaiting = false;
        parser->state = HUNT;
    }
    ++parser->counters.scans;
    return deliver(parser);
}

/* The answer "00" to the order: clock and counter begin anew. */
static void begin_stream(scip_parser_t *parser)
{
    parser->flowing = true;
    parser->gap = false;
    parser->doubted = false;
    parser->stamps = 0U;
    parser->latest_remaining = parser->awaited.range.scans;
    parser->in_step = true;
    parser->state = ECHO;
}

static scip_event_t end_of_reply(scip_parser_t *parser)
{
    if (!line_is_empty(parser)) {
        return damage(parser, SCIP_DAMAGE_LENGTH);
    }
    parser->state = HUNT;
    if (is_stream(&parser->awaited) && parser->reply.status[0] >= (octet_t)'2') {
        parser->gap = true;
        parser->flowing = true;
        parser->state = ECHO;
        ++parser->counters.notices;
        return SCIP_NOTICE;
    }
    ++parser->counters.replies;
    parser->awaiting = is_stream(&parser->awaited) && has_status(parser, '0', '0');
    if (parser->awaiting) {
        begin_stream(parser);
    }
    return SCIP_REPLY;
}

/* Until its empty line an E may be the rest of a damaged line. */
static scip_event_t end_of_legacy(scip_parser_t *parser)
{
    if (!line_is_empty(parser)) {
        return damage(parser, SCIP_DAMAGE_LENGTH);
    }
    parser->state = HUNT;
    ++parser->counters.legacy;
    return SCIP_LEGACY;
}

static scip_event_t end_of_text(scip_parser_t *parser)
{
    const octet_t *line = parser->line;
    uint16_t length = parser->line_length;
    uint16_t sum = 0U;
    if (length == 0U) {
        return end_of_reply(parser);
    }
    parser->text_length = length;
    parser->text_proved = false;
    if (length >= 2U && line[length - 2U] == (octet_t)';') {
        parser->text_length = (uint16_t)(length - 2U);
        for (uint16_t i = 0U; i < parser->text_length; ++i) {
            sum = (uint16_t)(sum + line[i]);
        }
        parser->text_proved = line[length - 1U] == sum_character(sum);
    }
    return SCIP_TEXT;
}

static scip_event_t end_of_other_line(scip_parser_t *parser)
{
    switch (parser->state) {
    case ECHO:
        return end_of_echo(parser);
    case STATUS:
        return end_of_status(parser);
    case TEXT:
        return end_of_text(parser);
    case REPLY_END:
        return end_of_reply(parser);
    case LEGACY_END:
        return end_of_legacy(parser);
    default:
        return end_of_skipped(parser);
    }
}

/* No octet of a line is a LF, so one in the last cell tells that the line has not come so far. */
static void begin_line(scip_parser_t *parser)
{
    parser->gathered = 0U;
    parser->line[SCIP_LINE_MAX - 1U] = SCIP_LINE_FEED;
}

static bool has_filled_memory(const scip_parser_t *parser)
{
    return parser->line[SCIP_LINE_MAX - 1U] != SCIP_LINE_FEED;
}

/* Octets of the present line that its memory holds. */
static uint16_t held(const scip_parser_t *parser)
{
    return (uint16_t)(has_filled_memory(parser) ? SCIP_LINE_MAX : parser->gathered);
}

uint32_t scip_parser_octets(const scip_parser_t *parser)
{
    return parser->counters.octets + held(parser);
}

uint32_t scip_parser_strange(const scip_parser_t *parser)
{
    return parser->counters.strange + strange_in(parser, held(parser));
}

void scip_parser_init(scip_parser_t *parser)
{
    *parser = (scip_parser_t){.state = HUNT};
    begin_line(parser);
}

void scip_parser_expect(scip_parser_t *parser, const scip_request_t *request)
{
    parser->awaited = *request;
    parser->echo_fixed = (uint16_t)(request->echo_length - (is_counted(request) ? 2U : 0U));
    parser->echo_first = *scip_request_echo(&parser->awaited);
    parser->awaiting = true;
    parser->state = HUNT;
    parser->skipping = false;
    parser->flowing = false;
    parser->stamps = 0U;
}

/* Blocks already decoded lie in the old memory: the scan under way is lost. */
void scip_parser_scan_into(scip_parser_t *parser, scip_scan_t *scan)
{
    if (parser->state == DATA || parser->state == SCAN_END) {
        parser->state = HUNT;
    }
    parser->scan = scan;
}

void scip_parser_line_broken(scip_parser_t *parser)
{
    parser->state = HUNT;
    parser->skipping = false;
    lose_foreign(parser);
    parser->counters.strange += strange_in(parser, held(parser));
    parser->counters.octets += held(parser);
    begin_line(parser);
}

/* The memory is a ring by now: its newest octets to its begin. Its strange ones are counted already, and in
 * no echo: blanks in their place. */
static void keep_end_of_line(scip_parser_t *parser)
{
    const size_t first = parser->gathered + SCIP_LINE_MAX - SCIP_REQUEST_MAX;
    octet_t end[SCIP_REQUEST_MAX];
    for (uint16_t i = 0U; i < SCIP_REQUEST_MAX; ++i) {
        const octet_t octet = parser->line[(first + i) % SCIP_LINE_MAX];
        end[i] = is_strange(octet) ? (octet_t)' ' : octet;
    }
    for (uint16_t i = 0U; i < SCIP_REQUEST_MAX; ++i) {
        parser->line[i] = end[i];
    }
    parser->line_length = SCIP_REQUEST_MAX;
}

/* Of a line longer than its memory the end is looked at, where the awaited echo may be. */
static scip_event_t end_long_line(scip_parser_t *parser)
{
    parser->counters.strange += strange_in(parser, SCIP_LINE_MAX);
    parser->counters.octets += SCIP_LINE_MAX + 1U;
    keep_end_of_line(parser);
    begin_line(parser);
    switch (parser->state) {
    case HUNT:
    case ECHO:
        return end_of_other_line(parser);
    case TEXT:
        ++parser->counters.skipped_lines;
        return SCIP_NOTHING;
    default:
        return damage(parser, SCIP_DAMAGE_LENGTH);
    }
}

/* Once per line, in an interrupt: the common lines first. */
scip_event_t scip_parser_end_line(scip_parser_t *parser)
{
    if (has_filled_memory(parser)) {
        return end_long_line(parser);
    }
    parser->line_length = parser->gathered;
    parser->counters.octets += parser->line_length + 1U;
    parser->gathered = 0U;
    switch (parser->state) { /* lines of a scan: most lines, at the least cost */
    case DATA:
        return end_of_data(parser);
    case STATUS:
        if (line_has(parser, 2U) && take_scan_status(parser, parser->line)) {
            return SCIP_NOTHING;
        }
        return end_of_other_line(parser);
    case TIME:
        return end_of_time(parser);
    case SCAN_END:
        return end_of_scan(parser);
    default:
        return end_of_other_line(parser);
    }
}

/* Copies octets up to the end of the line. Returns how many. */
static size_t gather(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    size_t at = parser->gathered;
    size_t i = 0U;
    while (i < count && octet_of(octets[i]) != SCIP_LINE_FEED) {
        parser->line[at] = octet_of(octets[i]);
        at = (at + 1U) % SCIP_LINE_MAX;
        ++i;
    }
    parser->gathered = (octet_t)at;
    return i;
}

/* A line of so many octets, its LF not counted, lies whole in the octets. */
static bool has_whole(const octet_t *octets, size_t count, size_t length)
{
    return count > length && octets[length] == SCIP_LINE_FEED;
}

/* A block that lies whole in the octets. Returns how many octets it has, or 0 when there is any doubt. */
static size_t block_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    const uint16_t characters = characters_of_block(parser);
    const size_t length = characters + 1U;
    return has_whole(octets, count, length) && take_block(parser, octets, characters) == SCIP_NOTHING
               ? length + 1U
               : 0U;
}

static size_t blocks_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    size_t taken = 0U;
    size_t block;
    do {
        block = block_in_place(parser, &octets[taken], count - taken);
        taken += block;
    } while (block > 0U && parser->state == DATA);
    return taken;
}

/* The echo of a stream that is in step (no other request has the state ECHO), likewise; and the two lines
 * that follow, where they are those of a scan. */
static size_t head_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    const size_t status = parser->awaited.echo_length + 1U;
    const size_t time = status + STATUS_OCTETS;
    if (count < time + TIME_OCTETS) {
        return has_whole(octets, count, status - 1U) && take_echo_at(parser, octets) ? status : 0U;
    }
    if (octets[status - 1U] != SCIP_LINE_FEED || !take_echo_at(parser, octets)) {
        return 0U;
    }
    if (octets[time - 1U] != SCIP_LINE_FEED || octets[time + TIME_OCTETS - 1U] != SCIP_LINE_FEED ||
        !is_scan_status(&octets[status])) {
        return status;
    }
    parser->state = TIME;
    if (take_time(parser, &octets[time]) != SCIP_NOTHING) {
        return time;
    }
    return time + TIME_OCTETS +
           blocks_in_place(parser, &octets[time + TIME_OCTETS], count - time - TIME_OCTETS);
}

static size_t status_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    return has_whole(octets, count, STATUS_OCTETS - 1U) && take_scan_status(parser, octets) ? STATUS_OCTETS
                                                                                            : 0U;
}

static size_t time_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    return has_whole(octets, count, TIME_OCTETS - 1U) && take_time(parser, octets) == SCIP_NOTHING
               ? TIME_OCTETS
               : 0U;
}

static size_t line_in_place(scip_parser_t *parser, const octet_t *octets, size_t count)
{
    switch (parser->state) {
    case DATA:
        return blocks_in_place(parser, octets, count);
    case ECHO:
        return head_in_place(parser, octets, count);
    case STATUS:
        return status_in_place(parser, octets, count);
    case TIME:
        return time_in_place(parser, octets, count);
    default:
        return 0U;
    }
}

/* Copies octets of the present line; *event is what its end brings. Returns how many were taken. */
static size_t line_by_copy(scip_parser_t *parser, const octet_t *octets, size_t count, scip_event_t *event)
{
    const size_t more = gather(parser, octets, count);
    if (more == count) {
        return more;
    }
    *event = scip_parser_end_line(parser);
    return more + 1U;
}

size_t scip_parser_feed_run(scip_parser_t *parser, const octet_t *octets, size_t count, scip_event_t *event)
{
    size_t taken = 0U;
    *event = SCIP_NOTHING;
    if (parser->gathered > 0U || has_filled_memory(parser)) {
        taken = line_by_copy(parser, octets, count, event);
    }
    while (*event == SCIP_NOTHING && taken < count) {
        const size_t in_place = line_in_place(parser, &octets[taken], count - taken);
        parser->counters.octets += (uint32_t)in_place;
        taken += in_place > 0U ? in_place : line_by_copy(parser, &octets[taken], count - taken, event);
    }
    return taken;
}

/* From the present line's first octet on. */
static uint32_t expected_from_line(const scip_parser_t *parser)
{
    const uint32_t scan = parser->awaited.scan_octets;
    const uint32_t echo = (uint32_t)parser->awaited.echo_length + 1U;
    const uint32_t left = parser->characters_left;
    const uint32_t blocks = (left + SCIP_BLOCK - 1U) / SCIP_BLOCK;
    switch (parser->state) {
    case ECHO:
        return scan;
    case STATUS:
        return scan == 0U ? 0U : scan - echo;
    case TIME:
        return scan == 0U ? 0U : scan - echo - STATUS_OCTETS;
    case DATA:
        return left + 2U * blocks + 1U;
    case LEGACY_END:
    case REPLY_END:
    case SCAN_END:
        return 1U;
    default:
        return 0U;
    }
}

uint16_t scip_parser_expected(const scip_parser_t *parser)
{
    const uint32_t whole = expected_from_line(parser);
    return parser->gathered < whole ? (uint16_t)(whole - parser->gathered) : 0U;
}

uint32_t scip_unwrap_ms(uint32_t unwrapped_ms, uint32_t timestamp_ms)
{
    return unwrapped_ms + ((timestamp_ms - unwrapped_ms) & STAMP_MASK);
}
