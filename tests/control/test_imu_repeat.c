#include <unity.h>

#include "control/imu_repeat.h"

static imu_repeat_t repeat;
static imu_raw_t frame;

void setUp(void)
{
    repeat = (imu_repeat_t){.times = 0U};
    frame = (imu_raw_t){.yaw_rad = 1.5F,
                        .pitch_rad = 0.01F,
                        .roll_rad = -0.02F,
                        .has_acceleration = true,
                        .x_counts = 3.0F,
                        .y_counts = -2.0F,
                        .z_counts = 256.0F};
}

void tearDown(void) {}

void test_a_frame_that_comes_five_times_again_says_nothing_and_then_as_long_as_it_comes(void)
{
    for (int32_t k = 0; k < 70000; k++) {
        TEST_ASSERT_EQUAL_INT((k < 5) ? 0 : 1, imu_repeats(&repeat, &frame) ? 1 : 0);
    }
    frame.yaw_rad += 1.0e-4F;
    TEST_ASSERT_FALSE(imu_repeats(&repeat, &frame));
}

void test_one_new_digit_of_anything_is_a_new_frame(void)
{
    for (int what = 0; what < 7; what++) {
        float *const digits[6] = {&frame.yaw_rad,  &frame.pitch_rad, &frame.roll_rad,
                                  &frame.x_counts, &frame.y_counts,  &frame.z_counts};
        setUp();
        for (int k = 0; k < 100; k++) {
            if (what < 6) {
                *digits[what] += (k % 2 == 0) ? 0.25F : -0.25F;
            } else {
                frame.has_acceleration = !frame.has_acceleration;
            }
            TEST_ASSERT_FALSE(imu_repeats(&repeat, &frame));
        }
    }
}

void test_accelerations_that_do_not_come_are_not_compared(void)
{
    frame.has_acceleration = false;
    for (int k = 0; k < 10; k++) {
        frame.x_counts += 1.0F;
        TEST_ASSERT_EQUAL_INT((k < 5) ? 0 : 1, imu_repeats(&repeat, &frame) ? 1 : 0);
    }
}

void test_the_first_frame_is_new_also_when_all_of_it_is_0(void)
{
    const imu_raw_t nothing = {.has_acceleration = false};

    TEST_ASSERT_FALSE(imu_repeats(&repeat, &nothing));
}
