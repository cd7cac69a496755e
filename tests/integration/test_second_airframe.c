/* The firmware's estimator assumes thrust in proportion to the throttle, one lag and one damping. Here it
 * flies rotors by momentum theory: thrust by a power of the throttle, quick up and slow down, inflow, drag by
 * the square. Means and worst of pinned seeds; rates over vehicles drawn anew: test_rates.py. */
#include "child.h"
#include "unity.h"

#define SEEDS 5

static child_flights_t flights;

void setUp(void) {}
void tearDown(void) {}

static void fly(const char *scenario, const char *exponent)
{
    const char *assignments[] = {"LAYOUT=FRONT", "plant.airframe=1", exponent,
                                 NULL}; /* bounds of one mirror */

    flights = child_fly_seeds(scenario, SEEDS, assignments);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_OFF_ALOFT]);
    TEST_ASSERT_TRUE(flights.worst[METRIC_TOUCH_SPEED_MPS] > 0.05 &&
                     flights.worst[METRIC_TOUCH_SPEED_MPS] < 0.6);
}

static void by_the_estimator(const char *exponent)
{
    fly("est-60cm-ramp", exponent);
    TEST_ASSERT_DOUBLE_WITHIN(3.5, 11.0, flights.mean[METRIC_HOVER_RMS_MM]);
    TEST_ASSERT_DOUBLE_WITHIN(12.0, 76.0, flights.mean[METRIC_TERRAIN_RMS_MM]);
    TEST_ASSERT_DOUBLE_WITHIN(0.35, 0.95,
                              flights.mean[METRIC_RECOVERY_S]); /* 0.74 on the airframe that it assumes */
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_GROUND_CONTACTS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_TAKEOVERS]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_FLAGGED_S]);
}

void test_the_estimator_flies_an_airframe_that_it_does_not_assume(void)
{
    by_the_estimator("plant.exponent=1.5");
    by_the_estimator("plant.exponent=1");
    by_the_estimator("plant.exponent=2");
}

/* Rotors that slow down slowly suit no law without a model: it oscillates more than on the simple airframe,
 * now and then down to the ground. */
void test_the_seeds_law_oscillates_on_it_and_does_not_fly_away(void)
{
    fly("pid-60cm-ramp", "plant.exponent=1.5");
    TEST_ASSERT_DOUBLE_WITHIN(60.0, 200.0, flights.mean[METRIC_HOVER_RMS_MM]);
    TEST_ASSERT_TRUE(flights.worst[METRIC_HIGHEST_MM] > 250.0 && flights.worst[METRIC_HIGHEST_MM] < 1000.0);
}
