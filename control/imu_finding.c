#include "control/imu_finding.h"

#include <math.h>

#include "control/angle.h"
#include "control/imu_axes.h"

/* A hand never turns about one axis alone. Halfway between one axis and both alike: tan(22.5 degrees). */
#define OTHER_SHARE 0.41421356F
/* 8.5 degrees: there noise makes OTHER_SHARE of the tilt at five sigma. Of a turn it is 0.71 degrees, 0.5 of
 * each of two frames (tools/campaign/plan.py): 5 * 0.71 / 0.414. */
#define TILT_LEAST_RAD 0.14835299F

/* Razor_AHRS; g; m/s2; thousandths of g. */
static const float units[] = {256.0F, 1.0F, 9.80665F, 1000.0F};

bool imu_find_level(parameters_t *parameters, const imu_raw_t *raw)
{
    const float side_counts = sqrtf(raw->x_counts * raw->x_counts + raw->y_counts * raw->y_counts);
    const float down_counts = fabsf(raw->z_counts);

    for (uint16_t i = 0U; raw->has_acceleration && i < sizeof units / sizeof units[0]; ++i) {
        if (fabsf(down_counts - units[i]) <= IMU_UNIT_SHARE * units[i] && side_counts < 0.5F * down_counts) {
            (void)parameters_set(parameters, PARAMETER_IUNIT, units[i]);
            (void)parameters_set(parameters, PARAMETER_IDOWN,
                                 (float)((raw->z_counts < 0.0F) ? DOWN_MINUS_Z : DOWN_Z));
            return true;
        }
    }
    return false;
}

bool imu_find_axis(parameters_t *parameters, parameter_id_t id, const imu_raw_t *level, const imu_raw_t *raw)
{
    const float roll_rad = turn_rad(level->roll_rad, raw->roll_rad);
    const float pitch_rad = turn_rad(level->pitch_rad, raw->pitch_rad);
    const bool by_roll = fabsf(roll_rad) > fabsf(pitch_rad);
    const float tilt_rad = by_roll ? roll_rad : pitch_rad;
    const float other_rad = by_roll ? pitch_rad : roll_rad;
    const control_axis_t plus = by_roll ? AXIS_ROLL : AXIS_PITCH;
    const control_axis_t minus = by_roll ? AXIS_MINUS_ROLL : AXIS_MINUS_PITCH;
    const float size_rad = fabsf(tilt_rad);

    if (size_rad < TILT_LEAST_RAD || size_rad > IMU_STEEP_RAD || fabsf(other_rad) >= OTHER_SHARE * size_rad) {
        return false;
    }
    return parameters_set(parameters, id, (float)((tilt_rad > 0.0F) ? plus : minus)) == PARAMETER_ACCEPTED;
}
