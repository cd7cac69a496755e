#include "sim/devices/terrain.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

void test_the_flat_floor_is_flat_for_ever(void)
{
    for (double t = -20.0; t < 40.0; t += 0.01) {
        TEST_ASSERT_EQUAL_DOUBLE(0.0, terrain_height_m(&terrain_flat, t));
    }
    const terrain_t unused = {
        .ramp = false, .ramp_start_s = 1.0, .ramp_end_s = 2.0, .height_m = 0.5, .edge_s = 3.0};
    TEST_ASSERT_EQUAL_DOUBLE(0.0, terrain_height_m(&unused, 2.5));
}

/* Points of the ramp 0 -> 0.25 m from 7.3 to 8.0 s, edge at 11.0 s. */
TEST_CASE(-1e10, 0.0)
TEST_CASE(-1.0, 0.0)
TEST_CASE(0.0, 0.0)
TEST_CASE(7.3, 0.0)
TEST_CASE(7.475, 0.0625)
TEST_CASE(7.65, 0.125)
TEST_CASE(7.93, 0.225)
TEST_CASE(8.0, 0.25)
TEST_CASE(9.5, 0.25)
TEST_CASE(10.9999, 0.25)
TEST_CASE(11.0, 0.0)
TEST_CASE(60.0, 0.0)
void test_the_platform_has_the_seeds_profile(double t_s, double height_m)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, height_m, terrain_height_m(&terrain_platform, t_s));
}

void test_the_ramp_has_no_step_and_the_edge_is_one(void)
{
    const double grid_s = 0.0005;
    double before_m = 0.0;
    unsigned steps = 0;
    for (unsigned k = 0; k < 40000; k++) {
        const double height_m = terrain_height_m(&terrain_platform, (double)k * grid_s);
        const double rise_m = height_m - before_m;
        before_m = height_m;
        if (rise_m < 0.0) {
            TEST_ASSERT_EQUAL_UINT(22000, k);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.25, rise_m);
            steps++;
        } else {
            TEST_ASSERT_TRUE(rise_m <= 0.25 / 0.7 * grid_s + 1e-9);
        }
    }
    TEST_ASSERT_EQUAL_UINT(1, steps);
}

void test_another_profile_is_followed(void)
{
    const terrain_t kerb = {
        .ramp = true, .ramp_start_s = 2.0, .ramp_end_s = 2.0, .height_m = 0.1, .edge_s = 3.0};
    TEST_ASSERT_EQUAL_DOUBLE(0.0, terrain_height_m(&kerb, 2.0));
    TEST_ASSERT_EQUAL_DOUBLE(0.1, terrain_height_m(&kerb, 2.0001));
    TEST_ASSERT_EQUAL_DOUBLE(0.1, terrain_height_m(&kerb, 2.9999));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, terrain_height_m(&kerb, 3.0));
}
