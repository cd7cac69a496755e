/* One octet, or a burst of them, from any sound state of the parser to a sound one: then any octets, however
 * many, leave it sound. Line ends are taken state by state, which is what keeps each proof short. A burst has
 * memory of its own length, so that nothing behind it is read. The source is included for its states. */
#include "drivers/scip_parser.c"

#include "prove.h"

void *malloc(size_t size);

#define POINTS_MAX (SCIP_STEP_MAX + 1U)
#define BURST_MAX (SCIP_BLOCK + 4U)

static uint16_t memory[POINTS_MAX];
static scip_scan_t scan;
static scip_parser_t parser;
static octet_t *burst;
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
        PROVE(__CPROVER_r_ok(at, size), "of the burst");
    }
    return (int)nondet_cell();
}

/* What a block's characters are decoded with. */

static check_t any_check(void)
{
    check_t any;

    return any;
}

static bool has_octets(const octet_t *text, uint16_t count)
{
    return count <= SCIP_BLOCK && (text == parser.line || __CPROVER_r_ok(text, count * sizeof text[0]));
}

static bool has_points(const uint16_t *out, uint16_t count)
{
    return out >= memory && out + count <= memory + parser.awaited.points;
}

static check_t decode_pairs(uint16_t *out, const octet_t *text, uint16_t characters)
{
    PROVE(has_octets(text, characters), "octets of the block");
    PROVE(characters % 2U == 0U && has_points(out, characters / 2U), "whole points of the scan");
    return any_check();
}

static check_t decode_triples(uint16_t *out, uint16_t begun, uint32_t *partial, const octet_t *text,
                              uint16_t characters)
{
    PROVE(has_octets(text, characters), "octets of the block");
    PROVE(begun < 3U && has_points(out, (begun + characters) / 3U), "points of the scan");
    *partial = (uint32_t)nondet_size();
    return any_check();
}

static check_t pass(const octet_t *text, uint16_t characters)
{
    PROVE(has_octets(text, characters), "octets of the block");
    return any_check();
}

/* What a burst is taken apart into, and an octet that ends a line: any answer that these were proved to give.
 */

static size_t any_part(const octet_t *octets, size_t count)
{
    const size_t part = nondet_size();

    PROVE(__CPROVER_same_object(octets, burst) && count > 0U && count <= burst_count, "octets of the burst");
    PROVE(__CPROVER_POINTER_OFFSET(octets) + count * sizeof octets[0] == burst_count * sizeof octets[0],
          "what is left of it");
    ASSUME(part <= count);
    return part;
}

static size_t gather(scip_parser_t *any, const octet_t *octets, size_t count)
{
    (void)any;
    return any_part(octets, count);
}

static size_t line_in_place(scip_parser_t *any, const octet_t *octets, size_t count)
{
    (void)any;
    return any_part(octets, count);
}

static size_t line_by_copy(scip_parser_t *any, const octet_t *octets, size_t count, scip_event_t *event)
{
    const size_t part = any_part(octets, count);

    (void)any;
    ASSUME(part > 0U);
    *event = (scip_event_t)(nondet_cell() % (SCIP_DAMAGED + 1U));
    return part;
}

scip_event_t scip_parser_end_line(scip_parser_t *any)
{
    (void)any;
    return (scip_event_t)(nondet_cell() % (SCIP_DAMAGED + 1U));
}

static uint16_t strange_in(const scip_parser_t *any, uint16_t length)
{
    const uint16_t strange = nondet_cell();

    PROVE(any == &parser && length <= SCIP_LINE_MAX, "cells of the line");
    ASSUME(strange <= length);
    return strange;
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
           (parser.state != ECHO || is_stream(&parser.awaited)) &&
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

/* Blocks leave any sound state. */
static size_t blocks_of(const octet_t *octets, size_t count)
{
    const size_t part = nondet_size();

    PROVE(is_sound() && parser.state == DATA, "a block is due");
    PROVE(__CPROVER_same_object(octets, burst) && count <= burst_count, "octets of the burst");
    PROVE(__CPROVER_POINTER_OFFSET(octets) + count * sizeof octets[0] == burst_count * sizeof octets[0],
          "what is left of it");
    ASSUME(part <= count);
    any_sound_state(nondet_cell());
    return part;
}

static size_t block_in_place(scip_parser_t *any, const octet_t *octets, size_t count)
{
    (void)any;
    return blocks_of(octets, count);
}

static size_t blocks_in_place(scip_parser_t *any, const octet_t *octets, size_t count)
{
    (void)any;
    return blocks_of(octets, count);
}

void strange_octets_are_counted(void)
{
    const uint16_t length = nondet_cell();

    any_sound_state(nondet_cell());
    ASSUME(length <= SCIP_LINE_MAX);
    PROVE(strange_in_itself(&parser, length) <= length, "no more than there are");
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
    const scip_event_t event = scip_parser_end_line_itself(&parser);
    PROVE(is_sound(), "sound after the end of a line");
    PROVE(event != SCIP_TEXT ||
              (parser.line_length <= SCIP_LINE_MAX && parser.text_length <= parser.line_length),
          "a text within the line, which scip_info.c is proved for");
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
    burst_count = nondet_size();
    ASSUME(burst_count > 0U && burst_count <= BURST_MAX);
    burst = malloc(burst_count * sizeof burst[0]);
    ASSUME(burst != NULL);
    any_sound_state(state);
}

static void take_in_place(uint16_t state)
{
    any_burst(state);
    PROVE(line_in_place_itself(&parser, burst, burst_count) <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound after octets in place");
}

void head_in_place_leaves_it_sound(void)
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
    any_burst(DATA);
    PROVE(block_in_place_itself(&parser, burst, burst_count) <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound after a block in place");
}

/* In up to 12 parts. */
void blocks_are_taken_one_by_one(void)
{
    any_burst(DATA);
    ASSUME(burst_count <= 12U);
    PROVE(blocks_in_place_itself(&parser, burst, burst_count) <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound after blocks in place");
}

void octets_are_gathered(void)
{
    size_t more;

    any_burst(HUNT);
    more = gather_itself(&parser, burst, burst_count);
    PROVE(more <= burst_count, "no more than there is");
    PROVE(is_sound(), "sound while they are gathered");
}

void any_line_is_copied(void)
{
    scip_event_t event;

    any_burst(nondet_cell());
    const size_t taken = line_by_copy_itself(&parser, burst, burst_count, &event);
    PROVE(taken > 0U && taken <= burst_count, "some, and no more than there is");
}

/* In up to 12 parts: more are more of the same. */
void any_burst_is_taken_apart(void)
{
    scip_event_t event;

    any_burst(nondet_cell());
    ASSUME(burst_count <= 12U);
    PROVE(scip_parser_feed_run(&parser, burst, burst_count, &event) <= burst_count, "no more than there is");
}

/* Blocks of each length, with the octets and the points that they need and none behind them. */

static octet_t text_[SCIP_BLOCK];

void any_block_is_passed(void)
{
    for (uint16_t count = 0U; count <= SCIP_BLOCK; count++) {
        (void)pass_itself(&text_[SCIP_BLOCK - count], count);
    }
}

void any_pairs_are_decoded(void)
{
    for (uint16_t count = 0U; count <= SCIP_BLOCK; count += 2U) {
        (void)decode_pairs_itself(&memory[POINTS_MAX - count / 2U], &text_[SCIP_BLOCK - count], count);
    }
}

static void decode_any_triples(uint16_t begun)
{
    static uint32_t partial;

    for (uint16_t count = 0U; count <= SCIP_BLOCK; count++) {
        partial = (uint32_t)nondet_size();
        (void)decode_triples_itself(&memory[POINTS_MAX - (begun + count) / 3U], begun, &partial,
                                    &text_[SCIP_BLOCK - count], count);
    }
}

void any_triples_are_decoded(void)
{
    decode_any_triples(0U);
}

void any_triples_are_decoded_behind_one(void)
{
    decode_any_triples(1U);
}

void any_triples_are_decoded_behind_two(void)
{
    decode_any_triples(2U);
}
