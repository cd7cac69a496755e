/* The battery empties, sags, is noisy, and its wire lies: what is empty lands softly after a warning, and
 * nothing else lands at all. */
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "unity.h"

#define SETS_MAX 8
#define STAYED_DOWN_MM (-590.0)

void setUp(void) {}
void tearDown(void) {}

static flight_result_t result;

static double figure(metric_t metric)
{
    return result.metrics.value[metric];
}

static void fly_until(double land_s, const char *scenario, unsigned long seed, const char *const *assignments)
{
    child_fly_until(scenario, seed, assignments, land_s, &result);
    TEST_ASSERT_NULL(result.halt);
    TEST_ASSERT_TRUE(result.started);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_CUTS));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_OFF_ALOFT));
}

static void fly(const char *scenario, unsigned long seed, const char *const *assignments)
{
    fly_until(0.0, scenario, seed, assignments);
}

static void expect_met(const char *scenario)
{
    const expectation_t *broken = NULL;

    if (!scenario_met(scenario_find(scenario), &result.metrics, &broken)) {
        TEST_FAIL_MESSAGE(metric_names[broken->metric]);
    }
}

void test_an_empty_battery_lands_softly_with_both_kinds_of_throttle(void)
{
    for (int climbs = 0; climbs < 2; climbs++) {
        char throttle[40];
        const char *assignments[] = {throttle, NULL};

        (void)snprintf(throttle, sizeof throttle, "plant.attitude_throttle=%d", climbs);
        for (unsigned long seed = 1; seed <= 2; seed++) {
            fly("battery", seed, assignments);
            expect_met("battery");
        }
    }
}

/* From full to empty in 90 s, seven times as fast as 5 Ah: with an autopilot that does not compensate, by a
 * thrust with the square of the voltage, it hovers by 10 N at the end in place of 7.4. */
void test_what_learns_the_hover_thrust_keeps_the_height_over_a_whole_battery(void)
{
    static const struct {
        const char *law, *airframe, *throttle;
        double rms_mm, most_mm;
    } rows[] = {{"LAW=EST", "plant.airframe=0", "plant.attitude_throttle=0", 25.0, 100.0},
                {"LAW=EST", "plant.airframe=1", "plant.attitude_throttle=0", 25.0, 100.0},
                {"LAW=EST", "plant.airframe=0", "plant.attitude_throttle=1", 25.0, 100.0},
                {"LAW=EST", "plant.airframe=1", "plant.attitude_throttle=1", 25.0, 100.0}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const char *falls[] = {rows[i].law,
                               rows[i].airframe,
                               rows[i].throttle,
                               "BAT=NONE",
                               "plant.battery_charge=1",
                               "plant.battery_capacity=0.85",
                               "plant.volts_power=2",
                               "plant.sag=0",
                               NULL};

        fly("battery", 2 + i, falls);
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0.0, figure(METRIC_LANDED_UNORDERED), rows[i].law);
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0.0, figure(METRIC_THRUST_DOUBTS), rows[i].law);
        TEST_ASSERT_TRUE_MESSAGE(figure(METRIC_HOVER_RMS_MM) < rows[i].rms_mm, rows[i].law);
        TEST_ASSERT_TRUE_MESSAGE(figure(METRIC_MAX_ERROR_MM) < rows[i].most_mm, rows[i].law);
        TEST_ASSERT_TRUE_MESSAGE(figure(METRIC_TOUCH_SPEED_MPS) < 0.5, rows[i].law);
    }
}

/* PD and PID stay within USAT of GRAV, as the seed's do: a battery that falls farther takes them down. With
 * room for it PID holds the height. */
void test_the_seeds_laws_need_room_for_the_battery(void)
{
    static const char *const falls[] = {"LAW=PID",
                                        "BAT=NONE",
                                        "USAT=4",
                                        "plant.battery_charge=1",
                                        "plant.battery_capacity=0.85",
                                        "plant.volts_power=2",
                                        "plant.sag=0",
                                        NULL};
    const char *cramped[sizeof falls / sizeof falls[0]];

    memcpy(cramped, falls, sizeof falls);
    cramped[2] = "USAT=1";
    fly("battery", 1, cramped);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, figure(METRIC_LANDED_UNORDERED));
    TEST_ASSERT_TRUE(figure(METRIC_TOUCH_SPEED_MPS) < 0.5);
    fly("battery", 1, falls);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_LANDED_UNORDERED));
}

/* PID flies every 108 ms: the times are the same. */
void test_it_lands_with_the_slow_laws_too(void)
{
    static const char *const pid[] = {"LAW=PID", NULL};

    fly("battery", 1, pid);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, figure(METRIC_LANDED_UNORDERED));
    TEST_ASSERT_TRUE(figure(METRIC_TOUCH_SPEED_MPS) < 0.6);
}

void test_without_the_parameter_it_lands_nothing(void)
{
    static const char *const off[] = {"BAT=NONE", NULL};

    fly("battery", 1, off);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_LANDED_UNORDERED));
    TEST_ASSERT_TRUE(figure(METRIC_HOVER_RMS_MM) < 100.0);
}

#define LIED_TO_S 45.0 /* in the air: a warning and a landing take 25 */

void test_no_lie_of_the_wire_lands_a_vehicle_or_keeps_it_down(void)
{
    static const char *const lies[][SETS_MAX] = {
        {"plant.battery=0"},
        {"plant.battery_lost_start=4", "plant.battery_lost_length=1e9"},
        {"plant.battery_stuck_v=40", "plant.battery_stuck_start=4", "plant.battery_stuck_length=1e9"},
        {"plant.battery_stuck_v=9", "plant.battery_stuck_start=-1000", "plant.battery_stuck_length=1e9"},
        {"plant.battery_stuck_v=13.5", "plant.battery_stuck_start=-1000", "plant.battery_stuck_length=1e9",
         "plant.battery_noise=0"},
        {"plant.battery_frozen_start=2", "plant.battery_frozen_length=1e9"},
        {"plant.battery_noise=3"},
        {"plant.battery_noise=15"},
        {"plant.battery_loose=0.1"},
        {"plant.battery_loose=0.4"},
        {"plant.battery_loose=0.8"},
        {"CELLS=3S"},
        {"CELLS=6S"},
        {"VDIV=5"},
        {"VDIV=20"},
    };

    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        const char *assignments[SETS_MAX + 6] = {"plant.battery_charge=1"};
        size_t count = 1;

        for (size_t j = 0; j < SETS_MAX && lies[i][j] != NULL; j++) {
            assignments[count++] = lies[i][j];
        }
        fly_until(LIED_TO_S, "battery", 1 + i % 3, assignments);
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0.0, figure(METRIC_LANDED_UNORDERED), lies[i][0]);
        TEST_ASSERT_TRUE_MESSAGE(figure(METRIC_MAX_ERROR_MM) < 200.0, lies[i][0]);
    }
}

/* Gusts of 2 m/s2 for 3 s, a worn battery that sags twice as deep: no warning becomes a landing. */
void test_gusts_and_a_worn_battery_do_not_land_it(void)
{
    static const char *const worn[] = {"plant.battery_charge=0.8",
                                       "plant.battery_ohm=0.03",
                                       "plant.gust=-2",
                                       "plant.gust_start=8",
                                       "plant.gust_length=3",
                                       "plant.turbulence=0.6",
                                       NULL};

    for (unsigned long seed = 1; seed <= 3; seed++) {
        fly("battery", seed, worn);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, figure(METRIC_LANDED_UNORDERED));
    }
}

/* An empty battery that has recovered at rest: it is measured in flight first, and then lands. */
void test_a_take_off_with_an_empty_battery_ends_by_itself(void)
{
    static const char *const empty[] = {"plant.battery_charge=0.06", NULL};

    fly("battery", 1, empty);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, figure(METRIC_LANDED_UNORDERED));
    TEST_ASSERT_TRUE(figure(METRIC_ALOFT_S) < 40.0);
    TEST_ASSERT_TRUE(figure(METRIC_TOUCH_SPEED_MPS) < 0.5);
}
