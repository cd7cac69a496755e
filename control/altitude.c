#include "control/altitude.h"

#include <math.h>

/* one ray has no spread: a beam that is blocked or frozen would look as a quiet one */
#define RAYS_LEAST 2U

typedef char every_mirror_has_its_place_below[(MIRROR_COUNT == 3) ? 1 : -1];

altitude_geometry_t altitude_geometry_of(const parameters_t *parameters)
{
    const float *const mm = parameters->value;
    const float abeam_mm = mm[PARAMETER_L] - mm[PARAMETER_DF];

    return (altitude_geometry_t){
        .mirror = {
            [MIRROR_FRONT] = {mm[PARAMETER_DF], mm[PARAMETER_LF], mm[PARAMETER_L], 0.0F},
            [MIRROR_FORE] = {mm[PARAMETER_D2], mm[PARAMETER_L2], abeam_mm, 1.0F},
            [MIRROR_AFT] = {mm[PARAMETER_D1], mm[PARAMETER_L1], abeam_mm, -1.0F},
        }};
}

altitude_geometry_t altitude_geometry_default(void)
{
    parameters_t parameters;

    parameters_init(&parameters);
    return altitude_geometry_of(&parameters);
}

float altitude_under_mirror(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad)
{
    return (slant_mm - mirror->distance_mm) * cosf(pitch_rad) * cosf(roll_rad) -
           mirror->arm_mm * sinf(roll_rad) - mirror->fore_sign * mirror->distance_mm * sinf(pitch_rad) -
           mirror->leg_mm;
}

float altitude_at_tilt(const altitude_t *altitude, float roll_rad, float pitch_rad)
{
    return (altitude->slant_mm - altitude->distance_mm) * cosf(pitch_rad) * cosf(roll_rad) -
           altitude->arm_mm * sinf(roll_rad) - altitude->fore_mm * sinf(pitch_rad) - altitude->leg_mm;
}

static uint16_t whole(float steps)
{
    return (uint16_t)(steps + 0.5F);
}

/* Seen from the scanner, by the drawing; and where a ray beside the axis by a radian, on the side of larger
 * steps, meets the ground, in its lengths. */
static const struct {
    parameter_id_t middle;
    float axis_step;
    float arm, fore;
} sides[MIRROR_COUNT] = {
    [MIRROR_FRONT] = {PARAMETER_SF, SCANNER_RIGHT_STEP, 0.0F, 1.0F},
    [MIRROR_FORE] = {PARAMETER_S2, SCANNER_RIGHT_STEP + 256.0F, -1.0F, 0.0F},
    [MIRROR_AFT] = {PARAMETER_S1, SCANNER_RIGHT_STEP - 256.0F, 1.0F, 0.0F},
};

static void add_window(mirror_windows_t *windows, mirror_t mirror, const parameters_t *parameters)
{
    const parameter_id_t middle = sides[mirror].middle;
    const float aside = parameters->value[middle] - parameter_table[middle].initial;

    windows->mirror[windows->count] = mirror;
    windows->middle[windows->count] = whole(parameters->value[middle]);
    windows->axis[windows->count] = sides[mirror].axis_step + aside;
    ++windows->count;
}

mirror_windows_t altitude_windows_of(const parameters_t *parameters)
{
    const uint16_t layout = parameters_choice(parameters, PARAMETER_LAYOUT);
    mirror_windows_t windows = {.count = 0U};

    windows.reach = whole(parameters->value[PARAMETER_SW]);
    if (layout != LAYOUT_FRONT) {
        add_window(&windows, MIRROR_AFT, parameters);
    }
    if (layout != LAYOUT_TWO) {
        add_window(&windows, MIRROR_FRONT, parameters);
    }
    if (layout != LAYOUT_FRONT) {
        add_window(&windows, MIRROR_FORE, parameters);
    }
    return windows;
}

float altitude_fan(const mirror_range_t *range)
{
    const float wide_steps2 = range->wide_steps2 + range->aside_steps * range->aside_steps;

    return 1.0F + 0.5F * SCANNER_STEP_RAD * SCANNER_STEP_RAD * wide_steps2;
}

static altitude_t altitude_of(const mirror_geometry_t *mirror, const mirror_range_t *range, float roll_rad,
                              float pitch_rad)
{
    const float aside_rad = range->aside_steps * SCANNER_STEP_RAD;
    const float slant_mm = range->slant_mm / altitude_fan(range);
    altitude_t altitude = {
        .valid = range->valid && range->good_rays >= RAYS_LEAST,
        .slant_mm = slant_mm,
        .spread_mm = range->spread_mm,
        .good_rays = range->good_rays,
        .distance_mm = mirror->distance_mm,
        .leg_mm = mirror->leg_mm,
        .arm_mm = mirror->arm_mm + aside_rad * slant_mm * sides[range->mirror].arm,
        .fore_mm = mirror->fore_sign * mirror->distance_mm + aside_rad * slant_mm * sides[range->mirror].fore,
        .later_us = range->later_us,
    };

    altitude.height_mm = altitude_at_tilt(&altitude, roll_rad, pitch_rad);
    return altitude;
}

const float altitude_weights_equal[MIRROR_COUNT] = {1.0F, 1.0F, 1.0F};

static void add(altitude_t *sum, const altitude_t *one, float weight)
{
    sum->valid = true;
    sum->height_mm += weight * one->height_mm;
    sum->slant_mm += weight * one->slant_mm;
    sum->spread_mm = fmaxf(sum->spread_mm, one->spread_mm);
    sum->good_rays = (uint16_t)(sum->good_rays + one->good_rays);
    sum->distance_mm += weight * one->distance_mm;
    sum->leg_mm += weight * one->leg_mm;
    sum->arm_mm += weight * one->arm_mm;
    sum->fore_mm += weight * one->fore_mm;
    sum->later_us += (int32_t)(weight * (float)one->later_us);
}

altitude_t altitude_mean(const altitude_t *altitudes, const float *weights, size_t count)
{
    altitude_t mean = {.valid = false};
    float sum = 0.0F;

    for (size_t i = 0; i < count; ++i) {
        sum += altitudes[i].valid ? weights[i] : 0.0F;
    }
    for (size_t i = 0; i < count; ++i) {
        if (altitudes[i].valid && weights[i] > 0.0F) {
            add(&mean, &altitudes[i], weights[i] / sum);
        }
    }
    return mean;
}

void altitude_of_mirrors(altitude_t *altitudes, const altitude_geometry_t *geometry,
                         const mirror_range_t *ranges, size_t count, float roll_rad, float pitch_rad)
{
    for (size_t m = 0; m < MIRROR_COUNT; ++m) {
        altitudes[m] = (altitude_t){.valid = false};
    }
    for (size_t i = 0; i < count; ++i) {
        const mirror_t mirror = ranges[i].mirror;
        altitudes[mirror] = altitude_of(&geometry->mirror[mirror], &ranges[i], roll_rad, pitch_rad);
    }
}

altitude_t altitude_from_ranges(const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                                size_t count, float roll_rad, float pitch_rad)
{
    altitude_t altitudes[MIRROR_COUNT];

    altitude_of_mirrors(altitudes, geometry, ranges, count, roll_rad, pitch_rad);
    return altitude_mean(altitudes, altitude_weights_equal, MIRROR_COUNT);
}
