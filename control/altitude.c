#include "control/altitude.h"

#include <math.h>

const mirror_geometry_t mirror_geometry[] = {
    [MIRROR_FRONT] = {.distance_mm = 105.0F, .leg_mm = 100.0F, .arm_mm = 220.0F, .fore_sign = 0.0F},
    [MIRROR_FORE] = {.distance_mm = 107.0F, .leg_mm = 105.0F, .arm_mm = 115.0F, .fore_sign = 1.0F},
    [MIRROR_AFT] = {.distance_mm = 115.0F, .leg_mm = 98.0F, .arm_mm = 115.0F, .fore_sign = -1.0F},
};
typedef char every_mirror_has_a_geometry[
    (sizeof mirror_geometry / sizeof mirror_geometry[0] == MIRROR_COUNT) ? 1 : -1];

float altitude_under_mirror(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad)
{
    return (slant_mm - mirror->distance_mm) * cosf(pitch_rad) * cosf(roll_rad)
         - mirror->arm_mm * sinf(roll_rad)
         - mirror->fore_sign * mirror->distance_mm * sinf(pitch_rad)
         - mirror->leg_mm;
}

float altitude_at_tilt(const altitude_t *altitude, float roll_rad, float pitch_rad)
{
    return (altitude->slant_mm - altitude->distance_mm) * cosf(pitch_rad) * cosf(roll_rad)
         - altitude->arm_mm * sinf(roll_rad)
         - altitude->fore_mm * sinf(pitch_rad)
         - altitude->leg_mm;
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
}

static void divide(altitude_t *altitude, float groups)
{
    altitude->height_mm /= groups;
    altitude->slant_mm /= groups;
    altitude->distance_mm /= groups;
    altitude->leg_mm /= groups;
    altitude->arm_mm /= groups;
    altitude->fore_mm /= groups;
}

altitude_t altitude_from_ranges(const mirror_range_t *ranges, size_t count, float roll_rad, float pitch_rad)
{
    altitude_t altitude = {.valid = false};
    float groups = 0.0F;
    float lowest_mm = 0.0F;
    float highest_mm = 0.0F;

    for (size_t i = 0; i < count; ++i) {
        const mirror_range_t *range = &ranges[i];
        if (!range->valid) {
            continue;
        }
        const mirror_geometry_t *mirror = &mirror_geometry[range->mirror];
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
