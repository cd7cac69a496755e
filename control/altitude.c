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

static void add_window(mirror_windows_t *windows, mirror_t mirror, float middle)
{
    windows->mirror[windows->count] = mirror;
    windows->middle[windows->count] = whole(middle);
    ++windows->count;
}

mirror_windows_t altitude_windows_of(const parameters_t *parameters)
{
    const uint16_t layout = parameters_choice(parameters, PARAMETER_LAYOUT);
    mirror_windows_t windows = {.count = 0U};

    windows.reach = whole(parameters->value[PARAMETER_SW]);
    if (layout != LAYOUT_FRONT) {
        add_window(&windows, MIRROR_AFT, parameters->value[PARAMETER_S1]);
    }
    if (layout != LAYOUT_TWO) {
        add_window(&windows, MIRROR_FRONT, parameters->value[PARAMETER_SF]);
    }
    if (layout != LAYOUT_FRONT) {
        add_window(&windows, MIRROR_FORE, parameters->value[PARAMETER_S2]);
    }
    return windows;
}

static altitude_t altitude_of(const mirror_geometry_t *mirror, const mirror_range_t *range, float roll_rad,
                              float pitch_rad)
{
    return (altitude_t){
        .valid = range->valid && range->good_rays >= RAYS_LEAST,
        .height_mm = altitude_under_mirror(mirror, range->slant_mm, roll_rad, pitch_rad),
        .slant_mm = range->slant_mm,
        .spread_mm = range->spread_mm,
        .good_rays = range->good_rays,
        .distance_mm = mirror->distance_mm,
        .leg_mm = mirror->leg_mm,
        .arm_mm = mirror->arm_mm,
        .fore_mm = mirror->fore_sign * mirror->distance_mm,
        .later_us = range->later_us,
        .agreeing = 1U,
    };
}

static void add(altitude_t *sum, const altitude_t *one)
{
    sum->valid = true;
    sum->height_mm += one->height_mm;
    sum->slant_mm += one->slant_mm;
    sum->spread_mm = fmaxf(sum->spread_mm, one->spread_mm);
    sum->good_rays = (uint16_t)(sum->good_rays + one->good_rays);
    sum->distance_mm += one->distance_mm;
    sum->leg_mm += one->leg_mm;
    sum->arm_mm += one->arm_mm;
    sum->fore_mm += one->fore_mm;
    sum->later_us += one->later_us;
    ++sum->agreeing;
}

static void divide(altitude_t *sum)
{
    const float groups = (float)sum->agreeing;

    sum->later_us /= (int32_t)sum->agreeing;
    sum->height_mm /= groups;
    sum->slant_mm /= groups;
    sum->distance_mm /= groups;
    sum->leg_mm /= groups;
    sum->arm_mm /= groups;
    sum->fore_mm /= groups;
}

altitude_t altitude_mean(const altitude_t *altitudes, size_t count)
{
    altitude_t mean = {.valid = false};
    float lowest_mm = 0.0F;
    float highest_mm = 0.0F;

    for (size_t i = 0; i < count; ++i) {
        const altitude_t *one = &altitudes[i];
        if (one->valid) {
            lowest_mm = mean.valid ? fminf(lowest_mm, one->height_mm) : one->height_mm;
            highest_mm = mean.valid ? fmaxf(highest_mm, one->height_mm) : one->height_mm;
            add(&mean, one);
        }
    }
    if (mean.valid) {
        divide(&mean);
        mean.disagree = highest_mm - lowest_mm > ALTITUDE_DISAGREE_MM;
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
    return altitude_mean(altitudes, MIRROR_COUNT);
}
