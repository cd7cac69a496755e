/* The IMU's axes and unit to the vehicle's: an IMU is turned in the test, and the vehicle must come out the
 * same. */
#include "control/imu_mapping.h"

#include <math.h>

#include "unity.h"

#define G 9.80665F

static parameters_t parameters;

void setUp(void)
{
    parameters_init(&parameters);
}

void tearDown(void) {}

/* What an IMU that counts 256 per g says when its own roll and pitch are these. */
static imu_raw_t at_rest(float roll_rad, float pitch_rad)
{
    return (imu_raw_t){
        .yaw_rad = 1.0F,
        .pitch_rad = pitch_rad,
        .roll_rad = roll_rad,
        .has_acceleration = true,
        .x_counts = -256.0F * sinf(pitch_rad),
        .y_counts = 256.0F * cosf(pitch_rad) * sinf(roll_rad),
        .z_counts = 256.0F * cosf(pitch_rad) * cosf(roll_rad),
    };
}

/* Gravity in the vehicle's frame must be where its angles say. */
static void assert_vehicle(const imu_raw_t *raw, float roll_rad, float pitch_rad)
{
    const imu_mapping_t mapping = imu_mapping_of(&parameters);
    const attitude_t imu = {.roll_rad = raw->roll_rad, .pitch_rad = raw->pitch_rad, .yaw_rad = raw->yaw_rad};
    const attitude_t vehicle = imu_map_angles(&mapping, &imu);
    float forward, right, down;

    imu_map_acceleration(&mapping, raw, &forward, &right, &down);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, roll_rad, vehicle.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, pitch_rad, vehicle.pitch_rad);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, vehicle.yaw_rad);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, -G * sinf(pitch_rad), forward);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, G * cosf(pitch_rad) * sinf(roll_rad), right);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, G * cosf(pitch_rad) * cosf(roll_rad), down);
}

static void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

void test_as_delivered_a_razor_with_its_own_firmware_fits_right_wing_down_is_our_left_side_up(void)
{
    const imu_raw_t right_wing_down = at_rest(0.2F, 0.0F), nose_up = at_rest(0.0F, 0.1F);

    assert_vehicle(&right_wing_down, -0.2F, 0.0F);
    assert_vehicle(&nose_up, 0.0F, 0.1F);
}

void test_an_imu_turned_by_a_quarter_or_a_half_on_its_plate(void)
{
    const imu_raw_t tilted = at_rest(0.1F, -0.02F);

    set(PARAMETER_IROLL, AXIS_ROLL);
    set(PARAMETER_IPITCH, AXIS_MINUS_PITCH);
    assert_vehicle(&tilted, 0.1F, 0.02F);
    set(PARAMETER_IROLL, AXIS_PITCH);
    set(PARAMETER_IPITCH, AXIS_ROLL);
    assert_vehicle(&tilted, -0.02F, 0.1F);
    set(PARAMETER_IROLL, AXIS_MINUS_PITCH);
    set(PARAMETER_IPITCH, AXIS_MINUS_ROLL);
    assert_vehicle(&tilted, 0.02F, -0.1F);
}

void test_another_unit_and_the_opposite_sign(void)
{
    imu_raw_t raw = at_rest(0.05F, 0.03F);

    raw.x_counts *= -9.80665F / 256.0F;
    raw.y_counts *= -9.80665F / 256.0F;
    raw.z_counts *= -9.80665F / 256.0F;
    set(PARAMETER_IUNIT, 9.80665F);
    set(PARAMETER_IDOWN, DOWN_MINUS_Z);
    assert_vehicle(&raw, -0.05F, 0.03F);
}

void test_half_a_turn_is_180_degrees(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, -180.0F, imu_degrees(-3.14159265F));
}
