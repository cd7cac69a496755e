#include "drivers/telemetry.h"

#include <string.h>

#include "drivers/decimal.h"
#include "drivers/line_sum.h"

/* Of 2^32 - 1. */
#define COUNT_DIGITS_MAX 10U

void telemetry_begin(telemetry_line_t *line)
{
    line->length = 0U;
    line->limit = TELEMETRY_LINE_MAX;
    line->overflowed = false;
}

void telemetry_begin_answer(telemetry_line_t *line)
{
    telemetry_begin(line);
    line->limit = TELEMETRY_ANSWER_MAX;
}

/* What does not fit is left out whole, and so is all that follows: half a number would be a wrong number. */
void telemetry_characters(telemetry_line_t *line, const char *text, size_t length)
{
    if (line->overflowed || length > (size_t)(line->limit - line->length)) {
        line->overflowed = true;
        return;
    }
    (void)memcpy(&line->text[line->length], text, length);
    line->length = (uint16_t)(line->length + length);
}

void telemetry_text(telemetry_line_t *line, const char *text)
{
    telemetry_characters(line, text, strlen(text));
}

/* A value that has no digits (NaN, or too large) is a dash: the field stays, and no reader takes it for 0. */
static void add_number(telemetry_line_t *line, const char *text, size_t length)
{
    if (length == 0U) {
        telemetry_text(line, "-");
    } else {
        telemetry_characters(line, text, length);
    }
}

void telemetry_fixed(telemetry_line_t *line, float value, uint16_t decimals)
{
    char text[DECIMAL_TEXT_MAX];

    add_number(line, text, decimal_write(text, DECIMAL_TEXT_MAX, value, decimals));
}

void telemetry_number(telemetry_line_t *line, float value)
{
    char text[DECIMAL_TEXT_MAX];

    add_number(line, text, decimal_write_shortest(text, DECIMAL_TEXT_MAX, value));
}

void telemetry_count(telemetry_line_t *line, uint32_t value)
{
    char text[COUNT_DIGITS_MAX];
    size_t at = COUNT_DIGITS_MAX;

    /* From the last digit on; 0 has one too. */
    do {
        text[--at] = (char)('0' + (int16_t)(value % 10U));
        value /= 10U;
    } while (value > 0U);
    telemetry_characters(line, &text[at], COUNT_DIGITS_MAX - at);
}

/* The sum of what stands in the line so far, so nothing but the line end may follow. */
void telemetry_sum(telemetry_line_t *line)
{
    char digits[LINE_SUM_DIGITS];

    line_sum_write(digits, line_sum(line->text, line->length));
    telemetry_text(line, "*");
    telemetry_characters(line, digits, LINE_SUM_DIGITS);
}

void telemetry_end(telemetry_line_t *line)
{
    telemetry_text(line, "\r\n");
}

/* A blank between two fields, none before the first. */
static void begin_field(telemetry_line_t *line, const char *name)
{
    telemetry_text(line, (line->length > 0U) ? " " : "");
    telemetry_text(line, name);
    telemetry_text(line, ":");
}

/* Fields without a name are not published; published.c decides which. */
void telemetry_field_number(telemetry_line_t *line, const char *name, float value, uint16_t decimals)
{
    if (name != NULL) {
        begin_field(line, name);
        telemetry_fixed(line, value, decimals);
    }
}

void telemetry_field_text(telemetry_line_t *line, const char *name, const char *text)
{
    if (name != NULL && text != NULL) {
        begin_field(line, name);
        telemetry_text(line, text);
    }
}

void telemetry_field_count(telemetry_line_t *line, const char *name, uint32_t value)
{
    if (name != NULL) {
        begin_field(line, name);
        telemetry_count(line, value);
    }
}

void telemetry_pulse(telemetry_line_t *line, float pulse_us)
{
    telemetry_begin(line);
    telemetry_text(line, "P");
    /* Tenths of a microsecond as a whole number: the shortest line that keeps the throttle's resolution. */
    telemetry_count(line, (uint32_t)(pulse_us * 10.0F + 0.5F));
    telemetry_end(line);
}
