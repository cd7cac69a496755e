/* A vehicle that is told one frame, one tilt or one height at a time. */
#ifndef TESTS_CONTROL_ONE_FRAME_H
#define TESTS_CONTROL_ONE_FRAME_H

#include "sense/sensed.h"

static command_t flown;
static imu_sample_t frame;

static inline void begin(void)
{
    sensed_begin();
    flown = (command_t){.step_s = 0.025F, .off_ground = true, .ours = true, .authority_mps2_per_n = 1.4F};
    frame = (imu_sample_t){.ready = true, .has_acceleration = true, .down_mps2 = G_MPS2};
}

static inline void tilt(float roll_rad, float pitch_rad)
{
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.median.roll_rad = roll_rad;
    frame.median.pitch_rad = pitch_rad;
    frame.level = frame.median;
    tilt_step(&senses.tilt, &frame, 1U, 0.0F, 0.0F, 0U);
}

static inline void feel(float up_mps2)
{
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.down_mps2 = G_MPS2 + up_mps2;
    sensed_frames(&flown, &frame, 1U);
}

static inline void rock(float roll_rad, float pitch_rad)
{
    frame.median.roll_rad = roll_rad;
    frame.median.pitch_rad = pitch_rad;
    feel(0.0F);
}

/* In the air at 0.5 m; nothing known of the past. */
static inline void hover(void)
{
    begin();
    senses.heights.known = senses.confirmation.proved = true;
    at_m(0.5F);
    came_near_at_m(0.5F);
    flown.wanted_m = 0.5F;
}

static inline void height(float height_m)
{
    sensed_height(&flown, height_m, 0.1F, 0.0F);
}

static inline void feel_at_once(float up_mps2)
{
    frame.arrival_us -= 25000U;
    feel(up_mps2);
}

#endif
