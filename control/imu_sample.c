/* Specific force along the vertical of the earth, less gravity. */
#include "control/imu_sample.h"

#include <math.h>

float imu_up_and_upright(const imu_sample_t *frame, float *upright)
{
    const float level = cosf(frame->median.pitch_rad);
    const float level_roll = cosf(frame->median.roll_rad);

    *upright = level_roll * level;
    return frame->down_mps2 * level * level_roll + frame->right_mps2 * level * sinf(frame->median.roll_rad) -
           frame->forward_mps2 * sinf(frame->median.pitch_rad) - IMU_GRAVITY_MPS2;
}

float imu_up_mps2(const imu_sample_t *frame)
{
    float upright;

    return imu_up_and_upright(frame, &upright);
}
