/* Any slice of the parser's line, wherever it lies, of up to SLICE_MOST characters (the longest word has 11),
 * and any line as long: more characters are more of the same. The source is included for its parts. */
#include "drivers/scip_info.c"

#include "prove.h"

#define SLICE_MOST 12U

static scip_parser_t parser;
static scip_info_t info;

static slice_t any_slice(uint16_t most)
{
    const uint16_t begin = nondet_cell();
    const uint16_t length = nondet_cell();

    ASSUME(begin <= SCIP_LINE_MAX && length <= SCIP_LINE_MAX - begin && length <= most);
    return (slice_t){&parser.line[begin], length};
}

static void any_line(void)
{
    scip_parser_t any;
    scip_info_t any_info;

    parser = any;
    info = any_info;
    ASSUME(parser.line_length <= SLICE_MOST && parser.text_length <= parser.line_length);
}

static bool within(slice_t part, slice_t whole)
{
    return part.text >= whole.text && part.length <= whole.length &&
           part.text + part.length <= whole.text + whole.length;
}

void any_slice_is_trimmed(void)
{
    any_line();
    const slice_t slice = any_slice(SLICE_MOST);
    PROVE(within(trimmed(slice), slice), "a part of it");
}

void any_slice_is_searched(void)
{
    any_line();
    (void)contains(any_slice(SLICE_MOST), "malfunction");
}

void any_slice_is_read(void)
{
    uint32_t number;
    uint16_t small;

    any_line();
    const slice_t slice = any_slice(SLICE_MOST);
    PROVE(read_digits(slice, 16U, TIME_DIGITS_MAX, &number) <= TIME_DIGITS_MAX,
          "no more digits than asked for");
    PROVE(number <= (uint32_t)0xFFFFFFUL, "within 24 bits");
    PROVE(read_digits(slice, 10U, DIGITS_MAX, &number) <= DIGITS_MAX, "no more digits than asked for");
    PROVE(number <= (uint32_t)999999999UL, "nine digits");
    (void)read_bit_rate(slice, &number);
    read_small(slice, &small);
}

void any_slice_is_copied(void)
{
    any_line();
    copy(info.vendor, any_slice(SCIP_LINE_MAX));
}

/* What scip_info_take() does with key and value are the parts above. */
void any_line_is_divided(void)
{
    slice_t key, value;

    any_line();
    const slice_t line = any_slice(SLICE_MOST);
    if (divide(line, &key, &value)) {
        PROVE(within(key, line) && within(value, line), "parts of it");
    }
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
