#include "control/imu_sample.h"
#include "unity.h"

#include <math.h>

static imu_sample_t frame;

void setUp(void)
{
    frame = (imu_sample_t){.down_mps2 = 9.80665F};
}

void tearDown(void) {}

void test_at_rest_and_level_nothing_accelerates(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.0F, imu_up_mps2(&frame));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.0F, imu_vertical(&frame).up_mps2);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, imu_vertical(&frame).upright);
}

/* Gravity in the axes of a vehicle that leans: by pitch to its nose, by roll to its right. */
void test_at_rest_and_tilted_nothing_accelerates_either(void)
{
    const float roll_rad = 0.3F, pitch_rad = -0.2F;

    frame.median = (attitude_t){.roll_rad = roll_rad, .pitch_rad = pitch_rad};
    frame.down_mps2 = 9.80665F * cosf(pitch_rad) * cosf(roll_rad);
    frame.right_mps2 = 9.80665F * cosf(pitch_rad) * sinf(roll_rad);
    frame.forward_mps2 = -9.80665F * sinf(pitch_rad);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.0F, imu_vertical(&frame).up_mps2);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, cosf(pitch_rad) * cosf(roll_rad), imu_vertical(&frame).upright);
}

void test_more_than_gravity_is_a_climb(void)
{
    frame.down_mps2 += 1.5F;
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.5F, imu_up_mps2(&frame));
}

void test_the_first_new_frame_is_found_across_the_wrap(void)
{
    const imu_sample_t frames[] = {{.sequence = UINT32_MAX}, {.sequence = 0U}, {.sequence = 1U}};

    TEST_ASSERT_EQUAL_UINT16(0U, imu_first_after(frames, 3U, UINT32_MAX - 1U));
    TEST_ASSERT_EQUAL_UINT16(2U, imu_first_after(frames, 3U, 0U));
    TEST_ASSERT_EQUAL_UINT16(3U, imu_first_after(frames, 3U, 1U));
}
