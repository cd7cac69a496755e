/* Whether a vehicle gets to its reference. */
#include "control/reach.h"

#include <math.h>

#include "unity.h"

#define STEP_US 20000U

static reach_t reach;

void setUp(void)
{
    reach_reset(&reach);
}

void tearDown(void) {}

/* Seconds until it is told, or -1. */
static float stuck_after_s(float (*off_mm)(float t_s), float until_s)
{
    for (uint32_t k = 0; (float)k * 0.02F < until_s; k++) {
        if (reach_step(&reach, off_mm((float)k * 0.02F), STEP_US)) {
            return (float)k * 0.02F;
        }
    }
    return -1.0F;
}

static float hangs_low(float t_s)
{
    return -356.0F + 30.0F * sinf(3.0F * t_s);
}

static float stands(float t_s)
{
    (void)t_s;
    return -600.0F;
}

static float too_high(float t_s)
{
    (void)t_s;
    return 101.0F;
}

static float climbs_at_the_slowest(float t_s)
{
    return -3000.0F + 125.0F * t_s;
}

static float swings(float t_s)
{
    return 300.0F * sinf(2.0F * t_s);
}

static float near(float t_s)
{
    (void)t_s;
    return -99.0F;
}

void test_a_vehicle_that_stays_off_on_one_side_is_told_after_three_seconds(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 3.0F, stuck_after_s(stands, 10.0F));
    reach_reset(&reach);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 3.0F, stuck_after_s(too_high, 10.0F));
    reach_reset(&reach);
    TEST_ASSERT_FLOAT_WITHIN(0.6F, 3.4F, stuck_after_s(hangs_low, 10.0F));
}

void test_one_that_comes_nearer_however_slowly_swings_or_is_near_is_not(void)
{
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, stuck_after_s(climbs_at_the_slowest, 23.0F));
    reach_reset(&reach);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, stuck_after_s(swings, 60.0F));
    reach_reset(&reach);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, stuck_after_s(near, 60.0F));
}

void test_it_is_told_until_it_comes_nearer_and_from_the_beginning_after_a_reset(void)
{
    (void)stuck_after_s(stands, 10.0F);
    TEST_ASSERT_TRUE(reach_step(&reach, -551.0F, STEP_US));
    TEST_ASSERT_FALSE(reach_step(&reach, -549.0F, STEP_US));
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 3.0F, stuck_after_s(stands, 10.0F));
    reach_reset(&reach);
    TEST_ASSERT_FALSE(reach_step(&reach, -600.0F, STEP_US));
}

void test_a_long_step_counts_as_three_seconds_and_hours_do_not_wrap(void)
{
    (void)reach_step(&reach, -600.0F, 0U);
    for (uint32_t k = 0; k < 5000U; k++) {
        TEST_ASSERT_TRUE(reach_step(&reach, -600.0F, UINT32_C(4000000000)));
    }
}

/* A reference 300 mm above, watched from there; then one step. */
static bool then(float off_mm, uint32_t step_us)
{
    setUp();
    TEST_ASSERT_FALSE(reach_step(&reach, -300.0F, 0U));
    reach.stuck_us = 2000000U;
    return reach_step(&reach, off_mm, step_us);
}

void test_three_seconds_without_fifty_millimetres_of_progress_are_told(void)
{
    TEST_ASSERT_TRUE(then(-250.0F, 1000000U));
    TEST_ASSERT_FALSE(then(-250.0F, 999999U));
    TEST_ASSERT_FALSE(then(-249.0F, 1000000U));
    TEST_ASSERT_EQUAL_UINT32(0U, reach.stuck_us);
    TEST_ASSERT_EQUAL_FLOAT(249.0F, reach.nearest_mm);
    TEST_ASSERT_TRUE(then(-400.0F, 1000000U));
    TEST_ASSERT_EQUAL_FLOAT(300.0F, reach.nearest_mm);
}

void test_a_side_of_the_reference_is_watched_for_itself_and_a_decimetre_is_there(void)
{
    TEST_ASSERT_FALSE(then(300.0F, 5000000U));
    TEST_ASSERT_TRUE(reach.above);
    TEST_ASSERT_FALSE(then(-100.0F, 5000000U));
    setUp();
    (void)reach_step(&reach, -120.0F, 0U);
    TEST_ASSERT_TRUE(reach_step(&reach, -101.0F, 5000000U));
    TEST_ASSERT_FALSE(reach_step(&reach, -100.0F, 5000000U));
    TEST_ASSERT_FALSE(reach.above);
    TEST_ASSERT_FALSE(reach_step(&reach, 0.0005F, 1U));
    TEST_ASSERT_TRUE(reach.above);
    TEST_ASSERT_FALSE(reach_step(&reach, 0.0F, 1U));
    TEST_ASSERT_FALSE(reach.above);
}

void test_one_step_counts_for_three_seconds_at_most_and_the_sum_for_a_minute(void)
{
    (void)then(-400.0F, 50000000U);
    TEST_ASSERT_EQUAL_UINT32(5000000U, reach.stuck_us);
    reach.stuck_us = 59999999U;
    TEST_ASSERT_TRUE(reach_step(&reach, -400.0F, 5000000U));
    TEST_ASSERT_EQUAL_UINT32(62999999U, reach.stuck_us);
    TEST_ASSERT_TRUE(reach_step(&reach, -400.0F, 5000000U));
    TEST_ASSERT_EQUAL_UINT32(62999999U, reach.stuck_us);
    reach.stuck_us = 60000000U;
    TEST_ASSERT_TRUE(reach_step(&reach, -400.0F, 1U));
    TEST_ASSERT_EQUAL_UINT32(60000000U, reach.stuck_us);
}
