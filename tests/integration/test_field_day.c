/* The field day, from the sticks that start the motors to the pilot's own landing: both Stop Types, with and
 * without the selector's pin, an autopilot whose throttle is thrust and one whose throttle is a climb rate.
 * Pinned to one seed; test_rates.py asks how often it goes well.
 */
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "unity.h"

#define SEEDS 1UL

void setUp(void) {}
void tearDown(void) {}

static flight_result_t result;
static char set[3][40];

/* Combination 0..7, with further settings; true: it looked as it must. */
static bool fly(int combination, unsigned long seed, const char *more)
{
    const char *assignments[] = {set[0], set[1], set[2], more, NULL};
    const expectation_t *broken;

    (void)snprintf(set[0], sizeof set[0], "plant.stop_type=%d", combination & 1);
    (void)snprintf(set[1], sizeof set[1], "SEL=%s", (combination & 2) != 0 ? "PIN" : "NONE");
    (void)snprintf(set[2], sizeof set[2], "plant.attitude_throttle=%d", combination >> 2);
    child_fly("field-day", seed, assignments, &result);
    TEST_ASSERT_NULL(result.halt);
    TEST_ASSERT_TRUE(result.started);
    return scenario_met(scenario_find("field-day"), &result.metrics, &broken);
}

static void explain(unsigned long seed)
{
    char text[400];
    size_t used = (size_t)snprintf(text, sizeof text, "%s %s %s seed %lu:", set[0], set[1], set[2], seed);

    for (int i = 0; i < METRIC_COUNT && used < sizeof text; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, " %s %.3g", metric_names[i],
                                 result.metrics.value[i]);
    }
    TEST_FAIL_MESSAGE(text);
}

void test_all_eight_combinations_live_through_it(void)
{
    for (int combination = 0; combination < 8; combination++) {
        for (unsigned long seed = 1; seed <= SEEDS; seed++) {
            if (!fly(combination, seed, NULL)) {
                explain(seed);
            }
        }
    }
}

void test_with_an_idle_of_nothing_the_motors_stop_at_the_hand_over_in_every_one(void)
{
    for (int combination = 0; combination < 8; combination++) {
        TEST_ASSERT_FALSE(fly(combination, 1, "IDLE=0"));
        TEST_ASSERT_TRUE_MESSAGE(result.metrics.value[METRIC_HIGHEST_MM] < -599.0,
                                 "it never left the ground");
    }
}

/* Under 10 % is as good as nothing. */
void test_an_idle_of_nine_percent_is_not_enough_and_eleven_are(void)
{
    TEST_ASSERT_FALSE(fly(0, 1, "IDLE=9"));
    TEST_ASSERT_TRUE(fly(0, 1, "IDLE=11"));
    TEST_ASSERT_TRUE(fly(0, 1, "IDLE=20"));
}

/* A low battery moves the middle of the stick by up to 0.3 of its way in a minute, 0.0588 N/s. */
void test_a_middle_of_the_stick_that_goes_up_does_not_keep_the_second_flight_on_the_ground(void)
{
    for (int combination = 4; combination < 8; combination++) {
        if (!fly(combination, 1, "plant.neutral_drift=0.0588")) {
            explain(1);
        }
    }
}
