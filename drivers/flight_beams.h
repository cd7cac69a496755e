/* Formats of what is told of the beams: cells of a record, columns of a row of CSV, and a telemetry line. For
 * each mirror its good rays, slant, spread, age, and how probably it lies; and which mirrors the vote left
 * out. firmware/published.h says where they come from. Pure; any context. */
#ifndef DRIVERS_FLIGHT_BEAMS_H
#define DRIVERS_FLIGHT_BEAMS_H

#include <stdint.h>

#include "drivers/telemetry.h"

/* Mirrors, in the order of the columns and of the line. Their names are those of the parameters. */
typedef enum { FLIGHT_BEAM_F, FLIGHT_BEAM_1, FLIGHT_BEAM_2, FLIGHT_BEAM_COUNT } flight_beam_name_t;

/* A member is NAN where it is not known. */
typedef struct {
    float rays; /* good ones; NAN: no such mirror, or no scan at this instant */
    float slant_mm;
    float spread_mm;
    float age_us;
    float lie; /* probability, 0 .. 1 */
} flight_beam_t;

typedef struct {
    flight_beam_t beam[FLIGHT_BEAM_COUNT];
    uint16_t left_out; /* bits, by flight_beam_name_t */
} flight_beams_t;

/* Nothing is known. */
flight_beams_t flight_beams_none(void);

/* Two cells for each mirror, and one for all. */
#define FLIGHT_BEAMS_CELLS (2U * (uint16_t)FLIGHT_BEAM_COUNT + 1U)

/* Convert to a record's cells and back. Limited are rays to 0 .. 62, the slant to 1 .. 4095 mm, the spread to
 * 0 .. 254 mm, the age to 0 .. 248 ms in steps of 4 ms, the probability to steps of a fourteenth. NAN is
 * kept. */
void flight_beams_pack(uint16_t cells[FLIGHT_BEAMS_CELLS], const flight_beams_t *beams);
flight_beams_t flight_beams_unpack(const uint16_t cells[FLIGHT_BEAMS_CELLS]);

/* Append the columns of one mirror, "mf_rays,mf_mm,mf_spread_mm,mf_ms,mf_lie", or its values: rays, mm, mm,
 * ms and percent, as whole numbers. Each after a comma; NAN gives an empty column. */
void flight_beams_titles(telemetry_line_t *line, flight_beam_name_t mirror);
void flight_beams_columns(telemetry_line_t *line, const flight_beam_t *beam);

/* Names of a set of mirrors: "mf", "m1+m2"; no mirror: "". */
const char *flight_beams_names(uint16_t set);

/* Builds the line "mf:35,612,9,81,- m1:- m2:- out:-" CR LF: of each mirror its good rays, slant and spread in
 * mm, age in ms (999: so much or more), and the percent of its probability to lie. A dash is what is not
 * known. The line fits a radio packet. */
void flight_beams_line(telemetry_line_t *line, const flight_beams_t *beams);

#endif
