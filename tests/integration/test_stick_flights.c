/* One person flies by the stick, and the stick lies: out of range, noisy, frozen, missing, at an end since
 * power-on. Nothing moves that he did not order, and he can always take the throttle. */
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "unity.h"

#define STAYED_DOWN_MM (-590.0)
#define SETS_MAX 5

void setUp(void) {}
void tearDown(void) {}

static flight_result_t result;

static double figure(metric_t metric)
{
    return result.metrics.value[metric];
}

static void fly(unsigned long seed, const char *const *assignments)
{
    child_fly("stick", seed, assignments, &result);
    TEST_ASSERT_NULL(result.halt);
    TEST_ASSERT_TRUE(result.started);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_CUTS));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_TAKEOVERS));
}

void test_one_person_flies_with_both_stop_types_and_both_kinds_of_throttle(void)
{
    for (int combination = 0; combination < 4; combination++) {
        char stop_type[32], throttle[40];
        const char *assignments[] = {stop_type, throttle, NULL};

        (void)snprintf(stop_type, sizeof stop_type, "plant.stop_type=%d", combination & 1);
        (void)snprintf(throttle, sizeof throttle, "plant.attitude_throttle=%d", combination >> 1);
        for (unsigned long seed = 1; seed <= 2; seed++) {
            const expectation_t *broken = NULL;

            fly(seed, assignments);
            if (!scenario_met(scenario_find("stick"), &result.metrics, &broken)) {
                TEST_FAIL_MESSAGE(metric_names[broken->metric]);
            }
        }
    }
}

void test_he_stays_where_he_stops_pushing(void)
{
    static const char *const heights[] = {"plant.pilot_height=0.35", "plant.pilot_height=0.9",
                                          "plant.pilot_height=1.2"};
    static const double metres[] = {0.35, 0.9, 1.2};

    for (size_t i = 0; i < sizeof heights / sizeof heights[0]; i++) {
        const char *assignments[] = {heights[i], NULL};

        fly(1, assignments);
        TEST_ASSERT_DOUBLE_WITHIN(150.0, (metres[i] - 0.6) * 1000.0, figure(METRIC_HIGHEST_MM));
    }
}

/* Nothing tells a stick that lies so from one that the pilot holds so: it takes off for neither. */
void test_a_stick_that_was_never_in_the_middle_orders_nothing(void)
{
    static const char *const lies[][SETS_MAX] = {
        {"plant.stick_stuck_us=1100", "plant.stick_stuck_start=-1000", "plant.stick_stuck_length=1e9"},
        {"plant.stick_stuck_us=2000", "plant.stick_stuck_start=-1000", "plant.stick_stuck_length=1e9"},
        {"plant.stick_stuck_us=2900", "plant.stick_stuck_start=-1000", "plant.stick_stuck_length=1e9"},
        {"plant.stick=0"},
        {"plant.stick_noise=200"},
        {"plant.stick_spikes=0.5"},
        {"plant.stick_offset=100"},
        {"plant.stick_frozen_start=-20", "plant.stick_frozen_length=1e9"},
        {"SEL=NONE"},
    };

    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        fly(1, lies[i]);
        TEST_ASSERT_TRUE_MESSAGE(figure(METRIC_HIGHEST_MM) < STAYED_DOWN_MM, lies[i][0]);
    }
}

void test_a_wire_that_breaks_in_flight_holds_the_height(void)
{
    static const char *const lost[] = {"plant.stick_lost_start=8", "plant.stick_lost_length=1e9", NULL};
    static const char *const beyond[] = {"plant.stick_stuck_us=2900", "plant.stick_stuck_start=8",
                                         "plant.stick_stuck_length=1e9", NULL};

    fly(1, lost);
    TEST_ASSERT_TRUE(figure(METRIC_MAX_ERROR_MM) < 120.0);
    TEST_ASSERT_TRUE(figure(METRIC_FLAGGED_S) > 11.0);
    fly(1, beyond);
    TEST_ASSERT_TRUE(figure(METRIC_MAX_ERROR_MM) < 120.0);
    TEST_ASSERT_TRUE(figure(METRIC_FLAGGED_S) > 11.0);
}

void test_a_wire_that_comes_back_lets_him_go_on(void)
{
    static const char *const lost[] = {"plant.stick_lost_start=8", "plant.stick_lost_length=4", NULL};
    const expectation_t *broken;

    fly(1, lost);
    TEST_ASSERT_TRUE(scenario_met(scenario_find("stick"), &result.metrics, &broken));
}

void test_a_stick_that_hangs_up_in_flight_raises_it_by_a_metre_and_no_more(void)
{
    static const char *const hangs[] = {"plant.stick_stuck_us=1000", "plant.stick_stuck_start=8",
                                        "plant.stick_stuck_length=1e9", NULL};
    static const char *const frozen[] = {"plant.stick_frozen_start=3.5", "plant.stick_frozen_length=1e9",
                                         NULL};

    fly(1, hangs);
    TEST_ASSERT_DOUBLE_WITHIN(150.0, 1050.0, figure(METRIC_HIGHEST_MM));
    fly(1, frozen);
    TEST_ASSERT_DOUBLE_WITHIN(150.0, 700.0, figure(METRIC_HIGHEST_MM)); /* from 0.3 m on */
}

/* As a receiver does that has lost its transmitter, when its failsafe shuts the throttle. */
void test_a_stick_that_hangs_down_in_flight_lands_it_softly(void)
{
    static const char *const hangs[] = {"plant.stick_stuck_us=2000", "plant.stick_stuck_start=8",
                                        "plant.stick_stuck_length=1e9", NULL};

    fly(1, hangs);
    TEST_ASSERT_TRUE(figure(METRIC_TOUCH_SPEED_MPS) < 0.5);
    TEST_ASSERT_TRUE(figure(METRIC_ALOFT_S) < 16.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_OFF_ALOFT));
}

void test_some_noise_and_a_trimmed_middle_do_not_matter(void)
{
    static const char *const noisy[] = {"plant.stick_noise=15", "plant.stick_offset=20", NULL};
    static const char *const trimmed[] = {"plant.stick_offset=100", "SMID=1600", NULL};
    static const char *const spikes[] = {"plant.stick_spikes=0.02", NULL};
    const expectation_t *broken;

    for (unsigned long seed = 1; seed <= 3; seed++) {
        fly(seed, noisy);
        TEST_ASSERT_TRUE(scenario_met(scenario_find("stick"), &result.metrics, &broken));
        fly(seed, trimmed);
        TEST_ASSERT_TRUE(scenario_met(scenario_find("stick"), &result.metrics, &broken));
        fly(seed, spikes);
        TEST_ASSERT_TRUE(figure(METRIC_GROUND_CONTACTS) < 0.5 && figure(METRIC_HOVER_RMS_MM) < 100.0);
    }
}
