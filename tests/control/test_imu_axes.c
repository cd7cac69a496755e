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

void test_of_two_faults_the_one_that_forbids_to_take_off_is_told_else_that_of_gravity(void)
{
    TEST_ASSERT_EQUAL(IMU_SOUND, imu_axes_worse(IMU_SOUND, IMU_SOUND));
    TEST_ASSERT_EQUAL(IMU_OFFSET, imu_axes_worse(IMU_SOUND, IMU_OFFSET));
    TEST_ASSERT_EQUAL(IMU_UNIT, imu_axes_worse(IMU_UNIT, IMU_OFFSET));
    TEST_ASSERT_EQUAL(IMU_PITCH, imu_axes_worse(IMU_UNIT, IMU_PITCH));
    TEST_ASSERT_EQUAL(IMU_SWAPPED, imu_axes_worse(IMU_SWAPPED, IMU_ROLL));
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

/* ---- one frame at a time */

/* A frame that is what the means are: judged as it stands, after a suspicion of held_s. */
static imu_fault_t look(float roll_rad, float pitch_rad, float told_roll_rad, float told_pitch_rad,
                        float size_mps2, float noise_mps2)
{
    setUp();
    frame.arrival_us = axes.time_us = 5000000U;
    frame.arrival_us += 25000U;
    frame.sequence = 1U;
    frame.forward_mps2 = axes.forward_mps2 = -size_mps2 * sinf(pitch_rad);
    frame.right_mps2 = axes.right_mps2 = size_mps2 * cosf(pitch_rad) * sinf(roll_rad);
    frame.down_mps2 = axes.down_mps2 = size_mps2 * cosf(pitch_rad) * cosf(roll_rad);
    frame.tilt_roll_rad = axes.roll_rad = told_roll_rad;
    frame.tilt_pitch_rad = axes.pitch_rad = told_pitch_rad;
    axes.seen_s = 3.0F;
    imu_axes_step(&axes, &frame, 1U, true, noise_mps2);
    return axes.suspected;
}

void test_a_degree_and_a_fifth_of_the_tilt_are_allowed(void)
{
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0F, 0.0173F, G, 0.0F));
    TEST_ASSERT_NOT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0F, 0.0177F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.1F, 0.0F, 0.1F + 0.0373F, 0.0F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_OTHER, look(0.1F, 0.0F, 0.1F + 0.0377F, 0.0F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, -0.1F, 0.0F, -0.1F - 0.0373F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_OTHER, look(0.0F, -0.1F, 0.0F, -0.1F - 0.0377F, G, 0.0F));
}

void test_noise_allows_more(void)
{
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0395F, 0.0F, G, 1.0F));
    TEST_ASSERT_NOT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0405F, 0.0F, G, 1.0F));
    TEST_ASSERT_NOT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.018F, 0.0F, G, 0.4F));
}

void test_a_change_has_to_mend_half_of_the_disagreement(void)
{
    TEST_ASSERT_EQUAL(IMU_ROLL, look(0.2F, 0.0F, -0.070F, 0.0F, G, 0.0F));  /* leaves 0.130 of 0.270 rad */
    TEST_ASSERT_EQUAL(IMU_OTHER, look(0.2F, 0.0F, -0.063F, 0.0F, G, 0.0F)); /* leaves 0.137 of 0.263 rad */
    TEST_ASSERT_EQUAL(IMU_PITCH, look(0.0F, 0.2F, 0.0F, -0.070F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SWAPPED, look(0.2F, 0.0F, 0.0F, 0.105F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_OTHER, look(0.2F, 0.0F, 0.0F, 0.095F, G, 0.0F));
}

void test_less_than_a_tenth_of_the_tilt_are_radians(void)
{
    TEST_ASSERT_EQUAL(IMU_RADIANS, look(0.2F, 0.0F, 0.019F, 0.0F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_OTHER, look(0.2F, 0.0F, 0.021F, 0.0F, G, 0.0F));
}

void test_nothing_is_said_beyond_sixty_degrees(void)
{
    TEST_ASSERT_EQUAL(IMU_ROLL, look(1.04F, 0.0F, -1.04F, 0.0F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND, look(1.06F, 0.0F, -1.06F, 0.0F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_PITCH, look(0.0F, 1.04F, 0.0F, -1.04F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, -1.06F, 0.0F, 1.06F, G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND,
                      look(1.570746F, 0.0F, 0.0F, 0.0F, G, 0.0F)); /* on its side, not upside down */
    TEST_ASSERT_EQUAL(IMU_DOWN, look(1.572F, 0.0F, 0.0F, 0.0F, G, 0.0F));
}

void test_gravity_is_itself_and_the_largest_bias_to_either_side(void)
{
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0F, 0.0F, 1.152F * G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_UNIT, look(0.0F, 0.0F, 0.0F, 0.0F, 1.154F * G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_SOUND, look(0.0F, 0.0F, 0.0F, 0.0F, 0.848F * G, 0.0F));
    TEST_ASSERT_EQUAL(IMU_UNIT, look(0.0F, 0.0F, 0.0F, 0.0F, 0.846F * G, 0.0F));
}

static void take(float value, uint32_t gap_us, float seen_s)
{
    setUp();
    axes.time_us = 1000000U;
    axes.seen_s = seen_s;
    frame.sequence = 1U;
    frame.arrival_us = 1000000U + gap_us;
    frame.forward_mps2 = frame.right_mps2 = frame.down_mps2 = value;
    frame.tilt_roll_rad = frame.tilt_pitch_rad = value;
    imu_axes_step(&axes, &frame, 1U, true, 0.0F);
}

void test_the_means_are_of_two_seconds_and_of_less_at_first(void)
{
    static const struct {
        uint32_t gap_us;
        float seen_s, share, seen_then_s;
    } rows[] = {{25000U, 3.0F, 0.0125F, 3.0F},      {25000U, 1.975F, 0.0125F, 2.0F},
                {25000U, 0.075F, 0.25F, 0.1F},      {25000U, 0.0F, 1.0F, 0.025F},
                {299000U, 1.0F, 0.230177F, 1.299F}, {301000U, 1.0F, 1.0F, 0.0F},
                {500U, 0.0F, 1.0F, 0.0005F},        {500U, 0.0005F, 0.5F, 0.001F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        take(1.0F, rows[i].gap_us, rows[i].seen_s);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i].share, axes.forward_mps2);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i].share, axes.right_mps2);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i].share, axes.down_mps2);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i].share, axes.roll_rad);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, rows[i].share, axes.pitch_rad);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, rows[i].seen_then_s, axes.seen_s);
    }
}

void test_a_verdict_takes_three_seconds_of_frames_and_one_of_suspicion(void)
{
    take(0.0F, 25000U, 2.97F);
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.suspected);
    take(0.0F, 25000U, 2.98F);
    TEST_ASSERT_EQUAL(IMU_UNIT, axes.suspected); /* nothing felt at all */
    TEST_ASSERT_EQUAL(IMU_SOUND, axes.fault);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, axes.suspected_s);
    for (int frames = 1; frames <= 41; frames++) {
        frame.sequence++;
        frame.arrival_us += 25000U;
        imu_axes_step(&axes, &frame, 1U, true, 0.0F);
        TEST_ASSERT_EQUAL((frames < 41) ? IMU_SOUND : IMU_UNIT, (frames == 40) ? IMU_SOUND : axes.fault);
    }
    TEST_ASSERT_EQUAL_FLOAT(1.0F, axes.suspected_s);
}

void test_frames_of_the_air_end_seeing_and_suspicion(void)
{
    for (int why = 0; why < 3; why++) {
        setUp();
        axes.seen_s = axes.suspected_s = 0.7F;
        frame.sequence = 1U;
        frame.ready = why != 1;
        frame.has_acceleration = why != 2;
        imu_axes_step(&axes, &frame, 1U, why != 0, 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, axes.seen_s);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, axes.suspected_s);
    }
}

void test_each_of_several_frames_counts_and_only_once(void)
{
    imu_sample_t frames[2] = {frame, frame};
    axes.time_us = 1000000U;
    for (uint32_t i = 0U; i < 2U; i++) {
        frames[i].sequence = i + 1U;
        frames[i].arrival_us = 1025000U + 25000U * i;
    }
    imu_axes_step(&axes, frames, 2U, true, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.05F, axes.seen_s);
    imu_axes_step(&axes, frames, 2U, true, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.05F, axes.seen_s);
}
