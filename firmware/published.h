/* Table of the fields that the firmware publishes. The telemetry line, the records of the flight recorder,
 * the rows of #LOG and the CSV of the PC board are made from it. The tables of docs/operator.md are checked
 * against it. A new field needs a row here, and code that sets its source. A member of flight_outputs_t
 * (control/flight_io.h) needs the row only. Pure; any context. */
#ifndef FIRMWARE_PUBLISHED_H
#define FIRMWARE_PUBLISHED_H

#include <stdint.h>

#include "control/battery.h"
#include "control/bounds.h"
#include "control/flight_io.h"
#include "control/sense/verdict.h"
#include "drivers/flight_beams.h"
#include "drivers/flight_log.h"
#include "drivers/telemetry.h"

/* Values of one instant. Some users set only a part: the recorder has no laser, the telemetry no angles. */
typedef struct {
    uint32_t time_ms; /* since power-up */
    float height_mm;  /* NAN: none */
    float age_us;     /* age of the rays of that height; NAN: none */
    float roll_rad;   /* NAN: not known */
    float pitch_rad;
    float up_mps2;     /* measured upward acceleration, gravity removed; NAN: no new one */
    const char *laser; /* zero-terminated names; the next three NULL: not in the line */
    const char *doubt;
    const char *limit;
    const char *reset;
    const char *battery;
    flight_beams_t beams;
    flight_outputs_t flight;
} published_t;

/* The rows, in the order of the line and of the columns. A name is NULL where the field does not appear.
 *
 *   NUMBER(telemetry, decimals, column, decimals of #LOG, of CSV, source, scale)
 *   DERIVED(column, decimals of #LOG, of CSV, source, function, of)   in no record: source is function(of)
 *   STATE(telemetry, column)                      the state's name, 4 bits of a record
 *   FLAGS(telemetry, column)                      a sum of bits, 12 bits of a record
 *   NAME(column, source, name_of, shift, bits)    a number with a name; so many bits of a record; 0: none, an
 *                                                 empty column
 *   TEXT(telemetry, source)                       in the telemetry line alone
 *   BEAM(column, name)                            five columns, mf_rays and so on, and the cells of
 *                                                 drivers/flight_beams.h; name: flight_beam_name_t
 *   SET(column, source)                           mirrors by their names; in the same cells
 *
 * source: a member of published_t. scale: drivers/flight_log.h. */
/* clang-format off */
#define PUBLISHED(NUMBER, DERIVED, STATE, FLAGS, NAME, TEXT, BEAM, SET)                \
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
    DERIVED("pulse_us", 1U, 2U, flight.pulse_us, thrust_to_pulse_us, flight.thrust_n)  \
    NUMBER(NULL,  0U, "age_s",     3U, 4U, age_us,               FLIGHT_LOG_MICRO)     \
    NUMBER(NULL,  0U, "bat_v",     2U, 3U, flight.battery_v,     FLIGHT_LOG_3)         \
    NAME("doubt", flight.reason,  verdict_name, 0U,  7U)                               \
    NAME("limit", flight.bound,   bound_name,   7U,  5U)                               \
    NAME("bat",   flight.battery, battery_name, 12U, 4U)                               \
    BEAM("mf", FLIGHT_BEAM_F)                                                          \
    BEAM("m1", FLIGHT_BEAM_1)                                                          \
    BEAM("m2", FLIGHT_BEAM_2)                                                          \
    SET("out", beams.left_out)                                                         \
    TEXT("doubt", doubt)                                                               \
    TEXT("limit", limit)                                                               \
    TEXT("reset", reset)                                                               \
    TEXT("bat", battery)
/* clang-format on */

/* Cells of 16 bits of one record: time, state with flags, the names, and one for each number; behind them
 * those of the beams. */
#define PUBLISHED_ONE_CELL(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) +1U
#define PUBLISHED_NO_CELL(telemetry, source_or_column)
#define PUBLISHED_NO_DERIVED(column, log_decimals, csv_decimals, source, function, of)
#define PUBLISHED_NO_NAME(column, source, name_of, shift, bits)
#define PUBLISHED_NO_BEAM(column, name_or_source)
#define PUBLISHED_FLIGHT_CELLS \
    (4U PUBLISHED(PUBLISHED_ONE_CELL, PUBLISHED_NO_DERIVED, PUBLISHED_NO_CELL, PUBLISHED_NO_CELL, \
                  PUBLISHED_NO_NAME, PUBLISHED_NO_CELL, PUBLISHED_NO_BEAM, PUBLISHED_NO_BEAM))
#define PUBLISHED_CELLS (PUBLISHED_FLIGHT_CELLS + FLIGHT_BEAMS_CELLS)

/* Builds the whole periodic line: "alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0" CR LF. A
 * number that is NAN is "-". The line fits a radio packet for all numbers, when the names have at most 8
 * characters (laser; 10 for state). With one of `doubt`, `limit`, `reset` and `battery` it fits for numbers
 * in the range of this vehicle. Of the first three do not set two together. Where `battery` is the one too
 * many, the line overflows. */
void published_telemetry(telemetry_line_t *line, const published_t *now);

/* Convert to a record and back. A record holds time, numbers, state (0..15), flags (0..4095), names and
 * beams. A number beyond its range is limited; NAN is kept. published_unpack() writes only these members. */
void published_pack(uint16_t cells[PUBLISHED_CELLS], const published_t *now);
void published_unpack(published_t *now, const uint16_t cells[PUBLISHED_CELLS]);

/* What is told of the beams in these outputs, as it is at now_us. */
flight_beams_t published_beams_of(const flight_outputs_t *flight, uint32_t now_us);

/* Append the names of the columns (t_s first), or the values of a record, to a line that was begun. NAN gives
 * an empty column. */
void published_titles(telemetry_line_t *line);
void published_row(telemetry_line_t *line, const published_t *record);

#endif
