/* What kinds of Razor law EST flies with. As it comes, it sends angles alone, every 20 ms: the law flies by
 * its thrust model and the heights, here also on an airframe that this model does not describe, and by an
 * autopilot that takes climb rates. Both lines every 20 ms is what docs/razor.md lets the owner build.
 * Means and worst of pinned seeds; rates over vehicles drawn anew: test_rates.py. */
#include "child.h"
#include "unity.h"

#define SEEDS 3

static child_flights_t flights;

void setUp(void) {}
void tearDown(void) {}

static void fly_with(const char *scenario, const char *razor, const char *figure)
{
    const char *assignments[] = {razor, figure, NULL};

    flights = child_fly_seeds(scenario, SEEDS, assignments);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_GROUND_CONTACTS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_TAKEOVERS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_OFF_ALOFT]);
    TEST_ASSERT_TRUE(flights.worst[METRIC_TOUCH_SPEED_MPS] > 0.05 &&
                     flights.worst[METRIC_TOUCH_SPEED_MPS] < 0.5);
}

static void fly(const char *scenario, const char *figure)
{
    fly_with(scenario, "plant.imu_stock=1", figure);
}

void test_a_stock_razor_flies_nearly_as_well_as_one_with_accelerations(void)
{
    fly("est-60cm-ramp", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(3.5, 12.6, flights.mean[METRIC_HOVER_RMS_MM]);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 58.0, flights.mean[METRIC_TERRAIN_RMS_MM]); /* seeds 401 to 420: 58.0 */
}

void test_a_stock_razor_flies_a_vehicle_that_the_thrust_model_does_not_describe(void)
{
    fly("est-60cm-ramp", "plant.airframe=1");
    TEST_ASSERT_DOUBLE_WITHIN(9.0, 20.0, flights.mean[METRIC_HOVER_RMS_MM]);
    fly("est-60cm-ramp", "plant.hover_thrust=5.8");
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 14.0, flights.mean[METRIC_HOVER_RMS_MM]);
    fly("est-60cm-ramp", "plant.hover_thrust=8.2");
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 14.0, flights.mean[METRIC_HOVER_RMS_MM]);
}

void test_a_stock_razor_flies_an_autopilot_that_takes_climb_rates(void)
{
    fly("climb-rate", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(9.0, 24.0, flights.mean[METRIC_HOVER_RMS_MM]);
}

void test_both_lines_every_20_ms_hold_as_well_as_the_seeds_25_ms(void)
{
    fly_with("est-60cm-ramp", "plant.imu_period=0.02", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(1.8, 9.8, flights.mean[METRIC_HOVER_RMS_MM]); /* 40 seeds: 9.8, at 25 ms 10.1 */
}

void test_slow_or_late_frames_cost_centimetres_and_no_contact(void)
{
    fly_with("est-60cm-ramp", "plant.imu_period=0.1", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 16.7, flights.mean[METRIC_HOVER_RMS_MM]);
    fly_with("est-60cm-ramp", "plant.imu_age=0.1", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 18.9, flights.mean[METRIC_HOVER_RMS_MM]);
}
