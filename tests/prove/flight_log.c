/* Any number, NaN and infinities too, and any cell. A row of CSV is not proved here. */
#include "drivers/flight_log.h"

#include <math.h>

#include "prove.h"

void telemetry_text(telemetry_line_t *line, const char *text)
{
    (void)line;
    (void)text;
}
void telemetry_fixed(telemetry_line_t *line, float value, uint16_t decimals)
{
    (void)line;
    (void)value;
    (void)decimals;
}
void telemetry_count(telemetry_line_t *line, uint32_t value)
{
    (void)line;
    (void)value;
}

/* As the standard has them. */
float floorf(float value)
{
    const float whole = nondet_float();

    ASSUME(isnan(value) ? isnan(whole)
                        : (whole <= value && (whole > value - 1.0F || whole == value || value < -1e7F)));
    return whole;
}

float fmaxf(float one, float other)
{
    return (isnan(other) || one > other) ? one : other;
}

/* The outer one of the two: its result becomes an integer. */
float fminf(float one, float other)
{
    const float least = (isnan(other) || one < other) ? one : other;

    PROVE(least >= -32767.0F && least <= 32767.0F && least <= other, "the number fits the cell");
    return least;
}

void any_number_has_a_cell(void)
{
    flight_log_scale_t scale;

    ASSUME((unsigned)scale < FLIGHT_LOG_SCALE_COUNT);
    (void)flight_log_cell(nondet_float(), scale);
}

void any_cell_has_a_number(void)
{
    uint16_t cell;
    const float value = flight_log_value(cell, FLIGHT_LOG_MILLI);

    PROVE(isnan(value) == (cell == 0x8000U), "only one cell has no value");
    PROVE(isnan(value) || (value >= -32767.0F && value <= 32767.0F), "in the range");
}
