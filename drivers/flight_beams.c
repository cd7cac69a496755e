/* A beam's cells: the slant, and below it the lower bits of the age; then rays, spread, and the rest of the
 * age. The last cell has the probabilities, and the mirrors that were left out.
 * What breaks: the greatest number of a place means "not known", so no value may reach it. */
#include "drivers/flight_beams.h"

#include <math.h>

#include "drivers/flight_log.h"

#define MS_PER_US 0.001F
#define PERCENT 100.0F
#define SLANT_MAX_MM 4095.0F /* the sensor's furthest, and twelve bits */
#define LINE_AGE_MAX_MS 999.0F

/* One place in a cell. */
typedef struct {
    float step;
    uint16_t unknown; /* its code, the greatest */
} place_t;

static const place_t place_rays = {1.0F, 63U};
static const place_t place_spread = {1.0F, 255U};
static const place_t place_age = {4000.0F, 63U};
static const place_t place_lie = {1.0F / 14.0F, 15U};

#define SLANT_SHIFT 4U /* the lower bits of the age stand below it */
#define AGE_LOW_MASK 0xFU
#define AGE_LOW_BITS 4U
#define AGE_HIGH_MASK 0x3U
#define RAYS_SHIFT 10U
#define SPREAD_SHIFT 2U
#define SPREAD_MASK 0xFFU
#define LIE_BITS 4U
#define LIE_MASK 0xFU
#define LEFT_OUT_SHIFT (LIE_BITS * (uint16_t)FLIGHT_BEAM_COUNT)
#define LEFT_OUT_MASK ((1U << FLIGHT_BEAM_COUNT) - 1U)

static const char *const names[] = {[FLIGHT_BEAM_F] = "mf", [FLIGHT_BEAM_1] = "m1", [FLIGHT_BEAM_2] = "m2"};

static float whole(float value, float least, float most)
{
    return fminf(fmaxf(floorf(value + 0.5F), least), most);
}

static uint32_t code(float value, const place_t *place)
{
    return isnan(value) ? place->unknown
                        : (uint32_t)whole(value / place->step, 0.0F, (float)(place->unknown - 1U));
}

static float value_of(uint32_t number, const place_t *place)
{
    return (number == place->unknown) ? NAN : (float)number * place->step;
}

/* 0 is "not known": no ray is so short. */
static uint32_t slant_code(float slant_mm)
{
    return isnan(slant_mm) ? 0U : (uint32_t)whole(slant_mm, 1.0F, SLANT_MAX_MM);
}

flight_beams_t flight_beams_none(void)
{
    flight_beams_t none = {.left_out = 0U};

    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; ++m) {
        none.beam[m] = (flight_beam_t){NAN, NAN, NAN, NAN, NAN};
    }
    return none;
}

void flight_beams_pack(uint16_t cells[FLIGHT_BEAMS_CELLS], const flight_beams_t *beams)
{
    uint32_t last = ((uint32_t)beams->left_out & LEFT_OUT_MASK) << LEFT_OUT_SHIFT;

    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; ++m) {
        const flight_beam_t *beam = &beams->beam[m];
        const uint32_t age = code(beam->age_us, &place_age);

        *cells++ = (uint16_t)(((uint32_t)(slant_code(beam->slant_mm)) << SLANT_SHIFT) | (age & AGE_LOW_MASK));
        *cells++ = (uint16_t)(((uint32_t)(code(beam->rays, &place_rays)) << RAYS_SHIFT) |
                              ((uint32_t)(code(beam->spread_mm, &place_spread)) << SPREAD_SHIFT) |
                              (age >> AGE_LOW_BITS));
        last |= (uint32_t)(code(beam->lie, &place_lie)) << (LIE_BITS * m);
    }
    *cells = (uint16_t)last;
}

static flight_beam_t beam_of(uint32_t first, uint32_t second, uint32_t lie)
{
    const uint32_t slant_mm = first >> SLANT_SHIFT;
    const uint32_t age = ((uint32_t)(second & AGE_HIGH_MASK) << AGE_LOW_BITS) | (first & AGE_LOW_MASK);

    return (flight_beam_t){
        .rays = value_of(second >> RAYS_SHIFT, &place_rays),
        .slant_mm = (slant_mm == 0U) ? NAN : (float)slant_mm,
        .spread_mm = value_of((second >> SPREAD_SHIFT) & SPREAD_MASK, &place_spread),
        .age_us = value_of(age, &place_age),
        .lie = value_of(lie, &place_lie),
    };
}

flight_beams_t flight_beams_unpack(const uint16_t cells[FLIGHT_BEAMS_CELLS])
{
    const uint32_t last = cells[FLIGHT_BEAMS_CELLS - 1U];
    flight_beams_t beams = {.left_out = (uint16_t)((last >> LEFT_OUT_SHIFT) & LEFT_OUT_MASK)};

    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; ++m) {
        beams.beam[m] = beam_of(cells[2U * m], cells[2U * m + 1U], (last >> (LIE_BITS * m)) & LIE_MASK);
    }
    return beams;
}

void flight_beams_titles(telemetry_line_t *line, flight_beam_name_t mirror)
{
    static const char *const parts[] = {"_rays", "_mm", "_spread_mm", "_ms", "_lie"};

    for (uint16_t i = 0U; i < sizeof parts / sizeof parts[0]; ++i) {
        flight_log_text(line, names[mirror]);
        telemetry_text(line, parts[i]);
    }
}

void flight_beams_columns(telemetry_line_t *line, const flight_beam_t *beam)
{
    flight_log_number(line, beam->rays, 0U);
    flight_log_number(line, beam->slant_mm, 0U);
    flight_log_number(line, beam->spread_mm, 0U);
    flight_log_number(line, beam->age_us * MS_PER_US, 0U);
    flight_log_number(line, beam->lie * PERCENT, 0U);
}

const char *flight_beams_names(uint16_t set)
{
    static const char *const sets[1U << FLIGHT_BEAM_COUNT] = {"",   "mf",    "m1",    "mf+m1",
                                                              "m2", "mf+m2", "m1+m2", "mf+m1+m2"};

    return sets[set & LEFT_OUT_MASK];
}

/* NAN stays so: it is told by a dash. */
static void add_part(telemetry_line_t *line, float value, float most)
{
    telemetry_text(line, ",");
    telemetry_fixed(line, isnan(value) ? NAN : fminf(value, most), 0U);
}

static void add_beam(telemetry_line_t *line, const flight_beam_t *beam)
{
    telemetry_text(line, ":");
    telemetry_fixed(line, beam->rays, 0U);
    if (!isnan(beam->rays)) {
        add_part(line, beam->slant_mm, SLANT_MAX_MM);
        add_part(line, beam->spread_mm, SLANT_MAX_MM);
        add_part(line, beam->age_us * MS_PER_US, LINE_AGE_MAX_MS);
        add_part(line, beam->lie * PERCENT, PERCENT);
    }
}

void flight_beams_line(telemetry_line_t *line, const flight_beams_t *beams)
{
    const char *out = flight_beams_names(beams->left_out);

    telemetry_begin(line);
    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; ++m) {
        telemetry_text(line, (m == 0U) ? "" : " ");
        telemetry_text(line, names[m]);
        add_beam(line, &beams->beam[m]);
    }
    telemetry_field_text(line, "out", (*out == '\0') ? "-" : out);
    telemetry_end(line);
}
