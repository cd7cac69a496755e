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

static void add_mirror(altitude_t *altitude, const mirror_geometry_t *mirror, const mirror_range_t *range)
{
    altitude->slant_mm += range->slant_mm;
    altitude->spread_mm = fmaxf(altitude->spread_mm, range->spread_mm);
    altitude->good_rays = (uint16_t)(altitude->good_rays + range->good_rays);
    altitude->distance_mm += mirror->distance_mm;
    altitude->leg_mm += mirror->leg_mm;
    altitude->arm_mm += mirror->arm_mm;
    altitude->fore_mm += mirror->fore_sign * mirror->distance_mm;
    altitude->later_us += range->later_us;
    ++altitude->agreeing;
}

static void divide(altitude_t *altitude, float groups)
{
    altitude->later_us /= (int32_t)altitude->agreeing;
    altitude->height_mm /= groups;
    altitude->slant_mm /= groups;
    altitude->distance_mm /= groups;
    altitude->leg_mm /= groups;
    altitude->arm_mm /= groups;
    altitude->fore_mm /= groups;
}

altitude_t altitude_from_ranges(const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                                size_t count, float roll_rad, float pitch_rad)
{
    altitude_t altitude = {.valid = false};
    float groups = 0.0F;
    float lowest_mm = 0.0F;
    float highest_mm = 0.0F;

    for (size_t i = 0; i < count; ++i) {
        const mirror_range_t *range = &ranges[i];
        if (!range->valid || range->good_rays < RAYS_LEAST) {
            continue;
        }
        const mirror_geometry_t *mirror = &geometry->mirror[range->mirror];
        const float height_mm = altitude_under_mirror(mirror, range->slant_mm, roll_rad, pitch_rad);
        lowest_mm = altitude.valid ? fminf(lowest_mm, height_mm) : height_mm;
        highest_mm = altitude.valid ? fmaxf(highest_mm, height_mm) : height_mm;
        altitude.valid = true;
        altitude.height_mm += height_mm;
        add_mirror(&altitude, mirror, range);
        groups += 1.0F;
    }
    if (altitude.valid) {
        divide(&altitude, groups);
        altitude.disagree = highest_mm - lowest_mm > ALTITUDE_DISAGREE_MM;
    }
    return altitude;
}
