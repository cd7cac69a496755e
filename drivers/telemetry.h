/* What the operator reads: telemetry lines and answers, built into a bounded text. Documented in
 * docs/operator.md. Pure. */
#ifndef DRIVERS_TELEMETRY_H
#define DRIVERS_TELEMETRY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TELEMETRY_ANSWER_MAX 240U /* the longest line at all: answers may take several packets */
#define TELEMETRY_LINE_MAX 95U    /* line end included: one XBee packet */

typedef struct {
    char text[TELEMETRY_ANSWER_MAX];
    uint16_t limit; /* TELEMETRY_LINE_MAX or TELEMETRY_ANSWER_MAX */
    uint16_t length;
    bool overflowed; /* something did not fit: the line is not to be sent */
} telemetry_line_t;

/* A line is built between telemetry_begin and telemetry_end. What does not fit is left out whole, sets
 * `overflowed`, and nothing more is added to the line. A number that decimal.h cannot write becomes "-". */
void telemetry_begin(telemetry_line_t *line);
/* A line that may take two packets: answers. */
void telemetry_begin_answer(telemetry_line_t *line);
void telemetry_text(telemetry_line_t *line, const char *text); /* zero-terminated */
void telemetry_characters(telemetry_line_t *line, const char *text, size_t length);
void telemetry_fixed(telemetry_line_t *line, float value, uint16_t decimals);
void telemetry_number(telemetry_line_t *line, float value); /* shortest, decimal.h */
void telemetry_count(telemetry_line_t *line, uint32_t value);
/* '*' and the sum of the line so far: CRC-16 (polynomial 1021H, from FFFFH, no reflection, "CCITT-FALSE") of
 * its characters, four hexadecimal digits in upper case. */
void telemetry_sum(telemetry_line_t *line);
void telemetry_end(telemetry_line_t *line); /* CR LF */

/* Fields of the periodic line, "name:value", with a blank before all but the first. name or text NULL: adds
 * nothing. Which fields there are is a table elsewhere. */
void telemetry_field_number(telemetry_line_t *line, const char *name, float value, uint16_t decimals);
void telemetry_field_text(telemetry_line_t *line, const char *name, const char *text);
void telemetry_field_count(telemetry_line_t *line, const char *name, uint32_t value);

/* The line of a control cycle, for a test bench that plays the world: "P19997" CR LF, the throttle pulse in
 * tenths of a microsecond. Eight octets: at 9600 bit/s 50 cycles a second take 42 % of the line. From begin
 * to end. */
void telemetry_pulse(telemetry_line_t *line, float pulse_us);

#endif
