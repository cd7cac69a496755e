/* Any record, NaN and infinities too, and any cells. A row of CSV is not proved here. */
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

    PROVE(least >= -32767.0F && least <= 65534.0F && least <= other, "the number fits the cell");
    return least;
}

void any_record_is_packed(void)
{
    uint16_t cells[FLIGHT_LOG_CELLS];
    flight_log_t record;

    flight_log_pack(cells, &record);
}

void any_cells_are_unpacked(void)
{
    uint16_t cells[FLIGHT_LOG_CELLS];
    flight_log_t record;

    flight_log_unpack(&record, cells);
    PROVE(record.state <= 15U && record.flags <= 4095U, "state and flags in range");
}
