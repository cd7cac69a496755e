/* A Razor as it comes sends angles alone, every 20 ms: law EST flies by its thrust model and the heights.
 * Here also on an airframe that this model does not describe, and by an autopilot that takes climb rates. */
#include <stdio.h>

#include "child.h"
#include "unity.h"

#define SEEDS 6

static double mean[METRIC_COUNT], worst[METRIC_COUNT];

void setUp(void) {}
void tearDown(void) {}

static void fly(const char *scenario, const char *figure)
{
    const char *assignments[] = {"plant.imu_stock=1", figure, NULL};

    for (int i = 0; i < METRIC_COUNT; i++) {
        mean[i] = worst[i] = 0.0;
    }
    for (unsigned long seed = 1; seed <= SEEDS; seed++) {
        flight_result_t result;

        child_fly(scenario, seed, assignments, &result);
        TEST_ASSERT_TRUE(result.started);
        TEST_ASSERT_NULL(result.halt);
        for (int i = 0; i < METRIC_COUNT; i++) {
            mean[i] += result.metrics.value[i] / SEEDS;
            worst[i] = result.metrics.value[i] > worst[i] ? result.metrics.value[i] : worst[i];
        }
    }
    printf("%s, %s: rms %.1f mm, overshoot %.0f mm, terrain %.1f mm, touch %.2f m/s at most\n", scenario,
           figure == NULL ? "as it is" : figure, mean[METRIC_HOVER_RMS_MM], mean[METRIC_OVERSHOOT_MM],
           mean[METRIC_TERRAIN_RMS_MM], worst[METRIC_TOUCH_SPEED_MPS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, worst[METRIC_GROUND_CONTACTS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, worst[METRIC_TAKEOVERS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, worst[METRIC_OFF_ALOFT]);
    TEST_ASSERT_TRUE(worst[METRIC_TOUCH_SPEED_MPS] > 0.05 && worst[METRIC_TOUCH_SPEED_MPS] < 0.5);
}

void test_a_stock_razor_flies_nearly_as_well_as_one_with_accelerations(void)
{
    fly("est-60cm-ramp", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(3.5, 12.6, mean[METRIC_HOVER_RMS_MM]);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 76.0, mean[METRIC_TERRAIN_RMS_MM]);
}

void test_a_stock_razor_flies_a_vehicle_that_the_thrust_model_does_not_describe(void)
{
    fly("est-60cm-ramp", "plant.airframe=1");
    TEST_ASSERT_DOUBLE_WITHIN(9.0, 20.0, mean[METRIC_HOVER_RMS_MM]);
    fly("est-60cm-ramp", "plant.hover_thrust=5.8");
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 14.0, mean[METRIC_HOVER_RMS_MM]);
    fly("est-60cm-ramp", "plant.hover_thrust=8.2");
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 14.0, mean[METRIC_HOVER_RMS_MM]);
}

void test_a_stock_razor_flies_an_autopilot_that_takes_climb_rates(void)
{
    fly("climb-rate", NULL);
    TEST_ASSERT_DOUBLE_WITHIN(9.0, 24.0, mean[METRIC_HOVER_RMS_MM]);
}
