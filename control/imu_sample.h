/* One IMU frame in the vehicle's axes, with the offset of its angles removed. Angles in radians; the times
 * are on one wrapping 32-bit clock. */
#ifndef CONTROL_IMU_SAMPLE_H
#define CONTROL_IMU_SAMPLE_H

#include <stdbool.h>
#include <stdint.h>

#include "control/attitude.h"

#define IMU_GRAVITY_MPS2 9.80665F /* standard gravity */

typedef struct {
    uint32_t sequence; /* frames so far; 0 = none yet */
    uint32_t arrival_us;
    bool ready;                          /* the offset of the angles is known */
    uint16_t rolled;                     /* attitude.h */
    attitude_t level;                    /* offset removed */
    attitude_t median;                   /* median of this frame and the four before it */
    float tilt_roll_rad, tilt_pitch_rad; /* the same median, offset not removed */
    bool has_acceleration;
    /* Specific force in the vehicle's axes; at rest and level 0, 0, +9.81. */
    float forward_mps2, right_mps2, down_mps2;
    uint32_t malformed; /* frames refused so far */
} imu_sample_t;

/* Index of the first frame after `sequence`; `count` when there is none. frames: oldest first. The search
 * starts at the end, because only few of the frames that a control cycle gets are new. */
static inline uint16_t imu_first_after(const imu_sample_t *frames, uint16_t count, uint32_t sequence)
{
    uint16_t first = count;

    while (first > 0U && (int32_t)(frames[first - 1U].sequence - sequence) > 0) {
        --first;
    }
    return first;
}

/* What a frame says about the vertical. */
typedef struct {
    float up_mps2; /* upward acceleration that its accelerometer measures, gravity removed */
    float upright; /* cosine of its tilt */
} imu_vertical_t;

imu_vertical_t imu_vertical(const imu_sample_t *frame);

/* Its acceleration alone. */
float imu_up_mps2(const imu_sample_t *frame);

#endif
