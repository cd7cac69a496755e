#include "drivers/flight_log.h"

#include <math.h>

#define NOT_THERE 0x8000U
#define CELL_MAX 32767.0F
#define UNSIGNED_MAX 65534.0F
#define NO_UNSIGNED 0xFFFFU
#define MM_PER_M 1000.0F
#define MN_PER_N 1000.0F
#define PER_RAD 10000.0F
#define MMPS2_PER_MPS2 1000.0F
#define TENTHS_PER_US 10.0F
#define MS_PER_S 1000.0F
#define STATE_SHIFT 12
#define FLAGS_MASK 0x0FFFU

static uint16_t signed_cell(float value, float per_unit)
{
    const float scaled = floorf(value * per_unit + 0.5F);

    if (isnan(scaled)) {
        return NOT_THERE;
    }
    return (uint16_t)(int16_t)fminf(fmaxf(scaled, -CELL_MAX), CELL_MAX);
}

static float signed_value(uint16_t cell, float per_unit)
{
    const int32_t number = (cell < NOT_THERE) ? (int32_t)cell : (int32_t)cell - INT32_C(65536);

    return (cell == NOT_THERE) ? NAN : (float)number / per_unit;
}

static uint16_t unsigned_cell(float value, float per_unit)
{
    const float scaled = floorf(value * per_unit + 0.5F);

    return isnan(scaled) ? NO_UNSIGNED : (uint16_t)fminf(fmaxf(scaled, 0.0F), UNSIGNED_MAX);
}

static float unsigned_value(uint16_t cell, float per_unit)
{
    return (cell == NO_UNSIGNED) ? NAN : (float)cell / per_unit;
}

void flight_log_pack(uint16_t cells[FLIGHT_LOG_CELLS], const flight_log_t *record)
{
    cells[0] = (uint16_t)(record->time_ms & 0xFFFFU);
    cells[1] = (uint16_t)(record->time_ms >> 16);
    cells[2] = signed_cell(record->height_mm, 1.0F);
    cells[3] = signed_cell(record->estimate_mm, 1.0F);
    cells[4] = signed_cell(record->innovation_mm, 1.0F);
    cells[5] = signed_cell(record->reference_m, MM_PER_M);
    cells[6] = unsigned_cell(record->thrust_n, MN_PER_N);
    cells[7] = signed_cell(record->roll_rad, PER_RAD);
    cells[8] = signed_cell(record->pitch_rad, PER_RAD);
    cells[9] = (uint16_t)((uint32_t)record->state << STATE_SHIFT) | (record->flags & FLAGS_MASK);
    cells[10] = signed_cell(record->up_mps2, MMPS2_PER_MPS2);
    cells[11] = unsigned_cell(record->pulse_us, TENTHS_PER_US);
    cells[12] = unsigned_cell(record->age_ms, 1.0F);
}

void flight_log_unpack(flight_log_t *record, const uint16_t cells[FLIGHT_LOG_CELLS])
{
    record->time_ms = (uint32_t)cells[0] | ((uint32_t)cells[1] << 16);
    record->height_mm = signed_value(cells[2], 1.0F);
    record->estimate_mm = signed_value(cells[3], 1.0F);
    record->innovation_mm = signed_value(cells[4], 1.0F);
    record->reference_m = signed_value(cells[5], MM_PER_M);
    record->thrust_n = unsigned_value(cells[6], MN_PER_N);
    record->roll_rad = signed_value(cells[7], PER_RAD);
    record->pitch_rad = signed_value(cells[8], PER_RAD);
    record->state = (uint16_t)(cells[9] >> STATE_SHIFT);
    record->flags = cells[9] & FLAGS_MASK;
    record->up_mps2 = signed_value(cells[10], MMPS2_PER_MPS2);
    record->pulse_us = unsigned_value(cells[11], TENTHS_PER_US);
    record->age_ms = unsigned_value(cells[12], 1.0F);
}

void flight_log_titles(telemetry_line_t *line)
{
    telemetry_text(line, "t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,");
    telemetry_text(line, "up_mps2,pulse_us,age_s");
}

static void add_column(telemetry_line_t *line, float value, uint16_t decimals)
{
    telemetry_text(line, ",");
    if (!isnan(value)) {
        telemetry_fixed(line, value, decimals);
    }
}

static void add_time(telemetry_line_t *line, uint32_t time_ms)
{
    const uint32_t thousandths = time_ms % 1000U;

    telemetry_count(line, time_ms / 1000U);
    telemetry_text(line, (thousandths < 10U) ? ".00" : ((thousandths < 100U) ? ".0" : "."));
    telemetry_count(line, thousandths);
}

void flight_log_row(telemetry_line_t *line, const flight_log_t *record, const char *state)
{
    add_time(line, record->time_ms);
    add_column(line, record->height_mm / MM_PER_M, 3U);
    add_column(line, record->estimate_mm / MM_PER_M, 3U);
    add_column(line, record->innovation_mm / MM_PER_M, 3U);
    add_column(line, record->reference_m, 3U);
    add_column(line, record->thrust_n, 3U);
    add_column(line, record->roll_rad, 4U);
    add_column(line, record->pitch_rad, 4U);
    telemetry_text(line, ",");
    telemetry_text(line, state);
    telemetry_text(line, ",");
    telemetry_count(line, record->flags);
    add_column(line, record->up_mps2, 3U);
    add_column(line, record->pulse_us, 1U);
    add_column(line, record->age_ms / MS_PER_S, 3U);
}
