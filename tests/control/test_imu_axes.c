/* Angles against gravity, as a vehicle that stands or is held in the hand shows them. */
#include "control/imu_axes.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define G 9.80665F
#define DEG 0.017453293F

static imu_axes_t axes;
static imu_sample_t frame;
static uint32_t state;

static float noise(float rms)
{
    float sum = 0.0F;
    for (int i = 0; i < 12; i++) {
        state = state * 1664525U + 1013904223U;
        sum += (float)(state >> 8) / 16777216.0F - 0.5F;
    }
    return rms * sum;
}

void setUp(void)
{
    imu_axes_init(&axes);
    frame = (imu_sample_t){.arrival_us = 0xFFFFF000U, .ready = true, .has_acceleration = true};
    state = 1U;
}

void tearDown(void) {}

static void stand(float roll_deg, float pitch_deg, float felt_mps2, float noise_mps2, float seconds)
{
    const float roll = roll_deg * DEG, pitch = pitch_deg * DEG;
    for (int i = 0; i < (int)(seconds * 40.0F); i++) {
        frame.sequence++;
        frame.arrival_us += 25000U;
        frame.forward_mps2 = -felt_mps2 * sinf(pitch) + noise(noise_mps2);
        frame.right_mps2 = felt_mps2 * cosf(pitch) * sinf(roll) + noise(noise_mps2);
        frame.down_mps2 = felt_mps2 * cosf(pitch) * cosf(roll) + noise(noise_mps2);
        imu_axes_step(&axes, &frame, 1U, true, noise_mps2);
    }
}

static void tell(float roll_deg, float pitch_deg)
{
    frame.tilt_roll_rad = roll_deg * DEG;
    frame.tilt_pitch_rad = pitch_deg * DEG;
}

void test_each_way_to_be_wrong_has_its_name(void)
{
    static const struct {
        float roll_deg, pitch_deg, told_roll_deg, told_pitch_deg, felt;
        imu_fault_t fault;
    } rows[] = {
        {2, -2, 2, -2, G, IMU_SOUND},
        {2, -2, -2, -2, G, IMU_ROLL},
        {2, -2, 2, 2, G, IMU_PITCH},
        {2, -2, -2, 2, G, IMU_BOTH},
        {2, 0, 0, 2, G, IMU_SWAPPED},
        {2, 0, 0, -2, G, IMU_SWAPPED},
        {3, -2, 0.05F, -0.03F, G, IMU_RADIANS},
        {20, 3, 10, 12, G, IMU_OTHER},
        {2, -2, 2, -2, 1, IMU_UNIT},
        {2, -2, 2, -2, 1.16F * G, IMU_UNIT},
        {2, -2, 2, -2, 1.14F * G, IMU_SOUND},
        {2, -2, 2, -2, -G, IMU_DOWN},
        {0, 0, 0, 0, G, IMU_SOUND},
        {-15, 0, 15, 0, G, IMU_ROLL},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        tell(rows[i].told_roll_deg, rows[i].told_pitch_deg);
        stand(rows[i].roll_deg, rows[i].pitch_deg, rows[i].felt, 0.0F, 6.0F);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(imu_fault_name(rows[i].fault), imu_fault_name(axes.fault),
                                         "of the row");
    }
}

void test_it_takes_four_seconds_of_standing(void)
{
    tell(-2.0F, 0.0F);
    stand(2.0F, 0.0F, G, 0.0F, 3.8F);
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
    stand(2.0F, 0.0F, G, 0.0F, 0.4F);
    TEST_ASSERT_EQUAL(IMU_ROLL, axes.fault);
    tell(2.0F, 0.0F); /* mended */
    stand(2.0F, 0.0F, G, 0.0F, 6.0F);
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
}

void test_a_gap_begins_anew_and_the_air_and_bare_angles_tell_nothing(void)
{
    tell(-2.0F, 0.0F);
    stand(2.0F, 0.0F, G, 0.0F, 3.0F);
    frame.arrival_us += 400000U;
    stand(2.0F, 0.0F, G, 0.0F, 3.0F);
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
    frame.has_acceleration = false;
    stand(2.0F, 0.0F, G, 0.0F, 6.0F);
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
    for (int i = 0; i < 400; i++) {
        frame.has_acceleration = true;
        frame.sequence++;
        frame.arrival_us += 25000U;
        imu_axes_step(&axes, &frame, 1U, false, 0.0F);
    }
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
}

void test_noise_is_no_fault(void)
{
    static const float noises_mps2[] = {0.1F, 0.4F, 1.6F, 5.0F};
    for (unsigned i = 0; i < 4; i++) {
        setUp();
        tell(1.0F, -0.5F);
        for (int k = 0; k < 300; k++) {
            stand(1.0F, -0.5F, G, noises_mps2[i], 1.0F);
            TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
        }
    }
}

void test_what_may_not_take_off(void)
{
    parameters_t parameters;
    parameters_init(&parameters);
    for (int fault = IMU_SOUND; fault < IMU_FAULT_COUNT; fault++) {
        TEST_ASSERT_EQUAL(fault >= IMU_ROLL, imu_axes_forbid((imu_fault_t)fault, &parameters));
    }
    parameters_set(&parameters, PARAMETER_IROLL, (float)AXIS_PITCH);
    TEST_ASSERT_TRUE(imu_axes_forbid(IMU_SOUND, &parameters));
    parameters_set(&parameters, PARAMETER_IAXES, (float)AXES_PROVED);
    TEST_ASSERT_FALSE(imu_axes_forbid(IMU_SOUND, &parameters));
    TEST_ASSERT_FALSE(imu_axes_forbid(IMU_ROLL, &parameters));
}
