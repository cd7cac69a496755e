/* Each function walks the rows of PUBLISHED once: a macro for each kind of row says what is done with it. */
#include "firmware/published.h"

#include <math.h>

#include "control/thrust.h"

#define STATE_SHIFT 12
#define FLAGS_MASK 0x0FFFU
#define NAME_MASK(bits) (((uint32_t)1 << (bits)) - 1U)
#define NOT_HERE(telemetry, source)
#define NOT_DERIVED(column, log_decimals, csv_decimals, source, function, of)
#define NO_NAME(column, source, name_of, shift, bits)
#define NO_BEAM(column, mirror_or_source)

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    telemetry_field_number(line, telemetry, flight_log_shown(now->source, scale), decimals);
#define STATE(telemetry, column) telemetry_field_text(line, telemetry, flight_state_name(now->flight.state));
#define FLAGS(telemetry, column) telemetry_field_count(line, telemetry, now->flight.flags);
#define TEXT(telemetry, source) telemetry_field_text(line, telemetry, now->source);
void published_telemetry(telemetry_line_t *line, const published_t *now)
{
    telemetry_begin(line);
    PUBLISHED(NUMBER, NOT_DERIVED, STATE, FLAGS, NO_NAME, TEXT, NO_BEAM, NO_BEAM)
    telemetry_end(line);
}
#undef NUMBER
#undef STATE
#undef FLAGS
#undef TEXT

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    *cells++ = flight_log_cell(now->source, scale);
#define NO_NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale)
#define NAME(column, source, name_of, shift, bits) \
    *cells |= (uint16_t)(((uint32_t)now->source & NAME_MASK(bits)) << (shift));
void published_pack(uint16_t cells[PUBLISHED_CELLS], const published_t *now)
{
    *cells++ = (uint16_t)(now->time_ms & 0xFFFFU);
    *cells++ = (uint16_t)(now->time_ms >> 16);
    PUBLISHED(NUMBER, NOT_DERIVED, NOT_HERE, NOT_HERE, NO_NAME, NOT_HERE, NO_BEAM, NO_BEAM)
    *cells++ = (uint16_t)((uint32_t)now->flight.state << STATE_SHIFT) | (now->flight.flags & FLAGS_MASK);
    *cells = 0U;
    PUBLISHED(NO_NUMBER, NOT_DERIVED, NOT_HERE, NOT_HERE, NAME, NOT_HERE, NO_BEAM, NO_BEAM)
    flight_beams_pack(cells + 1, &now->beams);
}
#undef NUMBER
#undef NAME

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    now->source = flight_log_value(*cells++, scale);
#define DERIVED(column, log_decimals, csv_decimals, source, function, of) now->source = function(now->of);
#define NAME(column, source, name_of, shift, bits) \
    now->source = (uint16_t)(((uint32_t)*cells >> (shift)) & NAME_MASK(bits));
void published_unpack(published_t *now, const uint16_t cells[PUBLISHED_CELLS])
{
    now->time_ms = (uint32_t)cells[0] | ((uint32_t)cells[1] << 16);
    cells += 2;
    PUBLISHED(NUMBER, NOT_DERIVED, NOT_HERE, NOT_HERE, NO_NAME, NOT_HERE, NO_BEAM, NO_BEAM)
    now->flight.state = (flight_state_t)(*cells >> STATE_SHIFT);
    now->flight.flags = *cells++ & FLAGS_MASK;
    PUBLISHED(NO_NUMBER, DERIVED, NOT_HERE, NOT_HERE, NAME, NOT_HERE, NO_BEAM, NO_BEAM)
    now->beams = flight_beams_unpack(cells + 1);
}
#undef NUMBER
#undef NAME
#undef DERIVED

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    flight_log_text(line, column);
#define DERIVED(column, log_decimals, csv_decimals, source, function, of) flight_log_text(line, column);
#define NAMED(telemetry, column) flight_log_text(line, column);
#define NAME(column, source, name_of, shift, bits) flight_log_text(line, column);
#define SET(column, source) flight_log_text(line, column);
#define BEAM(column, name) flight_beams_titles(line, name);
void published_titles(telemetry_line_t *line)
{
    telemetry_text(line, "t_s");
    PUBLISHED(NUMBER, DERIVED, NAMED, NAMED, NAME, NOT_HERE, BEAM, SET)
}
#undef NUMBER
#undef DERIVED
#undef NAMED
#undef NAME
#undef BEAM
#undef SET

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    flight_log_number(line, flight_log_shown(record->source, scale), log_decimals);
#define DERIVED(column, log_decimals, csv_decimals, source, function, of) \
    flight_log_number(line, record->source, log_decimals);
#define STATE(telemetry, column) flight_log_text(line, flight_state_name(record->flight.state));
#define FLAGS(telemetry, column) flight_log_count(line, record->flight.flags);
#define NAME(column, source, name_of, shift, bits) \
    flight_log_text(line, (record->source != 0U) ? name_of(record->source) : "");
#define SET(column, source) flight_log_text(line, flight_beams_names(record->source));
#define BEAM(column, name) flight_beams_columns(line, &record->beams.beam[name]);
void published_row(telemetry_line_t *line, const published_t *record)
{
    flight_log_time(line, record->time_ms);
    PUBLISHED(NUMBER, DERIVED, STATE, FLAGS, NAME, NOT_HERE, BEAM, SET)
}

static const mirror_t mirror_of[] = {
    [FLIGHT_BEAM_F] = MIRROR_FRONT, [FLIGHT_BEAM_1] = MIRROR_AFT, [FLIGHT_BEAM_2] = MIRROR_FORE};
typedef char every_mirror_has_a_beam[((uint16_t)MIRROR_COUNT == FLIGHT_BEAM_COUNT) ? 1 : -1];

static flight_beam_t beam_of(const beam_signal_t *seen, uint32_t since_us, float lie)
{
    return (flight_beam_t){
        .rays = (float)seen->good_rays,
        .slant_mm = seen->told ? seen->slant_mm : NAN,
        .spread_mm = seen->told ? seen->spread_mm : NAN,
        .age_us = seen->told ? (float)(since_us + seen->age_us) : NAN,
        .lie = lie,
    };
}

flight_beams_t published_beams_of(const flight_outputs_t *flight, uint32_t now_us)
{
    const scan_signal_t *signal = &flight->signal;
    flight_beams_t now = flight_beams_none();

    for (uint16_t b = 0U; b < FLIGHT_BEAM_COUNT; ++b) {
        const mirror_t mirror = mirror_of[b];

        if (signal->scans != 0U && signal->beams[mirror].looked) {
            now.beam[b] = beam_of(&signal->beams[mirror], now_us - signal->arrival_us, flight->lies[mirror]);
        }
        now.left_out |= (uint16_t)((uint32_t)(((uint32_t)flight->left_out >> mirror) & 1U) << b);
    }
    return now;
}
