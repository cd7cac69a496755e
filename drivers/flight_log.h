/* The flight recorder's languages: one record in 16-bit cells, and one record as a row of CSV.
 * docs/operator.md has the columns. Pure. */
#ifndef DRIVERS_FLIGHT_LOG_H
#define DRIVERS_FLIGHT_LOG_H

#include <stdint.h>

#include "drivers/telemetry.h"

#define FLIGHT_LOG_CELLS 13U

/* One instant of a flight. NaN where there is no value. Packing keeps 1 mm up to +-32.7 m, 1 mN up to 65 N,
 * 0.1 mrad up to +-3.27 rad, 1 mm/s2 up to +-32.7 m/s2, 0.1 us and 1 ms up to 65 s; what is beyond becomes
 * the end of the range. */
typedef struct {
    uint32_t time_ms;    /* since power-up */
    float height_mm;     /* as measured */
    float estimate_mm;   /* the height that the law acts on */
    float innovation_mm; /* what a measurement was off from its prediction */
    float reference_m;
    float thrust_n;
    float roll_rad, pitch_rad;
    uint16_t state; /* 0..15 */
    uint16_t flags; /* 0..4095 */
    float up_mps2; /* acceleration upwards as measured, without gravity; NaN: no frame since the record before
                    */
    float pulse_us; /* commanded */
    float age_ms;   /* of the rays that height_mm was measured by */
} flight_log_t;

void flight_log_pack(uint16_t cells[FLIGHT_LOG_CELLS], const flight_log_t *record);
void flight_log_unpack(flight_log_t *record, const uint16_t cells[FLIGHT_LOG_CELLS]);

/* The names of the columns, and one record: added to a line, without its beginning and its end. state: its
 * name, up to 10 characters. A value that is not there leaves its column empty. */
void flight_log_titles(telemetry_line_t *line);
void flight_log_row(telemetry_line_t *line, const flight_log_t *record, const char *state);

#endif
