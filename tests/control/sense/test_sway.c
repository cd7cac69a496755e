#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_sway_is_the_mean_square_of_both_angles_about_their_mean(void)
{
    feel(0.0F);
    senses.sway.mean_rad[0] = senses.sway.mean_rad[1] = 0.0F;
    sways_rad2(0.0F);
    frame.median.roll_rad = 0.06F;
    frame.median.pitch_rad = -0.03F;
    feel(0.0F);
    VERY_NEAR(0.06F / 60.0F, senses.sway.mean_rad[0]);
    VERY_NEAR(-0.03F / 60.0F, senses.sway.mean_rad[1]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-8F, (0.0036F + 0.0009F) / 60.0F, senses.sway.sway_rad2);
    for (int i = 0; i < 600; i++) { /* ten time constants: a lasting tilt is no sway */
        feel(0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.06F, senses.sway.mean_rad[0]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.03F, senses.sway.mean_rad[1]);
    TEST_ASSERT_FLOAT_WITHIN(2.0e-6F, 0.0F, senses.sway.sway_rad2);
}

void test_a_degree_of_either_angle_is_a_rock_and_the_next_is_measured_from_there(void)
{
    for (int axis = 0; axis < 2; axis++) {
        setUp();
        feel(0.0F);
        rock(0.0F, 0.0F);
        rock((axis == 0) ? 0.0165F : 0.0F, (axis == 1) ? -0.0165F : 0.0F);
        NEAR(0.075F, senses.sway.unrocked_s);
        rock((axis == 0) ? -0.0175F : 0.0F, (axis == 1) ? 0.0175F : 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.sway.unrocked_s);
        rock((axis == 0) ? -0.03F : 0.0F, (axis == 1) ? 0.03F : 0.0F);
        NEAR(0.025F, senses.sway.unrocked_s);
        rock(0.0F, 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.sway.unrocked_s);
    }
    for (int i = 0; i < 33; i++) {
        rock(0.0F, 0.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.8F, senses.sway.unrocked_s);
    TEST_ASSERT_FALSE(sway_rocks(&senses.sway));
}

void test_rocking_is_looked_at_near_the_ground_alone(void)
{
    feel(0.0F);
    at_m(0.10F);
    unrocked_for_s(0.5F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.sway.unrocked_s);
    at_m(0.099F);
    feel(0.0F);
    NEAR(0.025F, senses.sway.unrocked_s);
}

void test_what_sways_and_rocks_is_told_by_limits(void)
{
    sways_rad2(4.0e-4F);
    TEST_ASSERT_FALSE(sway_as_in_the_air(&senses.sway));
    sways_rad2(4.1e-4F);
    TEST_ASSERT_TRUE(sway_as_in_the_air(&senses.sway));
    sways_rad2(2.5e-4F);
    TEST_ASSERT_FALSE(sway_rocks(&senses.sway));
    sways_rad2(2.6e-4F);
    TEST_ASSERT_TRUE(sway_rocks(&senses.sway));
    unrocked_for_s(0.79F);
    TEST_ASSERT_TRUE(sway_rocks(&senses.sway));
    unrocked_for_s(0.8F);
    TEST_ASSERT_FALSE(sway_rocks(&senses.sway));
    calm_for_s(1.0F);
    TEST_ASSERT_FALSE(stand_is_possible(&senses.stand));
    calm_for_s(1.01F);
    TEST_ASSERT_TRUE(stand_is_possible(&senses.stand));
    stood_for_s(0.6F);
    TEST_ASSERT_FALSE(stand_is_sure(&senses.stand));
    stood_for_s(0.61F);
    TEST_ASSERT_TRUE(stand_is_sure(&senses.stand));
}

void test_a_frame_without_accelerations_tells_the_sway_too(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        feel(0.0F);
        const uint32_t sequence = senses.accelerometer.sequence;
        frame.has_acceleration = false;
        frame.arrival_us = 1000000U;
        feel(5.0F);
        TEST_ASSERT_EQUAL_UINT32(sequence + 1U, senses.accelerometer.sequence);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.sway.sway_rad2); /* the first after long */
        frame.median.roll_rad = 0.06F;
        frame.arrival_us += 275000U + more_us;
        feel(5.0F);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-7F, (more_us == 0U) ? 0.2F * 0.0036F : 0.0F, senses.sway.sway_rad2);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.speed_mps);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.up_mps2);
    }
}
