#include "drivers/flight_log.h"

#include <math.h>

#define NOT_THERE 0x8000U
#define CELL_MAX 32767.0F

static const float steps[] = {1.0F, 0.001F, 1000.0F, 10000.0F}; /* of one unit of the value */
static const float shown[] = {0.001F, 1.0e-6F, 1.0F, 1.0F};
typedef char every_scale_has_its_factor[(sizeof shown / sizeof shown[0] == FLIGHT_LOG_SCALE_COUNT) ? 1 : -1];
typedef char every_scale_has_its_steps[(sizeof steps / sizeof steps[0] == FLIGHT_LOG_SCALE_COUNT) ? 1 : -1];

uint16_t flight_log_cell(float value, flight_log_scale_t scale)
{
    const float scaled = floorf(value * steps[scale] + 0.5F);

    if (isnan(scaled)) {
        return NOT_THERE;
    }
    return (uint16_t)(int16_t)fminf(fmaxf(scaled, -CELL_MAX), CELL_MAX);
}

float flight_log_value(uint16_t cell, flight_log_scale_t scale)
{
    const int32_t number = (int32_t)(cell ^ NOT_THERE) - (int32_t)NOT_THERE; /* its sign is its top bit */

    return (cell == NOT_THERE) ? NAN : (float)number / steps[scale];
}

float flight_log_shown(float value, flight_log_scale_t scale)
{
    return value * shown[scale];
}

void flight_log_time(telemetry_line_t *line, uint32_t time_ms)
{
    const uint32_t thousandths = time_ms % 1000U;

    telemetry_count(line, time_ms / 1000U);
    telemetry_text(line, (thousandths < 10U) ? ".00" : ((thousandths < 100U) ? ".0" : "."));
    telemetry_count(line, thousandths);
}

void flight_log_number(telemetry_line_t *line, float value, uint16_t decimals)
{
    telemetry_text(line, ",");
    if (!isnan(value)) {
        telemetry_fixed(line, value, decimals);
    }
}

void flight_log_text(telemetry_line_t *line, const char *text)
{
    telemetry_text(line, ",");
    telemetry_text(line, text);
}

void flight_log_count(telemetry_line_t *line, uint32_t value)
{
    telemetry_text(line, ",");
    telemetry_count(line, value);
}
