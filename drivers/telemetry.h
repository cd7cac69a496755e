/* Builds the lines that the operator reads, telemetry and answers, in a text of limited length. Their format
 * is in docs/operator.md. Pure; the caller owns the line. Context: one at a time per line. */
#ifndef DRIVERS_TELEMETRY_H
#define DRIVERS_TELEMETRY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TELEMETRY_ANSWER_MAX 256U /* longest line, the titles of #LOG: an answer may take several packets */
#define TELEMETRY_LINE_MAX 95U    /* one XBee packet, with the line end */

typedef struct {
    char text[TELEMETRY_ANSWER_MAX];
    uint16_t limit; /* TELEMETRY_LINE_MAX or TELEMETRY_ANSWER_MAX */
    uint16_t length;
    bool overflowed; /* something did not fit: do not send the line */
} telemetry_line_t;

/* Begins a line of at most TELEMETRY_LINE_MAX characters. The functions below append to it, until
 * telemetry_end(). A part that does not fit is not appended at all: it sets `overflowed`, and later parts are
 * not appended either. A number that decimal.h cannot write (NaN, infinite, too large) becomes "-". */
void telemetry_begin(telemetry_line_t *line);
/* The same for an answer: at most TELEMETRY_ANSWER_MAX characters. */
void telemetry_begin_answer(telemetry_line_t *line);
void telemetry_text(telemetry_line_t *line, const char *text); /* zero-terminated */
void telemetry_characters(telemetry_line_t *line, const char *text, size_t length);
void telemetry_fixed(telemetry_line_t *line, float value, uint16_t decimals);
void telemetry_number(telemetry_line_t *line, float value); /* as decimal_write_shortest() */
void telemetry_count(telemetry_line_t *line, uint32_t value);
/* Appends '*' and the sum of the characters so far, four hexadecimal digits in upper case (line_sum.h). */
void telemetry_sum(telemetry_line_t *line);
void telemetry_end(telemetry_line_t *line); /* appends CR LF */

/* Append one field of the periodic line, "name:value", with a blank before every field but the first. Append
 * nothing when name or text is NULL. firmware/published.h has the table of the fields. */
void telemetry_field_number(telemetry_line_t *line, const char *name, float value, uint16_t decimals);
void telemetry_field_text(telemetry_line_t *line, const char *name, const char *text);
void telemetry_field_count(telemetry_line_t *line, const char *name, uint32_t value);

/* Builds a whole line with the throttle pulse in tenths of a microsecond: "P19997" CR LF. For a test bench
 * that simulates the vehicle. The line has eight octets, so 50 lines a second take 42 % of 9600 bit/s. */
void telemetry_pulse(telemetry_line_t *line, float pulse_us);

#endif
