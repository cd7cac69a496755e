/* Axes and unit found from how the vehicle is held. */
#include "control/imu_finding.h"

#include "unity.h"

static parameters_t parameters;
static imu_raw_t level;

void setUp(void)
{
    parameters_init(&parameters);
    level = (imu_raw_t){.has_acceleration = true,
                        .z_counts = 250.0F,
                        .x_counts = 8.0F,
                        .roll_rad = 0.02F,
                        .pitch_rad = -0.03F};
}

void tearDown(void) {}

static uint16_t choice(parameter_id_t id)
{
    return parameters_choice(&parameters, id);
}

void test_level_finds_the_unit_and_which_way_down_is(void)
{
    static const float units[] = {256.0F, 1.0F, 9.80665F, 1000.0F};

    for (uint16_t i = 0; i < 8U; i++) {
        setUp();
        level.x_counts = 0.1F * units[i / 2U];
        level.z_counts = units[i / 2U] * ((i % 2U == 0U) ? 1.1F : -0.9F);
        TEST_ASSERT_TRUE(imu_find_level(&parameters, &level));
        TEST_ASSERT_EQUAL_FLOAT(units[i / 2U], parameters.value[PARAMETER_IUNIT]);
        TEST_ASSERT_EQUAL_UINT16(i % 2U == 0U ? DOWN_Z : DOWN_MINUS_Z, choice(PARAMETER_IDOWN));
    }
}

void test_no_accelerations_or_ones_that_are_no_gravity_set_nothing(void)
{
    const parameters_t before = parameters;

    level.has_acceleration = false;
    TEST_ASSERT_FALSE(imu_find_level(&parameters, &level));
    level.has_acceleration = true;
    level.z_counts = 128.0F;
    TEST_ASSERT_FALSE(imu_find_level(&parameters, &level));
    level.z_counts = 250.0F;
    level.x_counts = 200.0F;
    TEST_ASSERT_FALSE(imu_find_level(&parameters, &level));
    TEST_ASSERT_EQUAL_MEMORY(&before, &parameters, sizeof before);
}

void test_the_angle_that_turned_becomes_the_vehicles_with_its_sign(void)
{
    static const struct {
        float roll_rad, pitch_rad;
        control_axis_t found;
    } rows[] = {{0.25F, 0.02F, AXIS_ROLL},
                {-0.25F, 0.02F, AXIS_MINUS_ROLL},
                {0.05F, 0.3F, AXIS_PITCH},
                {0.05F, -0.3F, AXIS_MINUS_PITCH}};

    for (uint16_t i = 0; i < 4U; i++) {
        imu_raw_t now = level;

        now.roll_rad += rows[i].roll_rad;
        now.pitch_rad += rows[i].pitch_rad;
        TEST_ASSERT_TRUE(imu_find_axis(&parameters, PARAMETER_IROLL, &level, &now));
        TEST_ASSERT_EQUAL_UINT16(rows[i].found, choice(PARAMETER_IROLL));
        TEST_ASSERT_TRUE(imu_find_axis(&parameters, PARAMETER_IPITCH, &level, &now));
        TEST_ASSERT_EQUAL_UINT16(rows[i].found, choice(PARAMETER_IPITCH));
    }
}

void test_across_the_wrap_the_turn_is_the_short_one(void)
{
    imu_raw_t now = level;

    level.roll_rad = 3.1F;
    now.roll_rad = -3.0F;
    TEST_ASSERT_TRUE(imu_find_axis(&parameters, PARAMETER_IROLL, &level, &now));
    TEST_ASSERT_EQUAL_UINT16(AXIS_ROLL, choice(PARAMETER_IROLL));
}

void test_too_little_too_much_or_about_both_axes_sets_nothing(void)
{
    static const float turns[][2] = {{0.0F, 0.0F}, {0.13F, 0.0F}, {1.1F, 0.0F}, {0.3F, 0.16F}, {-0.3F, 0.3F}};
    const parameters_t before = parameters;

    for (uint16_t i = 0; i < sizeof turns / sizeof turns[0]; i++) {
        imu_raw_t now = level;

        now.roll_rad += turns[i][0];
        now.pitch_rad += turns[i][1];
        TEST_ASSERT_FALSE(imu_find_axis(&parameters, PARAMETER_IROLL, &level, &now));
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &parameters, sizeof before);
}

void test_a_unit_is_known_within_the_largest_bias_and_a_side_below_half_of_it(void)
{
    static const struct {
        float x_counts, y_counts, z_counts;
        bool found;
    } rows[] = {{0, 0, 295.1F, true},   {0, 0, 295.2F, false},    {0, 0, -216.9F, true},
                {0, 0, -216.8F, false}, {99, 79, 256.0F, true},   {99, 82, 256.0F, false},
                {127, 0, 256.0F, true}, {0, -129, 256.0F, false}, {0, 0, 0.0005F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        level.x_counts = rows[i].x_counts;
        level.y_counts = rows[i].y_counts;
        level.z_counts = rows[i].z_counts;
        TEST_ASSERT_EQUAL(rows[i].found, imu_find_level(&parameters, &level));
    }
}

/* How far it was turned; from a level where the angles may have passed the half turn. */
static bool turned(float level_rad, float roll_rad, float pitch_rad)
{
    imu_raw_t raw = level;
    level.roll_rad = level.pitch_rad = level_rad;
    raw.roll_rad = level_rad + roll_rad;
    raw.pitch_rad = level_rad + pitch_rad;
    while (raw.roll_rad > 3.14159265F) {
        raw.roll_rad -= 6.2831853F;
    }
    while (raw.roll_rad < -3.14159265F) {
        raw.roll_rad += 6.2831853F;
    }
    return imu_find_axis(&parameters, PARAMETER_IROLL, &level, &raw);
}

void test_a_turn_is_8_and_a_half_to_60_degrees_about_one_axis(void)
{
    static const float levels_rad[] = {0.0F, 3.1F, -3.1F};
    for (int i = 0; i < 3; i++) {
        for (float side = -1.0F; side < 2.0F; side += 2.0F) {
            TEST_ASSERT_TRUE(turned(levels_rad[i], 0.150F * side, 0.0F));
            TEST_ASSERT_EQUAL_UINT16(side > 0.0F ? AXIS_ROLL : AXIS_MINUS_ROLL, choice(PARAMETER_IROLL));
            TEST_ASSERT_FALSE(turned(levels_rad[i], 0.147F * side, 0.0F));
            TEST_ASSERT_TRUE(turned(levels_rad[i], 1.046F * side, 0.0F));
            TEST_ASSERT_FALSE(turned(levels_rad[i], 1.049F * side, 0.0F));
            TEST_ASSERT_TRUE(turned(levels_rad[i], 0.3F * side, 0.123F));
            TEST_ASSERT_FALSE(turned(levels_rad[i], 0.3F * side, -0.126F));
        }
    }
    TEST_ASSERT_TRUE(turned(0.0F, 0.1F, -0.3F));
    TEST_ASSERT_EQUAL_UINT16(AXIS_MINUS_PITCH, choice(PARAMETER_IROLL));
    TEST_ASSERT_TRUE(turned(0.0F, -0.1F, 0.3F));
    TEST_ASSERT_EQUAL_UINT16(AXIS_PITCH, choice(PARAMETER_IROLL));
}
