/* Formats of the flight recorder: a number in a cell of 16 bits, and a row of CSV. firmware/published.h has
 * the table of the numbers. Pure; any context. */
#ifndef DRIVERS_FLIGHT_LOG_H
#define DRIVERS_FLIGHT_LOG_H

#include <stdint.h>

#include "drivers/telemetry.h"

/* Resolution of a stored number, and the unit in which it is shown. */
typedef enum {
    FLIGHT_LOG_MILLI, /* value in mm for a column in m; resolution 1 mm */
    FLIGHT_LOG_MICRO, /* value in us for a column in s; resolution 1 ms */
    FLIGHT_LOG_3,     /* value in the column's unit; three decimals, +-32.767 */
    FLIGHT_LOG_4,     /* the same; four decimals, +-3.2767 */
    FLIGHT_LOG_SCALE_COUNT
} flight_log_scale_t;

/* Converts a value to a cell and back. A cell holds -32767 .. 32767 steps of the resolution, rounded; a value
 * beyond is limited. NAN is kept. */
uint16_t flight_log_cell(float value, flight_log_scale_t scale);
float flight_log_value(uint16_t cell, flight_log_scale_t scale);
float flight_log_shown(float value, flight_log_scale_t scale); /* value converted to the unit of its column */

/* Appends the first column: seconds with three decimals. */
void flight_log_time(telemetry_line_t *line, uint32_t time_ms);

/* Append one more column, after a comma. NAN gives an empty column. */
void flight_log_number(telemetry_line_t *line, float value, uint16_t decimals);
void flight_log_text(telemetry_line_t *line, const char *text); /* zero-terminated, without a comma */
void flight_log_count(telemetry_line_t *line, uint32_t value);

#endif
