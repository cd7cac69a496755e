/* One sensor lies, and the vehicle neither flies away nor falls: rows of conditions with the harm that they
 * may do. Pinned: conditions that once did harm, flown by the same seeds each time: LIES_SEEDS of them,
 * without it the first. How often such conditions do harm, over seeds and sizes drawn anew, is asked by
 * test_rates.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "child.h"
#include "unity.h"

#define FLAT "plant.platform=0", "LAYOUT=FRONT" /* its only beam */
#define FIRST_SEED 301UL

static unsigned long seeds;

void setUp(void)
{
    const char *count = getenv("LIES_SEEDS");

    seeds = count != NULL ? strtoul(count, NULL, 10) : 1UL;
}

void tearDown(void) {}

/* Bounds: highest above the reference, hardest touch, hover rms; 0: not looked at. */
typedef struct {
    const char *const assignments[10];
    double highest_mm, touch_mps, rms_mm;
} lie_t;

static void at_most(double bound, double found, const char *what, const lie_t *lie, unsigned long seed)
{
    char message[200];

    snprintf(message, sizeof message, "%s %.4g, at most %.4g: %s %s seed %lu", what, found, bound,
             lie->assignments[1], lie->assignments[2] != NULL ? lie->assignments[2] : "", seed);
    TEST_ASSERT_TRUE_MESSAGE(bound <= 0.0 || isnan(found) || found <= bound, message);
}

static void fly_once(const char *scenario, unsigned long seed, const lie_t *lie, bool lands)
{
    static flight_result_t result;

    child_fly(scenario, seed, lie->assignments, &result);
    TEST_ASSERT_NULL(result.halt);
    at_most(lie->highest_mm, result.metrics.value[METRIC_HIGHEST_MM], "highest", lie, seed);
    at_most(lie->touch_mps, result.metrics.value[METRIC_TOUCH_SPEED_MPS], "touch", lie, seed);
    at_most(lie->rms_mm, result.metrics.value[METRIC_HOVER_RMS_MM], "hover rms", lie, seed);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, result.metrics.value[METRIC_CUTS]);
    TEST_ASSERT_FALSE(lands && isnan(result.metrics.value[METRIC_TOUCH_SPEED_MPS]));
}

static void fly(const char *scenario, const lie_t *lie, bool lands)
{
    for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + seeds; seed++) {
        fly_once(scenario, seed, lie, lands);
    }
}

static const lie_t sights[] = {
    {{FLAT, "plant.rays_lost=0.65", "plant.rays_lost_start=6"}, 800.0, 0.8, 0.0},
    {{FLAT, "plant.rays_lost=0.6"}, 800.0, 0.8, 0.0},
    {{FLAT, "plant.scan_frozen_start=5"}, 800.0, 0.8, 0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=7", "plant.block_mm=400"}, 1500.0, 1.0, 0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.block_mm=250"}, 1500.0, 1.0, 0.0},
    /* heights about the least that counts, -50 mm, and about the ground */
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=10", "plant.block_mm=150"}, 800.0, 1.0, 0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=10", "plant.block_mm=170"}, 800.0, 1.0, 0.0},
};

/* The blocked beam shows about the reference, so the law is content and drifts. */
static const lie_t content[] = {
    {{FLAT, "plant.sight_blocked=0.71", "plant.sight_blocked_start=1.4", "plant.block_mm=805"},
     800.0,
     1.0,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=1.4", "plant.block_mm=795",
      "plant.hover_thrust=7.8"},
     800.0,
     1.0,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=6", "plant.block_mm=739"}, 1500.0, 1.0, 0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=6", "plant.block_mm=750"}, 1500.0, 1.0, 0.0},
};

void test_a_blocked_beam_that_shows_the_reference_does_not_fly_the_vehicle_away(void)
{
    for (size_t i = 0; i < sizeof content / sizeof content[0]; i++) {
        fly("est-60cm-ramp", &content[i], false);
    }
}

/* Only the thrust tells the truth. */
static const lie_t alone[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=1.4", "plant.block_mm=372",
      "plant.acc_sign=-1"},
     2000.0,
     1.2,
     0.0},
};

void test_a_blocked_beam_with_an_accelerometer_upside_down_is_noticed_at_the_lift_off(void)
{
    for (size_t i = 0; i < sizeof alone / sizeof alone[0]; i++) {
        fly("est-60cm-ramp", &alone[i], false);
    }
}

void test_a_sight_that_lies_does_not_fly_the_vehicle_away(void)
{
    for (size_t i = 0; i < sizeof sights / sizeof sights[0]; i++) {
        fly("est-60cm-ramp", &sights[i], false);
    }
}

/* It stands, and its height says otherwise: nothing takes off by the order that is given then. */
static const lie_t high[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.block_mm=372"}, 0.0, 0.0, 0.0},
    {{"plant.platform=0", "plant.sight_blocked=1", "plant.block_mm=640"}, 0.0, 0.0, 0.0},
};

void test_beams_blocked_since_power_on_that_show_no_ground_lift_nothing(void)
{
    for (size_t i = 0; i < sizeof high / sizeof high[0]; i++) {
        static flight_result_t result;

        child_fly("est-60cm-ramp", FIRST_SEED, high[i].assignments, &result);
        TEST_ASSERT_NULL(result.halt);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, result.metrics.value[METRIC_ALOFT_S]);
    }
}

/* Light vehicles of weak damping: GRAV carries them up before any height tells. */
static const lie_t light[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=1.4", "plant.block_mm=640",
      "plant.hover_thrust=6", "plant.damping=1.7"},
     500.0,
     1.0,
     0.0},
};

void test_a_light_vehicle_whose_beam_is_blocked_in_the_take_off_does_not_fly_away(void)
{
    for (size_t i = 0; i < sizeof light / sizeof light[0]; i++) {
        fly("est-60cm-ramp", &light[i], false);
    }
}

/* A Razor as it comes: no accelerations, the sway of the tilt tells that the vehicle flies. */
static const lie_t stock[] = {
    {{FLAT, "plant.imu_stock=1", "plant.sight_blocked=1", "plant.sight_blocked_start=10",
      "plant.block_mm=160"},
     1000.0,
     1.0,
     0.0},
    {{FLAT, "plant.imu_stock=1", "plant.sight_blocked=1", "plant.sight_blocked_start=5",
      "plant.block_mm=190"},
     1000.0,
     1.0,
     0.0},
};

void test_a_blocked_beam_near_the_ground_is_doubted_without_accelerations_too(void)
{
    for (size_t i = 0; i < sizeof stock / sizeof stock[0]; i++) {
        fly("est-60cm-ramp", &stock[i], false);
    }
}

#define ONE_OF_THREE(beam, mm, start) \
    { \
        {"plant.platform=0", "plant.struck_beam=" beam, "plant.sight_blocked=1", "plant.block_mm=" mm, \
         "plant.sight_blocked_start=" start}, \
            120.0, 0.5, 25.0 \
    }

static const lie_t seen_by_others[] = {
    ONE_OF_THREE("1", "60", "0"),   ONE_OF_THREE("2", "400", "2.42"), ONE_OF_THREE("3", "190", "5"),
    ONE_OF_THREE("1", "2500", "7"), ONE_OF_THREE("2", "640", "0"),    ONE_OF_THREE("3", "1200", "10"),
};

void test_one_blocked_beam_of_three_changes_nothing(void)
{
    for (size_t i = 0; i < sizeof seen_by_others / sizeof seen_by_others[0]; i++) {
        fly("est-60cm-ramp", &seen_by_others[i], true);
    }
}

static const lie_t floors[] = {
    {{FLAT, "plant.bars_mm=60", "plant.bars_period=0.4"}, 300.0, 0.5, 40.0},
    {{FLAT, "plant.bars_mm=60", "plant.bars_period=0.4", "plant.airframe=1"}, 300.0, 0.5, 40.0},
};

void test_bars_on_the_floor_are_flown_over(void)
{
    for (size_t i = 0; i < sizeof floors / sizeof floors[0]; i++) {
        fly("est-60cm-ramp", &floors[i], true);
    }
}

static const lie_t imus[] = {
    {{FLAT, "plant.acc_bias=-2.5"}, 300.0, 0.6, 60.0},
    {{FLAT, "plant.acc_bias=2.5"}, 300.0, 0.6, 60.0},
    {{FLAT, "plant.acc_scale=0.00390625"}, 300.0, 0.6, 60.0},
    {{FLAT, "plant.acc_sign=-1"}, 300.0, 0.6, 60.0},
    {{FLAT, "plant.acc_jump=4", "plant.acc_jump_start=9"}, 400.0, 0.8, 100.0},
    {{FLAT, "plant.acc_jump=-4", "plant.acc_jump_start=22"}, 400.0, 0.8, 0.0},
    {{FLAT, "plant.attitude_burst_deg=80", "plant.attitude_burst_length=0.15"}, 100.0, 0.4, 20.0},
};

void test_an_imu_that_lies_is_flown_with_and_landed(void)
{
    for (size_t i = 0; i < sizeof imus / sizeof imus[0]; i++) {
        fly("est-60cm-ramp", &imus[i], true);
    }
}

/* Each of them cut the thrust in the air, or found the ground there. */
static const lie_t refuted[] = {
    {{"plant.platform=0", "plant.attitude_burst_deg=90", "plant.attitude_burst_turned=-101",
      "plant.attitude_burst_start=10", "plant.attitude_burst_length=0.32"},
     100.0,
     0.5,
     25.0},
    {{"plant.platform=0", "plant.attitude_burst_deg=-120", "plant.attitude_burst_start=14",
      "plant.attitude_burst_length=1"},
     150.0,
     0.5,
     30.0},
    {{"plant.platform=0", "plant.attitude_burst_degps=17", "plant.attitude_burst_turned=50",
      "plant.attitude_burst_start=10", "plant.attitude_burst_length=12"},
     600.0,
     0.5,
     0.0},
    {{"plant.platform=0", "plant.attitude_burst_degps=13.9", "plant.attitude_burst_turned=149",
      "plant.attitude_burst_start=7.7", "plant.attitude_burst_length=12"},
     300.0,
     0.5,
     0.0},
    {{"plant.platform=0", "plant.imu_frozen_start=5", "plant.imu_frozen=60"}, 150.0, 0.5, 60.0},
};

void test_an_attitude_that_the_mirrors_refute_or_that_hangs_is_none(void)
{
    for (size_t i = 0; i < sizeof refuted / sizeof refuted[0]; i++) {
        fly("est-60cm-ramp", &refuted[i], true);
    }
}

static const lie_t gaps[] = {
    {{FLAT, "plant.imu_mute_start=8", "plant.imu_mute=2", "plant.outage_start=10.2", "plant.outage=4"},
     1000.0,
     1.0,
     0.0},
    {{FLAT, "plant.imu_mute_start=6", "plant.imu_mute=0.6", "plant.outage_start=6.5", "plant.outage=6"},
     1000.0,
     1.0,
     0.0},
    {{FLAT, "plant.airframe=1", "plant.imu_mute_start=7.4", "plant.imu_mute=3.5", "plant.outage_start=11.2",
      "plant.outage=3.4"},
     600.0,
     1.0,
     0.0},
    {{FLAT, "plant.airframe=1", "plant.imu_mute_start=6.7", "plant.imu_mute=2.2", "plant.outage_start=9.3",
      "plant.outage=2.6"},
     600.0,
     1.0,
     0.0},
};

void test_a_gap_of_the_imu_and_one_of_the_scanner_end_on_the_ground(void)
{
    for (size_t i = 0; i < sizeof gaps / sizeof gaps[0]; i++) {
        fly("est-60cm-ramp", &gaps[i], true);
    }
}

typedef struct {
    unsigned long seed;
    const lie_t *lie;
} order_t;

static void fly_by(flight_options_t *options, const order_t *order, flight_result_t *result)
{
    options->seed = order->seed;
    for (int i = 0; order->lie->assignments[i] != NULL; i++) {
        if (flight_override(options, order->lie->assignments[i]) != NULL) {
            _exit(4);
        }
    }
    if (flight_prepare(scenario_find("est-60cm-ramp"), options) != NULL) {
        _exit(5);
    }
    flight_run(scenario_find("est-60cm-ramp"), options, result);
}

/* Until the motors are off, at most 60 s after the order to land. */
static void fly_to_the_end(void *argument, void *result)
{
    static flight_options_t options;

    options = (flight_options_t){.patience_s = 60.0};
    fly_by(&options, argument, result);
}

static const lie_t edges[] = {
    {{FLAT, "plant.edge_m=-0.8", "plant.edge_start=19.5"}, 100.0, 0.8, 0.0},
    {{FLAT, "plant.edge_m=-0.3", "plant.edge_start=20.8"}, 100.0, 0.6, 0.0},
};

/* The vehicle stands, and the beam sees a floor far below it. Edges long before the landing:
 * docs/reliability.md. */
void test_motors_stop_within_12_s_on_the_ground_though_the_beam_looks_beyond_an_edge(void)
{
    static flight_result_t result;

    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + seeds; seed++) {
            order_t order = {seed, &edges[i]};
            const double *value = result.metrics.value;

            child_run(fly_to_the_end, &order, &result, sizeof result);
            TEST_ASSERT_NULL(result.halt);
            TEST_ASSERT_FALSE(isnan(value[METRIC_STOPPED_S]));
            at_most(12.0, value[METRIC_STOPPED_S] - fmax(value[METRIC_DOWN_S], 0.0), "motors stop after",
                    &edges[i], seed);
            at_most(edges[i].highest_mm, value[METRIC_HIGHEST_MM], "highest", &edges[i], seed);
            at_most(edges[i].touch_mps, value[METRIC_TOUCH_SPEED_MPS], "touch", &edges[i], seed);
            TEST_ASSERT_EQUAL_DOUBLE(0.0, value[METRIC_OFF_ALOFT]);
        }
    }
}

/* SEL is NONE: nothing tells who has the throttle. */
static const lie_t pilots[] = {
    {{FLAT, "plant.pilot_start=7", "plant.pilot=8", "plant.pilot_height=1.0"}, 700.0, 0.5, 0.0},
    {{FLAT, "plant.pilot_start=7", "plant.pilot=8", "plant.pilot_height=0.4"}, 300.0, 0.5, 0.0},
};

/* The tilt moved as in flight in its last frame; that is no reason to keep the motors on. */
void test_an_imu_that_falls_silent_in_the_landing_does_not_keep_the_motors_running(void)
{
    static const char *const mute[] = {"plant.imu_mute_start=20", "plant.imu_mute_start=21.5",
                                       "plant.imu_mute_start=22.5"};

    for (size_t i = 0; i < sizeof mute / sizeof mute[0]; i++) {
        const char *assignments[] = {FLAT, mute[i], "plant.imu_mute=1000", NULL};
        const child_flights_t flights = child_fly_seeds("est-60cm-ramp", 2, assignments);

        TEST_ASSERT_TRUE(flights.worst[METRIC_STOPPED_S] > 2.0 && flights.worst[METRIC_STOPPED_S] < 9.0);
        TEST_ASSERT_TRUE(flights.worst[METRIC_TOUCH_SPEED_MPS] > 0.05 &&
                         flights.worst[METRIC_TOUCH_SPEED_MPS] < 0.5);
    }
}

/* The law hardly wants to climb, and did so for long: to 8.8 m with 740 mm. */
static const lie_t nearly[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=7", "plant.block_mm=720"}, 1400.0, 0.6, 0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=7", "plant.block_mm=740"}, 1400.0, 0.6, 0.0},
};

void test_a_beam_blocked_just_below_the_reference_does_not_fly_it_away(void)
{
    for (size_t i = 0; i < sizeof nearly / sizeof nearly[0]; i++) {
        fly("est-60cm-ramp", &nearly[i], true);
    }
}

/* A hand or a branch lifts it to 0.1 m above the reference, holds it there for 9 s, and lets it go. It looked
 * like a vehicle that stands by blocked mirrors, in 5 of 100 flights. */
void test_what_something_holds_in_the_air_keeps_its_sight_and_flies_on_when_it_is_let_go(void)
{
    static const char *const held[] = {"plant.platform=0",
                                       "plant.hang=0.7",
                                       "plant.hang_length=9",
                                       "plant.rope_pull=1000",
                                       "plant.turbulence=0.05",
                                       "plant.attitude_rms=0.01",
                                       NULL};
    const child_flights_t flights = child_fly_seeds("est-60cm-ramp", 8, held);

    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_SIGHT_DOUBTS]);
    TEST_ASSERT_TRUE(flights.worst[METRIC_THRUST_DOUBTS] > 0.5); /* right */
    TEST_ASSERT_EQUAL_DOUBLE(0.0, flights.worst[METRIC_LANDED_UNORDERED]);
    TEST_ASSERT_TRUE(flights.worst[METRIC_TOUCH_SPEED_MPS] > 0.05 &&
                     flights.worst[METRIC_TOUCH_SPEED_MPS] < 0.6);
}

/* The other way round: all mirrors are blocked a little beyond the reference, so it sinks onto the ground.
 * That something holds it in the air must not explain that. It stayed FLYING, in 16 of 16 flights of a trial
 * program. */
static const lie_t sunk = {
    {"plant.platform=0", "plant.sight_blocked=1", "plant.sight_blocked_start=9", "plant.block_mm=850"},
    0.0,
    0.0,
    0.0};

/* Ordered to land at 40 s. */
static void fly_for_40_s(void *argument, void *result)
{
    static flight_options_t options;

    options = (flight_options_t){.duration_s = 40.0};
    fly_by(&options, argument, result);
}

/* One that stands there FLYING would wait for the order. */
void test_what_has_sunk_onto_the_ground_by_blocked_mirrors_is_not_held_in_the_air(void)
{
    static flight_result_t result;

    for (unsigned long seed = 1001UL; seed <= 1008UL; seed++) {
        order_t order = {seed, &sunk};

        child_run(fly_for_40_s, &order, &result, sizeof result);
        TEST_ASSERT_NULL(result.halt);
        TEST_ASSERT_EQUAL_DOUBLE(1.0, result.metrics.value[METRIC_LANDED_UNORDERED]);
        TEST_ASSERT_DOUBLE_WITHIN(6.0, 6.5, result.metrics.value[METRIC_STOPPED_S]);
    }
}

/* The beam sees a table that is 30 mm higher than the landing gear. For a moment the heights are below the
 * ground, and right: it climbs over, or takes the beam for blocked and lands. */
void test_a_table_just_above_the_landing_gear_ends_in_a_climb_or_a_soft_landing(void)
{
    static const char *const table[] = {FLAT, "plant.edge_m=0.63", "plant.edge_start=8", NULL};
    const child_flights_t flights = child_fly_seeds("est-60cm-ramp", 4, table);

    TEST_ASSERT_TRUE(flights.worst[METRIC_HIGHEST_MM] > 150.0 && flights.worst[METRIC_HIGHEST_MM] < 800.0);
    TEST_ASSERT_TRUE(flights.worst[METRIC_TOUCH_SPEED_MPS] > 0.05 &&
                     flights.worst[METRIC_TOUCH_SPEED_MPS] < 0.6);
}

/* The beam is blocked while the vehicle climbs: to 3.5 m, because heights that moved a moment ago were
 * believed for a second, and the hover thrust was learned from them meanwhile. */
static const lie_t climbing[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=2.42", "plant.block_mm=370"},
     1500.0,
     1.0,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=2.6", "plant.block_mm=540"},
     1500.0,
     1.0,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=1.96", "plant.block_mm=798"},
     1500.0,
     1.0,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=3.4", "plant.block_mm=525"},
     1000.0,
     1.0,
     0.0},
};

void test_a_beam_blocked_during_the_climb_of_a_take_off_does_not_fly_it_away(void)
{
    for (size_t i = 0; i < sizeof climbing / sizeof climbing[0]; i++) {
        fly("est-60cm-ramp", &climbing[i], true);
    }
}

/* All three are blocked at what they show then, 0.1 m above the ground. The belief did not hear the
 * accelerometer until half a second after the lift-off: 8 of these 30 flew above 0.8 m over the reference,
 * and one to 1.3 m. */
void test_beams_blocked_just_off_the_ground_are_found_by_what_the_take_off_felt(void)
{
    static const lie_t lie = {
        {"plant.platform=0", "plant.sight_blocked=1", "plant.sight_blocked_start=2.2", "plant.block_mm=300"},
        1000.0,
        0.8,
        0.0};
    int flown_up = 0;

    for (unsigned long seed = 41UL; seed < 71UL; seed++) {
        static flight_result_t result;

        child_fly("est-60cm-ramp", seed, lie.assignments, &result);
        TEST_ASSERT_NULL(result.halt);
        at_most(lie.highest_mm, result.metrics.value[METRIC_HIGHEST_MM], "highest", &lie, seed);
        at_most(lie.touch_mps, result.metrics.value[METRIC_TOUCH_SPEED_MPS], "touch", &lie, seed);
        flown_up += result.metrics.value[METRIC_HIGHEST_MM] > 800.0;
    }
    TEST_ASSERT_INT_WITHIN(2, 2, flown_up);
}

/* Of a drawn vehicle of the second airframe; the heights were doubted there, and it fell from 0.9 m: in 78 of
 * 120 flights, seeds 301 to 420. Now 2 of them touch faster than 0.6 m/s. */
static const lie_t jump = {{FLAT, "plant.airframe=1", "plant.acc_jump=1.6", "plant.acc_jump_start=4.2",
                            "plant.damping=2", "plant.attitude_rms=0.0455", "plant.acc_noise=0.72",
                            "SETR=0.9"},
                           200.0,
                           0.8,
                           0.0};

void test_a_jump_of_the_accelerometer_does_not_bring_the_heights_into_doubt(void)
{
    for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + 8; seed++) {
        fly_once("est-60cm-ramp", seed, &jump, true);
    }
}

/* All three beams show 0.2 m more at once, as over an edge, and the vehicle sinks. Without a slow descent
 * while all mirrors may lie, 6 of these 12 touch the ground faster, at 1.33 m/s at most. */
static const lie_t farther[] = {
    {{"plant.platform=0", "plant.sight_blocked=1", "plant.sight_blocked_start=10.74", "plant.block_mm=1000"},
     200.0,
     0.8,
     0.0},
    {{"plant.platform=0", "plant.sight_blocked=1", "plant.sight_blocked_start=10.77", "plant.block_mm=1000",
      "plant.airframe=1", "plant.damping=2"},
     200.0,
     1.2,
     0.0},
};

void test_three_beams_that_are_blocked_farther_than_the_ground_do_not_let_it_fall_hard(void)
{
    for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + 6; seed++) {
        fly_once("est-60cm-ramp", seed, &farther[0], false);
        fly_once("est-60cm-ramp", seed, &farther[1], false);
    }
}

/* The only beam. Five of these 12 fell at 0.9 m/s: the law knew no speed but that of heights that stood
 * still.
 */
static const lie_t only_one_farther[] = {
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=6", "plant.block_mm=1250",
      "plant.airframe=1"},
     200.0,
     0.8,
     0.0},
    {{FLAT, "plant.sight_blocked=1", "plant.sight_blocked_start=6", "plant.block_mm=1500",
      "plant.airframe=1"},
     200.0,
     0.8,
     0.0},
};

void test_a_descent_that_the_only_beam_does_not_show_is_braked(void)
{
    for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + 6; seed++) {
        fly_once("est-60cm-ramp", seed, &only_one_farther[0], false);
        fly_once("est-60cm-ramp", seed, &only_one_farther[1], false);
    }
}

/* The ground really falls, and the accelerometer tells a fall that is none. A brake by it that heights which
 * climb did not end lifted three of these for 12 s and more, up to 1.5 m above the reference. */
static const lie_t falls_by_accelerometer = {
    {"plant.platform=0.852", "LAYOUT=FRONT", "plant.acc_jump=-1.915", "plant.acc_jump_start=10.268"},
    0.0,
    0.0,
    0.0};

void test_ground_that_falls_is_followed_by_an_accelerometer_that_lies(void)
{
    static flight_result_t result;

    for (unsigned long seed = FIRST_SEED; seed < FIRST_SEED + 6; seed++) {
        order_t order = {seed, &falls_by_accelerometer};

        child_run(fly_for_40_s, &order, &result, sizeof result);
        TEST_ASSERT_NULL(result.halt);
        TEST_ASSERT_DOUBLE_WITHIN(200.0, 1000.0, result.metrics.value[METRIC_HIGHEST_MM]);
        TEST_ASSERT_DOUBLE_WITHIN(5.0, 5.0, result.metrics.value[METRIC_OFF_S]);
    }
}

static const lie_t loads[] = {
    {{FLAT, "plant.hover_jump=1.2", "plant.hover_jump_start=6"}, 150.0, 0.6, 40.0},
    {{FLAT, "plant.hover_jump=-1.2", "plant.hover_jump_start=6"}, 150.0, 0.6, 40.0},
    {{FLAT, "plant.hover_jump=1.2", "plant.hover_jump_start=6", "plant.airframe=1"}, 150.0, 0.6, 40.0},
    {{FLAT, "plant.hover_jump=-1.2", "plant.hover_jump_start=6", "plant.airframe=1"}, 150.0, 0.6, 40.0},
};

void test_a_load_that_comes_or_goes_in_flight_is_carried(void)
{
    for (size_t i = 0; i < sizeof loads / sizeof loads[0]; i++) {
        fly("est-60cm-ramp", &loads[i], true);
    }
}

void test_a_pilot_whom_no_pin_tells_of_gives_back_a_vehicle_that_flies(void)
{
    for (size_t i = 0; i < sizeof pilots / sizeof pilots[0]; i++) {
        fly("est-60cm-ramp", &pilots[i], true);
    }
}

/* The sight's rows again, by the seed's law. */
void test_the_seeds_pid_is_not_flown_away_either(void)
{
    for (size_t i = 0; i < sizeof sights / sizeof sights[0]; i++) {
        lie_t lie = {{sights[i].assignments[0], sights[i].assignments[1], sights[i].assignments[2],
                      sights[i].assignments[3], NULL},
                     2500.0,
                     1.2,
                     0.0};
        fly("pid-60cm-ramp", &lie, false);
    }
}
