/* Specific force along the vertical of the earth, less gravity. */
#include "control/imu_sample.h"

#include <math.h>

imu_vertical_t imu_vertical(const imu_sample_t *frame)
{
    const float level = cosf(frame->median.pitch_rad);
    const float level_roll = cosf(frame->median.roll_rad);
    const float up_mps2 = frame->down_mps2 * level * level_roll +
                          frame->right_mps2 * level * sinf(frame->median.roll_rad) -
                          frame->forward_mps2 * sinf(frame->median.pitch_rad) - IMU_GRAVITY_MPS2;

    return (imu_vertical_t){.up_mps2 = up_mps2, .upright = level_roll * level};
}

float imu_up_mps2(const imu_sample_t *frame)
{
    return imu_vertical(frame).up_mps2;
}
