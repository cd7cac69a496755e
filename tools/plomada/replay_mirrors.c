#include "replay_mirrors.h"

#include <math.h>

#include "drivers/flight_beams.h"

enum { RAYS, SLANT_MM, SPREAD_MM, AGE_MS, CELLS_A_MIRROR };
typedef char every_mirror_has_its_cells[(CELLS_A_MIRROR * MIRROR_COUNT == REPLAY_MIRRORS_CELLS) ? 1 : -1];

/* In the log's order. */
static const mirror_t mirror_of[] = {
    [FLIGHT_BEAM_F] = MIRROR_FRONT, [FLIGHT_BEAM_1] = MIRROR_AFT, [FLIGHT_BEAM_2] = MIRROR_FORE};

int replay_mirrors_told(const double cells[REPLAY_MIRRORS_CELLS])
{
    int told = 0;

    for (int i = 0; i < MIRROR_COUNT; i++) {
        told += !isnan(cells[CELLS_A_MIRROR * i + SLANT_MM]);
    }
    return told;
}

/* What is not told is 0. */
static double or_zero(double cell)
{
    return isnan(cell) ? 0.0 : cell;
}

static float aside_steps(const mirror_windows_t *windows, mirror_t mirror)
{
    float aside = 0.0F;

    for (uint16_t i = 0; i < windows->count; i++) {
        aside += windows->mirror[i] == mirror ? (float)windows->middle[i] - windows->axis[i] : 0.0F;
    }
    return aside;
}

void replay_mirrors_read(altitude_t *mirrors, const double cells[REPLAY_MIRRORS_CELLS], double age_s,
                         const altitude_geometry_t *places, const mirror_windows_t *windows,
                         const attitude_t *tilt)
{
    mirror_range_t ranges[MIRROR_COUNT];

    for (int i = 0; i < MIRROR_COUNT; i++) {
        const double *own = &cells[CELLS_A_MIRROR * i];
        const double later_s = isnan(own[AGE_MS]) ? 0.0 : age_s - own[AGE_MS] * 1e-3;

        ranges[i] = (mirror_range_t){.mirror = mirror_of[i],
                                     .valid = !isnan(own[SLANT_MM]),
                                     .slant_mm = (float)or_zero(own[SLANT_MM]),
                                     .spread_mm = (float)or_zero(own[SPREAD_MM]),
                                     .good_rays = (uint16_t)or_zero(own[RAYS]),
                                     .later_us = (int32_t)lround(later_s * 1e6),
                                     .aside_steps = aside_steps(windows, mirror_of[i])};
        ranges[i].slant_mm *= altitude_fan(&ranges[i]);
    }
    altitude_of_mirrors(mirrors, places, ranges, MIRROR_COUNT, tilt->roll_rad, tilt->pitch_rad);
}

/* The slant that the formula of altitude.h turns into this height. */
static altitude_t made(const mirror_geometry_t *place, double height_m, const attitude_t *tilt)
{
    const double roll_rad = (double)tilt->roll_rad, pitch_rad = (double)tilt->pitch_rad;
    const double fore_mm = (double)place->fore_sign * (double)place->distance_mm;
    const double above_mm = height_m * 1e3 + (double)place->leg_mm + (double)place->arm_mm * sin(roll_rad) +
                            fore_mm * sin(pitch_rad);

    return (altitude_t){.valid = true,
                        .height_mm = (float)(height_m * 1e3),
                        .slant_mm = (float)(above_mm / (cos(roll_rad) * cos(pitch_rad))) + place->distance_mm,
                        .distance_mm = place->distance_mm,
                        .leg_mm = place->leg_mm,
                        .arm_mm = place->arm_mm,
                        .fore_mm = (float)fore_mm};
}

void replay_mirrors_make(altitude_t *mirrors, double height_m, bool several,
                         const altitude_geometry_t *places, const attitude_t *tilt)
{
    for (int m = 0; m < MIRROR_COUNT; m++) {
        mirrors[m] = several || m == MIRROR_FRONT ? made(&places->mirror[m], height_m, tilt)
                                                  : (altitude_t){.valid = false};
    }
}
