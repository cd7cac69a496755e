/* One octet, or a burst of them, from any sound state of the parser to a sound one: then any octets, however
 * many, leave it sound. Line ends are taken state by state, which is what keeps each proof short. The source
 * is included for its states. */
#include "drivers/scip_parser.c"

#include "prove.h"

#define POINTS_MAX 70U /* blocks begin, go on and end: more points are more of the same */
#define BURST_MAX (SCIP_BLOCK + 4U)

static uint16_t memory[POINTS_MAX];
static scip_scan_t scan;
static scip_parser_t parser;
static octet_t burst[BURST_MAX];
static size_t burst_count;

/* Any answer, after a proof that what is compared is the awaited echo and octets of the line or the burst. */
int memcmp(const void *echo, const void *octets, size_t size)
{
    const octet_t *text = echo, *at = octets;
    const size_t count = size / sizeof *at;

    PROVE(count <= SCIP_REQUEST_MAX, "no more than an echo");
    PROVE(text >= parser.awaited.text && text + count <= parser.awaited.text + SCIP_REQUEST_MAX,
          "of the echo");
    if (__CPROVER_same_object(at, &parser)) {
        PROVE(at >= parser.line && at + count <= parser.line + SCIP_LINE_MAX, "of the line");
    } else {
        PROVE(at >= burst && at + count <= burst + burst_count, "of the burst");
    }
    return (int)nondet_cell();
}

static bool is_sound_request(const scip_request_t *request)
{
    return request->kind < SCIP_KIND_COUNT && request->text_length <= SCIP_REQUEST_MAX &&
           request->echo_length >= 2U && request->echo_length < request->text_length &&
           (request->text[0] != SCIP_LINE_FEED || request->echo_length < request->text_length - 1U) &&
           (request->characters == 2U || request->characters == 3U) && request->points <= POINTS_MAX &&
           request->points > 0U;
}

static bool is_sound_progress(void)
{
    const scip_request_t *awaited = &parser.awaited;

    return parser.characters_left > 0U &&
           parser.characters_left <= (uint32_t)awaited->characters * awaited->points &&
           (awaited->characters != 2U || parser.characters_left % 2U == 0U) &&
           (parser.scan == NULL || scan.capacity >= awaited->points);
}

static bool is_sound(void)
{
    return parser.state <= SCAN_END && parser.gathered < SCIP_LINE_MAX && parser.stamps <= 2U &&
           is_sound_request(&parser.awaited) &&
           parser.echo_fixed + (is_counted(&parser.awaited) ? 2U : 0U) == parser.awaited.echo_length &&
           (parser.state != DATA || is_sound_progress());
}

static void any_sound_state(uint16_t state)
{
    scip_parser_t any;
    scip_scan_t any_scan;

    parser = any;
    parser.state = state;
    scan = any_scan;
    scan.distance_mm = memory;
    ASSUME(scan.capacity <= POINTS_MAX);
    parser.scan = nondet_bool() ? &scan : NULL;
    ASSUME(is_sound());
}

void starts_sound(void)
{
    scip_request_t any;

    scip_parser_init(&parser);
    ASSUME(is_sound_request(&any));
    scip_parser_expect(&parser, &any);
    PROVE(is_sound(), "sound from the first request on");
}

void orders_leave_it_sound(void)
{
    scip_request_t any;

    any_sound_state(nondet_cell());
    ASSUME(is_sound_request(&any));
    if (nondet_bool()) {
        scip_parser_expect(&parser, &any);
    } else if (nondet_bool()) {
        scip_parser_line_broken(&parser);
    } else {
        scip_parser_scan_into(&parser, nondet_bool() ? &scan : NULL);
    }
    (void)scip_parser_expected(&parser);
    PROVE(is_sound(), "sound after any order");
}

/* All octets but a line feed are treated alike. */
void octets_leave_it_sound(void)
{
    any_sound_state(nondet_cell());
    (void)scip_parser_feed(&parser, (octet_t)'x');
    PROVE(is_sound(), "sound after any octet that ends no line");
}

static void end_a_line(uint16_t state)
{
    any_sound_state(state);
    (void)scip_parser_feed(&parser, SCIP_LINE_FEED);
    PROVE(is_sound(), "sound after the end of a line");
}

void line_ends_in_hunt(void)
{
    end_a_line(HUNT);
}

void line_ends_in_echo(void)
{
    end_a_line(ECHO);
}

void line_ends_in_status(void)
{
    end_a_line(STATUS);
}

void line_ends_in_time(void)
{
    end_a_line(TIME);
}

void line_ends_in_text(void)
{
    end_a_line(TEXT);
}

void line_ends_in_reply(void)
{
    end_a_line(REPLY_END);
}

void line_ends_in_legacy(void)
{
    end_a_line(LEGACY_END);
}

void line_ends_in_data(void)
{
    end_a_line(DATA);
}

void line_ends_in_scan(void)
{
    end_a_line(SCAN_END);
}

/* Bursts: what is taken where it lies, and what is copied up to the end of a line. */

static void any_burst(uint16_t state)
{
    octet_t any[BURST_MAX];

    for (size_t i = 0; i < BURST_MAX; i++) {
        burst[i] = any[i];
    }
    burst_count = nondet_size();
    ASSUME(burst_count > 0U && burst_count <= BURST_MAX);
    any_sound_state(state);
}

static void take_in_place(uint16_t state)
{
    any_burst(state);
    PROVE(line_in_place(&parser, burst, burst_count) <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound after octets in place");
}

void echo_in_place_leaves_it_sound(void)
{
    take_in_place(ECHO);
}

void status_in_place_leaves_it_sound(void)
{
    take_in_place(STATUS);
}

void time_in_place_leaves_it_sound(void)
{
    take_in_place(TIME);
}

void block_in_place_leaves_it_sound(void)
{
    take_in_place(DATA);
}

void octets_are_gathered(void)
{
    size_t more;

    any_burst(HUNT);
    more = gather(&parser, burst, burst_count);
    PROVE(more <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound while they are gathered");
}
