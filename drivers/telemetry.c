#include "drivers/telemetry.h"

#include <string.h>

#include "drivers/decimal.h"
#include "drivers/line_sum.h"

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

    do {
        text[--at] = (char)('0' + (int16_t)(value % 10U));
        value /= 10U;
    } while (value > 0U);
    telemetry_characters(line, &text[at], COUNT_DIGITS_MAX - at);
}

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

static void begin_field(telemetry_line_t *line, const char *name)
{
    telemetry_text(line, (line->length > 0U) ? " " : "");
    telemetry_text(line, name);
    telemetry_text(line, ":");
}

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
    telemetry_count(line, (uint32_t)(pulse_us * 10.0F + 0.5F));
    telemetry_end(line);
}
