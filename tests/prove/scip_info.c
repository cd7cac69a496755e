/* scip_info.c, its own source included: any line that the parser can hand over. Every function is proved by
 * itself, for slices that end where their memory ends, so that nothing behind a slice is read;
 * in the proofs of its callers it is replaced by what it needs and what it was proved to give (prove.py,
 * APART). */
#include "drivers/scip_info.c"

#include "prove.h"

#define WORDS "malfunction" /* the longest */

static scip_parser_t parser;
static scip_info_t info;
static struct {
    octet_t octets[SCIP_LINE_MAX];
} held;
static octet_t *const memory = held.octets;
static char text_[SCIP_INFO_TEXT];

/* Of any octets: what is static would be zeros, and no digit among them. */
static slice_t any_slice(void)
{
    const uint16_t length = nondet_cell();
    __typeof__(held) any;

    held = any;
    ASSUME(length <= SCIP_LINE_MAX);
    return (slice_t){&memory[SCIP_LINE_MAX - length], length};
}

/* For loops of which each round sees what is left of the slice, or looks at one octet more: what holds for 64
 * rounds holds for more of the same. */
static slice_t any_short_slice(void)
{
    const slice_t slice = any_slice();

    ASSUME(slice.length <= 64U);
    return slice;
}

static bool is_slice(slice_t slice)
{
    const octet_t *begin = __CPROVER_same_object(slice.text, memory) ? memory : parser.line;

    return __CPROVER_same_object(slice.text, begin) && slice.text >= begin && slice.length <= SCIP_LINE_MAX &&
           slice.text + slice.length <= begin + SCIP_LINE_MAX;
}

static bool within(slice_t part, slice_t whole)
{
    return part.text >= whole.text && part.length <= whole.length &&
           part.text + part.length <= whole.text + whole.length;
}

static slice_t any_part(slice_t whole)
{
    const uint16_t begin = nondet_cell();
    const uint16_t length = nondet_cell();

    ASSUME(begin <= whole.length && length <= whole.length - begin);
    return (slice_t){&whole.text[begin], length};
}

/* ---- what each part needs, and gives ---- */

static slice_t trimmed(slice_t slice)
{
    PROVE(is_slice(slice), "a slice");
    return any_part(slice);
}

static bool begins_with(slice_t slice, const char *words)
{
    PROVE(is_slice(slice), "a slice");
    PROVE(words[0] != '\0', "words");
    return nondet_bool();
}

static bool contains(slice_t slice, const char *words)
{
    return begins_with(slice, words);
}

static uint16_t read_digits(slice_t slice, uint16_t base, uint16_t most, uint32_t *number)
{
    const uint16_t digits = nondet_cell();

    PROVE(is_slice(slice), "a slice");
    PROVE((base == 10U && most <= DIGITS_MAX) || (base == 16U && most <= TIME_DIGITS_MAX), "within 32 bits");
    *number = nondet_size();
    ASSUME(digits <= slice.length && digits <= most);
    return digits;
}

static void read_small(slice_t slice, uint16_t *number)
{
    PROVE(is_slice(slice), "a slice");
    PROVE(number == &info.told.dmin_mm || number == &info.told.dmax_mm || number == &info.told.ares ||
              number == &info.told.amin || number == &info.told.amax || number == &info.told.afrt ||
              number == &info.told.scan_rpm || number == &info.speed_rpm,
          "a number of the information");
    *number = nondet_cell();
}

static void copy(char *text, slice_t value)
{
    PROVE(is_slice(value), "a slice");
    PROVE(text == info.vendor || text == info.product || text == info.firmware || text == info.protocol ||
              text == info.serial || text == info.model || text == info.mode || text == info.state,
          "a text of the information");
}

static scip_health_t health_of(slice_t state)
{
    PROVE(is_slice(state), "a slice");
    return (scip_health_t)(nondet_cell() % 3U);
}

static bool divide(slice_t line, slice_t *key, slice_t *value)
{
    PROVE(is_slice(line), "a slice");
    *key = any_part(line);
    *value = any_part(line);
    return nondet_bool();
}

/* ---- the proofs ---- */

void any_slice_is_trimmed(void)
{
    const slice_t slice = any_short_slice();

    PROVE(within(trimmed_itself(slice), slice), "a part of it");
}

void any_slice_may_begin_with_words(void)
{
    (void)begins_with_itself(any_slice(), WORDS);
}

void any_slice_is_searched(void)
{
    (void)contains_itself(any_short_slice(), WORDS);
}

void any_decimal_digits_are_read(void)
{
    const slice_t slice = any_slice();
    uint32_t number;
    const uint16_t digits = read_digits_itself(slice, 10U, DIGITS_MAX, &number);

    PROVE(digits <= DIGITS_MAX && digits <= slice.length, "no more digits than asked for");
    PROVE(number <= (uint32_t)999999999UL, "nine digits");
}

void any_hexadecimal_digits_are_read(void)
{
    const slice_t slice = any_slice();
    uint32_t number;
    const uint16_t digits = read_digits_itself(slice, 16U, TIME_DIGITS_MAX, &number);

    PROVE(digits <= TIME_DIGITS_MAX && digits <= slice.length, "no more digits than asked for");
    PROVE(number <= (uint32_t)0xFFFFFFUL, "within 24 bits");
}

void any_number_is_found(void)
{
    uint32_t wide;
    uint16_t small;

    read_small_itself(any_short_slice(), &small);
    (void)read_bit_rate(any_short_slice(), &wide);
}

void any_slice_is_copied(void)
{
    copy_itself(text_, any_slice());
}

void any_state_has_a_health(void)
{
    (void)health_of_itself(any_slice());
}

void any_line_is_divided(void)
{
    const slice_t line = any_short_slice();
    slice_t key, value;

    if (divide_itself(line, &key, &value)) {
        PROVE(within(key, line) && within(value, line), "parts of it");
    }
}

/* scip_parser.c proves the lengths, for each line that it hands over. */
void any_line_is_taken(void)
{
    scip_parser_t any;
    scip_info_t any_info;

    parser = any;
    info = any_info;
    ASSUME(parser.line_length <= SCIP_LINE_MAX && parser.text_length <= parser.line_length);
    scip_info_take(&info, &parser);
}

void any_limits_give_directions(void)
{
    scip_info_t any;
    const uint16_t step = nondet_cell();
    const int32_t mdeg = (int32_t)nondet_size();
    const scip_limits_t limits = scip_info_limits(&any);

    ASSUME(step <= STEP_MAX);
    PROVE(limits.ares > 0U && limits.ares <= STEP_MAX && limits.amax <= limits.ares,
          "limits that fit together");
    (void)scip_limits_mdeg(&limits, step);
    const uint16_t nearest = scip_limits_step(&limits, mdeg);
    PROVE(nearest >= limits.amin && nearest <= limits.amax, "a step that is measured");
}
