/* What the firmware publishes: the one table of fields. From it come the telemetry line, the records of the
 * flight recorder with their rows of #LOG, and the CSV of the PC board; the tables of docs/operator.md are
 * checked against it. A new field is a row here, and its source where its value is made: a member of
 * flight_outputs_t (control/flight_io.h) needs nothing else. */
#ifndef FIRMWARE_PUBLISHED_H
#define FIRMWARE_PUBLISHED_H

#include <stdint.h>

#include "control/flight_io.h"
#include "drivers/flight_log.h"
#include "drivers/telemetry.h"

/* One instant. Not every user knows every member: the recorder has no laser, the telemetry no angles. */
typedef struct {
    uint32_t time_ms; /* since power-up */
    float height_mm;  /* NAN: none */
    float age_us;     /* of the rays that it was measured by; NAN: none */
    float roll_rad;   /* NAN: not known */
    float pitch_rad;
    float up_mps2;     /* acceleration upwards as measured, without gravity; NAN: no new one */
    const char *laser; /* zero-terminated names; the next two NULL: not in the line */
    const char *doubt;
    const char *reset;
    flight_outputs_t flight;
} published_t;

/* The rows, in the order of the line and of the columns. A name is NULL where the field does not appear.
 *
 *   NUMBER(telemetry, decimals, column, decimals of #LOG, of CSV, source, scale)
 *   STATE(telemetry, column)                      the state's name, 4 bits of a record
 *   FLAGS(telemetry, column)                      a sum of bits, 12 bits of a record
 *   TEXT(telemetry, source)                       in the telemetry line alone
 *
 * source: a member of published_t. scale: drivers/flight_log.h. */
/* clang-format off */
#define PUBLISHED(NUMBER, STATE, FLAGS, TEXT)                                          \
    NUMBER("alt", 3U, "meas_m",    3U, 4U, height_mm,            FLIGHT_LOG_MILLI)     \
    NUMBER(NULL,  0U, "est_m",     3U, 4U, flight.estimate_mm,   FLIGHT_LOG_MILLI)     \
    NUMBER(NULL,  0U, "innov_m",   3U, 4U, flight.innovation_mm, FLIGHT_LOG_MILLI)     \
    NUMBER("ref", 3U, "ref_m",     3U, 3U, flight.reference_m,   FLIGHT_LOG_3)         \
    TEXT("laser", laser)                                                               \
    NUMBER("thr", 2U, "thrust_n",  3U, 4U, flight.thrust_n,      FLIGHT_LOG_3)         \
    NUMBER(NULL,  0U, "roll_rad",  4U, 4U, roll_rad,             FLIGHT_LOG_4)         \
    NUMBER(NULL,  0U, "pitch_rad", 4U, 4U, pitch_rad,            FLIGHT_LOG_4)         \
    STATE("state", "state")                                                            \
    FLAGS("flags", "flags")                                                            \
    NUMBER(NULL,  0U, "up_mps2",   3U, 4U, up_mps2,              FLIGHT_LOG_3)         \
    NUMBER(NULL,  0U, "pulse_us",  1U, 2U, flight.pulse_us,      FLIGHT_LOG_1)         \
    NUMBER(NULL,  0U, "age_s",     3U, 4U, age_us,               FLIGHT_LOG_MICRO)     \
    TEXT("doubt", doubt)                                                               \
    TEXT("reset", reset)
/* clang-format on */

/* Cells of 16 bits of one record: time, state with flags, and one for each number. */
#define PUBLISHED_ONE_CELL(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) +1U
#define PUBLISHED_NO_CELL(telemetry, source_or_column)
#define PUBLISHED_CELLS \
    (3U PUBLISHED(PUBLISHED_ONE_CELL, PUBLISHED_NO_CELL, PUBLISHED_NO_CELL, PUBLISHED_NO_CELL))

/* The periodic line, from begin to end: "alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0" CR LF. A
 * number that is not there is "-". With names of up to 8 characters (laser, doubt, reset; not two of the
 * last) and 10 (state) it fits a radio packet whatever the numbers are, the reset within what numbers mean
 * on this vehicle. */
void published_telemetry(telemetry_line_t *line, const published_t *now);

/* A record keeps time, numbers, state (0..15) and flags (0..4095). A number beyond its range becomes the end
 * of it; NAN stays NAN. Unpacking writes no other member. */
void published_pack(uint16_t cells[PUBLISHED_CELLS], const published_t *now);
void published_unpack(published_t *now, const uint16_t cells[PUBLISHED_CELLS]);

/* The names of the columns, t_s first, and a record: added to a line, without its beginning and its end. A
 * number that is not there leaves its column empty. */
void published_titles(telemetry_line_t *line);
void published_row(telemetry_line_t *line, const published_t *record);

#endif
