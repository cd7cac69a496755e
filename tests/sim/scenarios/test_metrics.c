#include "sim/scenarios/metrics.h"

#include <math.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)
#define LAND_S 20.0
#define HERTZ 100

static metrics_record_t record;
static metrics_t found;
static long ticks;
static metrics_sample_t now; /* what the next samples are */
static double carried_m;     /* how far the ground under a foot is above that under the centre */

void setUp(void)
{
    metrics_begin(&record, 0.6, false, LAND_S);
    ticks = 0;
    carried_m = 0.0;
    now = (metrics_sample_t){.thrust_n = 7.4, .ours = true, .may_cut = true};
    now.on_ground = true;
}

void tearDown(void) {}

static double time_s(void)
{
    return (double)ticks / HERTZ;
}

/* Samples up to t_s, while the height goes evenly to height_m. The firmware knows it. */
static void go(double t_s, double height_m)
{
    const long steps = lround(t_s * HERTZ) - ticks;
    const double from_m = now.height_m;

    now.speed_mps = (height_m - from_m) * HERTZ / (double)steps;
    for (long i = 1; i <= steps; i++) {
        now.t_s = time_s();
        now.height_m = now.seen_m = from_m + (height_m - from_m) * (double)i / (double)steps;
        now.estimate_m = now.estimate_m + now.seen_m -
                         (i == 1 ? from_m : from_m + (height_m - from_m) * (double)(i - 1) / (double)steps);
        now.clearance_m = fmax(now.height_m - carried_m, 0.0);
        now.on_ground = now.clearance_m <= 0.0;
        metrics_add(&record, &now);
        ticks++;
    }
    now.speed_mps = 0.0;
}

static double value(metric_t metric)
{
    metrics_compute(&record, &found);
    return found.value[metric];
}

static void hover(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(LAND_S, 0.6);
}

void test_a_good_flight_is_one(void)
{
    hover();
    go(23.0, 0.0);
    now.thrust_n = 0.0;
    go(26.0, 0.0);
    NEAR(0.011, 0.8, value(METRIC_RISE_TIME_S));
    NEAR(0.1, 0.0, value(METRIC_HOVER_RMS_MM));
    NEAR(1e-6, 0.0, value(METRIC_HIGHEST_MM));
    NEAR(1e-6, 0.2, value(METRIC_TOUCH_SPEED_MPS));
    NEAR(0.025, 3.0, value(METRIC_DOWN_S));
    NEAR(0.025, 3.0, value(METRIC_STOPPED_S));
    NEAR(1e-9, 0.0, value(METRIC_OFF_ALOFT));
    NEAR(1e-9, 0.0, value(METRIC_CUTS));
    NEAR(1e-9, 0.0, value(METRIC_DECEIVED_S));
    NEAR(1e-9, 0.0, value(METRIC_FLAGGED_S));
    TEST_ASSERT_FALSE(found.failed);
    TEST_ASSERT_TRUE(metrics_over(&record));
}

void test_motors_off_in_the_air_count_after_a_fifth_of_a_second_once_each_time(void)
{
    hover();
    now.thrust_n = 0.0;
    go(20.15, 0.6);
    now.thrust_n = 7.0;
    go(21.0, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_OFF_ALOFT));
    now.thrust_n = 1.1; /* under a tenth of the throttle they stop as well */
    go(22.0, 0.6);
    NEAR(1e-9, 1.0, value(METRIC_OFF_ALOFT));
    now.thrust_n = 7.0;
    go(23.0, 0.6);
    now.thrust_n = 0.0;
    go(24.0, 0.6);
    NEAR(1e-9, 2.0, value(METRIC_OFF_ALOFT));
}

void test_motors_may_stop_low_or_when_the_vehicle_is_tilted_or_the_pilots(void)
{
    hover();
    now.may_cut = false;
    now.thrust_n = 0.0;
    go(22.0, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_OFF_ALOFT));
    now.thrust_n = 7.0;
    now.may_cut = true;
    go(23.0, 0.29);
    now.thrust_n = 0.0;
    go(24.0, 0.29);
    NEAR(1e-9, 0.0, value(METRIC_OFF_ALOFT));
}

/* The ground falls at once, the vehicle does not move. */
static void lose_the_platform(double height_m)
{
    now.t_s = time_s();
    now.height_m = now.seen_m = height_m;
    now.on_ground = false;
    metrics_add(&record, &now);
    ticks++;
}

/* 0.4 s off after the edge, then within; a gust 2 s later counts for the recovery alone. */
void test_a_later_gust_is_not_the_edges(void)
{
    metrics_begin(&record, 0.6, true, LAND_S);
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(11.02, 0.6);
    go(11.03, 0.7);
    go(11.41, 0.7);
    go(11.42, 0.6);
    go(13.41, 0.6);
    go(13.42, 0.7);
    go(13.5, 0.6);
    go(LAND_S, 0.6);
    NEAR(0.03, 0.4, value(METRIC_SETTLED_S));
    NEAR(0.05, 2.44, value(METRIC_RECOVERY_S));
}

void test_the_altitude_counts_from_the_floor(void)
{
    now.altitude_m = 0.6;
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(8.0, 0.6);
    now.altitude_m = 0.7;
    go(9.0, 0.6);
    now.altitude_m = 0.6;
    go(LAND_S, 0.6);
    NEAR(1e-6, 100.0, value(METRIC_ALTITUDE_ERROR_MM));
    NEAR(0.1, 0.0, value(METRIC_MAX_ERROR_MM));
}

void test_a_pilots_flight_that_ends_on_the_ground_is_a_touch_whatever_the_law_commands(void)
{
    now.thrust_n = 0.0;
    go(11.0, 0.0);
    go(12.0, 0.8);
    go(12.5, 0.0);
    NEAR(1e-6, 1.6, value(METRIC_TOUCH_SPEED_MPS));
}

void test_a_platform_that_goes_away_under_a_standing_vehicle_is_no_touch(void)
{
    for (int idle = 0; idle < 2; idle++) {
        setUp();
        now.thrust_n = idle ? 0.0 : 5.0;
        go(11.0, 0.0);
        lose_the_platform(0.25);
        go(11.2, 0.0);
        if (idle) {
            TEST_ASSERT_TRUE(isnan(value(METRIC_TOUCH_SPEED_MPS)));
            now.thrust_n = 7.0;
            go(13.0, 0.6);
            now.thrust_n = 0.0; /* and a flight that falls is one */
            go(14.0, 0.0);
            NEAR(1e-6, 0.6, value(METRIC_TOUCH_SPEED_MPS));
        } else {
            NEAR(0.1, 1.3, value(METRIC_TOUCH_SPEED_MPS));
        }
    }
}

void test_who_never_comes_down_is_never_down(void)
{
    hover();
    go(80.0, 0.4);
    TEST_ASSERT_TRUE(isnan(value(METRIC_DOWN_S)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_STOPPED_S)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_TOUCH_SPEED_MPS)));
    TEST_ASSERT_FALSE(metrics_over(&record));
}

void test_on_the_ground_with_running_motors_is_down_but_not_stopped(void)
{
    hover();
    go(22.0, 0.0);
    go(30.0, 0.0);
    NEAR(0.025, 2.0, value(METRIC_DOWN_S));
    TEST_ASSERT_TRUE(isnan(value(METRIC_STOPPED_S)));
    TEST_ASSERT_FALSE(metrics_over(&record));
}

void test_a_descent_of_the_supervisor_starts_the_clock_before_the_command(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(10.0, 0.6);
    now.coming_down = true;
    go(14.0, 0.0);
    now.coming_down = false;
    now.thrust_n = 0.0;
    go(14.8, 0.0);
    TEST_ASSERT_FALSE(metrics_over(&record));
    go(15.2, 0.0);
    TEST_ASSERT_TRUE(metrics_over(&record));
    go(26.0, 0.0);
    NEAR(0.025, 4.0, value(METRIC_DOWN_S));
}

void test_a_descent_that_was_called_off_does_not_count(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(10.0, 0.6);
    now.coming_down = true;
    go(11.0, 0.4);
    now.coming_down = false;
    go(LAND_S, 0.6);
    go(24.0, 0.0);
    now.thrust_n = 0.0;
    go(26.0, 0.0);
    NEAR(0.025, 4.0, value(METRIC_DOWN_S));
}

void test_a_wrong_height_without_a_flag_deceives(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(5.0, 0.6);
    now.estimate_m += 0.29;
    go(8.0, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_DECEIVED_S));
    now.estimate_m -= 0.60;
    go(11.0, 0.6);
    NEAR(0.011, 2.99, value(METRIC_DECEIVED_S));
    now.estimate_m += 0.31;
    go(12.0, 0.6);
    now.estimate_m += 0.5;
    go(14.0, 0.6);
    NEAR(0.011, 2.99, value(METRIC_DECEIVED_S));
}

void test_a_flag_is_no_deceit_and_is_counted_until_the_command(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    now.flagged = true;
    now.estimate_m += 1.0;
    go(6.0, 0.6);
    now.flagged = false;
    now.estimate_m -= 1.0;
    go(LAND_S, 0.6);
    now.flagged = true;
    go(24.0, 0.0);
    NEAR(1e-9, 0.0, value(METRIC_DECEIVED_S));
    NEAR(0.011, 4.0, value(METRIC_FLAGGED_S));
}

void test_without_an_estimate_nothing_deceives(void)
{
    go(1.0, 0.0);
    now.estimate_m = NAN;
    go(2.0, 0.6);
    go(LAND_S, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_DECEIVED_S));
}

/* The beam beyond an edge: what it sees is what is flown at. */
void test_the_height_above_what_the_beam_sees_is_the_right_one(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    for (int i = 0; i < 500; i++) {
        now.t_s = time_s();
        now.seen_m = now.estimate_m = 1.6;
        metrics_add(&record, &now);
        ticks++;
    }
    NEAR(1e-9, 0.0, value(METRIC_DECEIVED_S));
}

void test_a_flight_fails_by_what_happens_first(void)
{
    go(1.0, 0.0);
    go(5.0, 0.3);
    go(8.0, 0.3);
    value(METRIC_RISE_TIME_S);
    TEST_ASSERT_EQUAL_STRING("never reached 90 % of the reference", found.failure);
    go(9.0, 1.59);
    value(METRIC_RISE_TIME_S);
    TEST_ASSERT_EQUAL_STRING("more than 0.55 m off after 5 s", found.failure);
    setUp();
    go(1.0, 0.0);
    go(4.0, 1.7);
    go(8.0, 1.7);
    value(METRIC_RISE_TIME_S);
    TEST_ASSERT_EQUAL_STRING("rose above the reference + 1 m", found.failure);
}

void test_a_flight_that_ends_by_itself_is_counted_and_one_that_is_ordered_or_the_pilots_is_not(void)
{
    hover();
    go(23.0, 0.0);
    go(26.0, 0.0);
    NEAR(1e-9, 0.0, value(METRIC_LANDED_UNORDERED));

    setUp();
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(10.0, 0.6);
    go(12.0, 0.0);
    go(12.9, 0.0);
    NEAR(1e-9, 0.0, value(METRIC_LANDED_UNORDERED)); /* a touch */
    go(18.0, 0.0);
    NEAR(1e-9, 1.0, value(METRIC_LANDED_UNORDERED));

    setUp();
    go(1.0, 0.0);
    go(2.0, 0.6);
    now.ours = false;
    go(10.0, 0.0);
    now.ours = true;
    go(18.0, 0.0);
    NEAR(1e-9, 0.0, value(METRIC_LANDED_UNORDERED));

    setUp();
    go(1.0, 0.0);
    go(2.0, 0.6);
    metrics_order(&record, 2.0, 0.0);
    go(4.0, 0.0);
    go(18.0, 0.0);
    NEAR(1e-9, 0.0, value(METRIC_LANDED_UNORDERED));
}

void test_each_source_that_is_doubted_counts_once_each_time_in_the_air(void)
{
    now.doubts = METRICS_IMU; /* since the ground: counts with the take-off */
    go(1.0, 0.0);
    go(2.0, 0.6);
    now.doubts = METRICS_IMU | METRICS_SIGHT;
    go(5.0, 0.6);
    now.doubts = 0;
    go(6.0, 0.6);
    now.doubts = METRICS_SIGHT;
    go(7.0, 0.6);
    now.doubts = 0;
    go(LAND_S, 0.6);
    now.doubts = METRICS_THRUST; /* while it lands */
    go(25.0, 0.0);
    NEAR(1e-9, 2.0, value(METRIC_SIGHT_DOUBTS));
    NEAR(1e-9, 1.0, value(METRIC_IMU_DOUBTS));
    NEAR(1e-9, 0.0, value(METRIC_THRUST_DOUBTS));
    NEAR(0.06, 18.95, value(METRIC_ALOFT_S));
}

void test_commands_without_effect_in_a_pilots_hands_are_no_doubt_of_the_truth(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    now.ours = false;
    now.doubts = METRICS_THRUST;
    go(5.0, 0.6);
    now.ours = true;
    go(6.0, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_THRUST_DOUBTS));
    now.doubts = 0;
    go(7.0, 0.6);
    now.doubts = METRICS_THRUST;
    go(8.0, 0.6);
    NEAR(1e-9, 1.0, value(METRIC_THRUST_DOUBTS));
}

void test_who_leaves_its_height_is_off_and_who_is_still_on_its_way_is_not(void)
{
    hover();
    NEAR(0.011, 0.0, value(METRIC_OFF_S));

    setUp();
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(10.0, 0.6);
    go(10.5, 1.0); /* 0.4 m above, then below: 0.35 s on each side of the way, and 3 s */
    go(13.5, 1.0);
    go(14.0, 0.2);
    go(16.0, 0.2);
    go(LAND_S, 0.6);
    NEAR(0.3, 3.1, value(METRIC_OFF_S));

    setUp(); /* an order is no fault, unless it is not obeyed */
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(5.0, 0.6);
    metrics_order(&record, 5.0, 2.0);
    go(9.0, 2.0);
    NEAR(0.011, 0.0, value(METRIC_OFF_S));
    NEAR(0.1, 0.0, value(METRIC_HIGHEST_MM));
    metrics_order(&record, 9.0, 1.0);
    go(18.0, 2.0);
    NEAR(0.02, 1.0, value(METRIC_OFF_S));
    NEAR(0.1, 0.0, value(METRIC_HIGHEST_MM)); /* above the highest one ordered */
}

void test_errors_are_of_the_reference_in_force_and_the_way_to_another_one_is_none(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(8.0, 0.6);
    metrics_order(&record, 8.0, 1.5); /* 0.9 m: as a fault it would be off course */
    go(10.0, 1.5);
    go(LAND_S, 1.52);
    TEST_ASSERT_TRUE(value(METRIC_HOVER_RMS_MM) > 5.0 && value(METRIC_HOVER_RMS_MM) < 20.0);
    TEST_ASSERT_TRUE(value(METRIC_HOVER_MEAN_ERROR_MM) > 0.0);
    NEAR(0.1, 20.0, value(METRIC_MAX_ERROR_MM));
    TEST_ASSERT_FALSE(found.failed);
    setUp(); /* and who does not follow is off */
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(7.0, 0.6);
    metrics_order(&record, 7.0, 1.5);
    go(LAND_S, 0.6);
    NEAR(0.1, 900.0, value(METRIC_MAX_ERROR_MM));
    TEST_ASSERT_TRUE(found.failed);
}

void test_the_same_reference_again_is_no_other_one_and_without_one_nothing_is_off(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(6.5, 0.6);
    metrics_order(&record, 6.5, 0.6);
    go(7.0, 0.7);
    NEAR(0.2, 100.0, value(METRIC_MAX_ERROR_MM));
    metrics_order(&record, 7.0, 0.0);
    go(9.0, 0.0);
    go(18.0, 0.0);
    NEAR(0.2, 100.0, value(METRIC_MAX_ERROR_MM));
    TEST_ASSERT_FALSE(found.failed);
}

void test_who_is_always_on_his_way_has_no_error_and_no_recovery(void)
{
    metrics_begin(&record, 0.6, true, LAND_S);
    go(1.0, 0.0);
    for (int i = 0; i < 5; i++) {
        metrics_order(&record, time_s() + 0.02, i % 2 == 0 ? 0.7 : 0.6);
        go(5.0 + 4.0 * i, 0.6);
    }
    TEST_ASSERT_TRUE(isnan(value(METRIC_HOVER_RMS_MM)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_MAX_ERROR_MM)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_RECOVERY_S)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_UNDERSHOOT_MM)));
}

static void fly_and_land(double land_s)
{
    metrics_begin(&record, 0.6, true, land_s);
    ticks = 0;
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(land_s, 0.6);
    go(land_s + 2.0, 0.0);
    go(20.0, 0.0);
}

void test_who_has_landed_before_the_edge_has_no_figure_of_it(void)
{
    static const metric_t of_edge[] = {METRIC_TERRAIN_RMS_MM, METRIC_RECOVERY_S, METRIC_SETTLED_S,
                                       METRIC_UNDERSHOOT_MM};

    for (size_t i = 0; i < sizeof of_edge / sizeof of_edge[0]; i++) {
        fly_and_land(6.0);
        TEST_ASSERT_TRUE(isnan(value(of_edge[i])));
        TEST_ASSERT_TRUE(found.untold[of_edge[i]]);
        fly_and_land(14.9); /* its way down lies in the window */
        TEST_ASSERT_TRUE(isnan(value(of_edge[i])));
        fly_and_land(15.0);
        NEAR(3.5, 0.0, value(of_edge[i])); /* the sample of the command itself counts */
        TEST_ASSERT_FALSE(found.untold[of_edge[i]]);
    }
}

void test_the_way_down_is_no_hover_and_a_part_of_the_first_one_is_none(void)
{
    fly_and_land(16.0);
    NEAR(0.5, 0.0, value(METRIC_HOVER_RMS_MM)); /* the sample of the command itself counts */
    fly_and_land(5.0);
    TEST_ASSERT_TRUE(isnan(value(METRIC_HOVER_RMS_MM)));
    TEST_ASSERT_TRUE(isnan(value(METRIC_ALTITUDE_ERROR_MM)));
    TEST_ASSERT_TRUE(found.untold[METRIC_HOVER_RMS_MM]);
}

void test_a_figure_that_needs_a_plan_is_none_of_those_that_follow_from_the_flight(void)
{
    TEST_ASSERT_TRUE(metrics_needs_plan(METRIC_RISE_TIME_S));
    TEST_ASSERT_TRUE(metrics_needs_plan(METRIC_GROUND_CONTACTS));
    TEST_ASSERT_FALSE(metrics_needs_plan(METRIC_LANDED_UNORDERED));
    TEST_ASSERT_FALSE(metrics_needs_plan(METRIC_HOVER_RMS_MM));
}

void test_on_the_way_to_a_lower_reference_the_supervisor_may_take_over(void)
{
    go(1.0, 0.0);
    go(2.0, 0.6);
    metrics_order(&record, 2.0, 2.0);
    go(6.0, 2.0);
    metrics_order(&record, 6.0, 0.6);
    now.taken_over = true;
    go(7.0, 0.6);
    now.taken_over = false;
    go(9.0, 0.6);
    NEAR(1e-9, 0.0, value(METRIC_TAKEOVERS));
    now.taken_over = true;
    go(10.0, 0.6);
    NEAR(1e-9, 1.0, value(METRIC_TAKEOVERS));
}

/* Rough ground, a slope, an edge: a foot touches, and the centre stays 80 mm above the ground. */
void test_who_stands_on_a_foot_is_down_and_has_touched(void)
{
    hover();
    carried_m = 0.08;
    go(23.0, 0.08); /* 0.52 m in 3 s */
    now.thrust_n = 0.0;
    go(26.0, 0.08);
    NEAR(0.025, 3.0, value(METRIC_DOWN_S));
    NEAR(0.002, 0.52 / 3.0, value(METRIC_TOUCH_SPEED_MPS));
    TEST_ASSERT_TRUE(metrics_over(&record));
}

void test_one_that_never_leaves_the_ground_has_left_its_height(void)
{
    go(LAND_S, 0.0);
    NEAR(0.02, LAND_S - METRICS_REFERENCE_S - 8.0, value(METRIC_OFF_S));
    NEAR(1e-9, 0.0, value(METRIC_LANDED_UNORDERED));
}

/* As many as a day has. */
void test_a_day_of_samples_is_no_matter(void)
{
    metrics_begin(&record, 0.6, false, 90000.0);
    go(1.0, 0.0);
    go(2.0, 0.6);
    go(86400.0, 0.6);
    TEST_ASSERT_EQUAL_size_t(8640000, record.count);
    NEAR(1e-3, 0.0, value(METRIC_HOVER_RMS_MM));
}

/* On feet with the centre over a gap 6 cm deep: neither cut in the air when its motors stop, nor doubted
 * there. */
void test_a_vehicle_that_stands_on_its_feet_over_a_gap_is_not_aloft(void)
{
    carried_m = 0.06;
    now.height_m = 0.06;
    now.may_cut = true;
    go(2.0, 0.06);
    now.doubts = 1U;
    now.flagged = true;
    go(4.0, 0.06);
    now.thrust_n = 0.0;
    go(5.0, 0.06);
    NEAR(1e-9, 0.0, value(METRIC_CUTS));
    NEAR(1e-9, 0.0, value(METRIC_FLAGGED_S));
    NEAR(1e-9, 0.0, value(METRIC_SIGHT_DOUBTS));
}
