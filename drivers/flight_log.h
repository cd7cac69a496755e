/* The flight recorder's languages: a number in a cell of 16 bits, and the columns of a row of CSV. Which
 * numbers they are is a table elsewhere. Pure. */
#ifndef DRIVERS_FLIGHT_LOG_H
#define DRIVERS_FLIGHT_LOG_H

#include <stdint.h>

#include "drivers/telemetry.h"

/* How a number is kept and shown. */
typedef enum {
    FLIGHT_LOG_MILLI, /* in thousandths of its column's unit, kept as whole ones: mm in a column of m */
    FLIGHT_LOG_MICRO, /* in millionths of it, kept in thousandths: us in a column of s */
    FLIGHT_LOG_1,     /* in its column's unit, kept with one decimal: +-3276.7 */
    FLIGHT_LOG_3,     /* likewise with three: +-32.767 */
    FLIGHT_LOG_4,     /* likewise with four: +-3.2767 */
    FLIGHT_LOG_SCALE_COUNT
} flight_log_scale_t;

/* A cell holds +-32767 steps, rounded; a value beyond becomes the end of the range. NAN stays NAN. */
uint16_t flight_log_cell(float value, flight_log_scale_t scale);
float flight_log_value(uint16_t cell, flight_log_scale_t scale);
float flight_log_shown(float value, flight_log_scale_t scale); /* in the unit of its column */

/* The first column: seconds with three decimals. */
void flight_log_time(telemetry_line_t *line, uint32_t time_ms);

/* A further column, with the comma before it. NAN leaves it empty. */
void flight_log_number(telemetry_line_t *line, float value, uint16_t decimals);
void flight_log_text(telemetry_line_t *line, const char *text); /* zero-terminated, without a comma */
void flight_log_count(telemetry_line_t *line, uint32_t value);

#endif
