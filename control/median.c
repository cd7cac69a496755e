#include "control/median.h"

#include "control/angle.h"

float median_of(const float *values, uint16_t count)
{
    const uint16_t middle = (uint16_t)((count - 1U) / 2U);
    uint16_t chosen = 0U;

    for (uint16_t i = 0U; i < count; ++i) {
        uint16_t below = 0U;
        uint16_t not_above = 0U;
        for (uint16_t j = 0U; j < count; ++j) {
            below = (uint16_t)(below + (values[j] < values[i]));
            not_above = (uint16_t)(not_above + (values[j] <= values[i]));
        }
        if (below <= middle && middle < not_above) {
            chosen = i;
        }
    }
    return values[chosen];
}

float median_of_angles(const float *angles_rad, uint16_t count)
{
    uint16_t chosen = 0U;
    float least_rad = 0.0F;

    for (uint16_t i = 0U; i < count; ++i) {
        float sum_rad = 0.0F;
        for (uint16_t j = 0U; j < count; ++j) {
            sum_rad += arc_rad(angles_rad[i], angles_rad[j]);
        }
        if (i == 0U || sum_rad < least_rad) {
            chosen = i;
            least_rad = sum_rad;
        }
    }
    return angles_rad[chosen];
}
