/* Scans as the control cycle gets them: which of them are judged, and what is told of them. */
#include "control/sense/mounts.h"

#include <math.h>

#include "unity.h"

#define SCAN_US 100000U

static mounts_t mounts;
static parameters_t parameters;
static mirrors_t mirrors;
static flight_outputs_t out;
static imu_fault_t by_gravity;
static flight_inputs_t in;
static imu_sample_t frame;
static altitude_t shown[MIRROR_COUNT];

void setUp(void)
{
    mounts = (mounts_t){.sequence = 0U};
    parameters_init(&parameters);
    parameters.value[PARAMETER_LAYOUT] = (float)LAYOUT_THREE;
    mirrors = (mirrors_t){.agree = false};
    out = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    by_gravity = IMU_SOUND;
    frame = (imu_sample_t){.ready = true};
    in = (flight_inputs_t){
        .height_valid = true, .mirrors = shown, .frames = &frame, .frame_count = 1U, .height_age_us = 70000U};
    for (int m = 0; m < MIRROR_COUNT; m++) {
        shown[m] = (altitude_t){
            .valid = true, .slant_mm = 205.0F, .distance_mm = 105.0F, .leg_mm = 100.0F, .arm_mm = 115.0F};
    }
    shown[MIRROR_FRONT].arm_mm = 220.0F;
    shown[MIRROR_FORE].fore_mm = 107.0F;
    shown[MIRROR_AFT].fore_mm = -115.0F;
}

void tearDown(void) {}

static void step(void)
{
    out.flags = FLIGHT_FLAG_HEIGHT;
    out.imu_fault = by_gravity;
    mounts_step(&mounts, &parameters, &in, &mirrors, &out);
}

static void scans(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        in.height_sequence++;
        in.height_time_us += SCAN_US;
        frame.arrival_us = in.height_time_us;
        step();
        step(); /* the cycle of an IMU frame */
    }
}

/* A cycle without a new scan. */
static flight_mirrors_t found(void)
{
    step();
    return out.mirrors;
}

static void assert_nothing_is_known(void)
{
    const flight_mirrors_t told = found();

    for (int m = 0; m < MIRROR_COUNT; m++) {
        TEST_ASSERT_TRUE(isnan(told.rest_mm[m]));
    }
    TEST_ASSERT_EQUAL_HEX16(0, told.wrong);
    TEST_ASSERT_EQUAL(IMU_SOUND, told.imu);
    TEST_ASSERT_TRUE(isnan(told.off_roll_rad) && isnan(told.off_pitch_rad));
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_HEIGHT, out.flags);
}

void test_before_the_first_scan_nothing_is_known(void)
{
    assert_nothing_is_known();
}

void test_a_mirror_that_shows_no_ground_is_told_after_ten_scans_and_not_before(void)
{
    shown[MIRROR_FORE].valid = false;
    scans(9);
    TEST_ASSERT_EQUAL_HEX16(0, found().wrong);
    scans(1);
    TEST_ASSERT_EQUAL_HEX16(1U << MIRROR_FORE, found().wrong);
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_MIRRORS, out.flags);
    TEST_ASSERT_TRUE(isnan(found().rest_mm[MIRROR_FORE]));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, found().rest_mm[MIRROR_AFT]);
}

/* #IMU RIGHT, by 20 degrees: the gear's left side stays where it is. */
static void raise_right(bool raised)
{
    for (int m = 0; m < MIRROR_COUNT; m++) {
        const float up_mm = shown[m].arm_mm * sinf(0.35F);

        shown[m].slant_mm = 205.0F +
                            (raised ? up_mm / cosf(0.35F) + 100.0F * (1.0F / cosf(0.35F) - 1.0F) : 0.0F);
    }
    in.roll_rad = frame.median.roll_rad = raised ? 0.35F : 0.0F;
}

void test_who_raises_a_side_by_hand_hears_nothing_of_mirrors_or_imu(void)
{
    scans(20);
    raise_right(true);
    scans(50);
    TEST_ASSERT_EQUAL_HEX16(0, found().wrong);
    TEST_ASSERT_EQUAL(IMU_SOUND, found().imu);
    raise_right(false);
    scans(50);
    TEST_ASSERT_EQUAL_HEX16(0, found().wrong);
    TEST_ASSERT_EQUAL(IMU_SOUND, found().imu);
}

void test_an_offset_at_rest_is_told_in_the_angles_of_the_imu(void)
{
    frame.median.roll_rad = 0.05F;
    frame.median.pitch_rad = -0.07F;
    scans(60);
    const flight_mirrors_t told = found();
    TEST_ASSERT_EQUAL(IMU_OFFSET, told.imu);
    TEST_ASSERT_EQUAL(IMU_OFFSET, out.imu_fault);
    by_gravity = IMU_ROLL;
    step();
    TEST_ASSERT_EQUAL(IMU_ROLL, out.imu_fault);
    TEST_ASSERT_FLOAT_WITHIN(0.002F, 0.05F, told.off_roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(0.002F, -0.07F, told.off_pitch_rad);
}

TEST_CASE(LAYOUT_FRONT)
TEST_CASE(LAYOUT_TWO)
void test_with_another_layout_nothing_is_judged_and_what_was_found_is_forgotten(int layout)
{
    shown[MIRROR_FRONT].valid = false;
    scans(20);
    parameters.value[PARAMETER_LAYOUT] = (float)layout;
    scans(20);
    assert_nothing_is_known();
}

void test_a_scan_of_one_mirror_or_without_a_height_is_not_judged(void)
{
    in.mirrors = NULL;
    scans(20);
    in.mirrors = shown;
    in.height_valid = false;
    scans(20);
    assert_nothing_is_known();
}

void test_other_axes_of_the_imu_begin_anew(void)
{
    frame.median.roll_rad = 0.08F;
    scans(60);
    TEST_ASSERT_EQUAL(IMU_OFFSET, found().imu);
    parameters.value[PARAMETER_IROLL] = (float)AXIS_PITCH;
    scans(1);
    TEST_ASSERT_EQUAL(IMU_SOUND, found().imu);
}
