#include "control/imu_mapping.h"

#include "control/imu_sample.h"

imu_mapping_t imu_mapping_of(const parameters_t *parameters)
{
    const bool upside = parameters_choice(parameters, PARAMETER_IDOWN) == DOWN_MINUS_Z;
    const float counts = parameters->value[PARAMETER_IUNIT];

    return (imu_mapping_t){
        .roll = parameters_choice(parameters, PARAMETER_IROLL),
        .pitch = parameters_choice(parameters, PARAMETER_IPITCH),
        .counts_per_g = upside ? -counts : counts,
    };
}

static float sign_of(uint16_t axis)
{
    return (axis == AXIS_MINUS_ROLL || axis == AXIS_MINUS_PITCH) ? -1.0F : 1.0F;
}

static bool is_roll(uint16_t axis)
{
    return axis == AXIS_ROLL || axis == AXIS_MINUS_ROLL;
}

static float angle_of(uint16_t axis, const attitude_t *imu)
{
    return sign_of(axis) * (is_roll(axis) ? imu->roll_rad : imu->pitch_rad);
}

attitude_t imu_map_angles(const imu_mapping_t *mapping, const attitude_t *imu)
{
    return (attitude_t){
        .roll_rad = angle_of(mapping->roll, imu),
        .pitch_rad = angle_of(mapping->pitch, imu),
        .yaw_rad = imu->yaw_rad,
    };
}

/* Gravity along y grows with the IMU's roll, along x it falls with its pitch. */
void imu_map_acceleration(const imu_mapping_t *mapping, const imu_raw_t *raw, float *forward_mps2,
                          float *right_mps2, float *down_mps2)
{
    const float scale = IMU_GRAVITY_MPS2 / mapping->counts_per_g;
    const float right = is_roll(mapping->roll) ? raw->y_counts : -raw->x_counts;
    const float forward = is_roll(mapping->pitch) ? -raw->y_counts : raw->x_counts;

    *forward_mps2 = sign_of(mapping->pitch) * scale * forward;
    *right_mps2 = sign_of(mapping->roll) * scale * right;
    *down_mps2 = scale * raw->z_counts;
}

float imu_degrees(float rad)
{
    return 57.29578F * rad;
}
