#include "sim/scenarios/seed_course.h"

#include <math.h>

#include "sim/devices/travel.h"
#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)
#define STEP_S 0.0005

static place_t place;
static course_t course;
static seed_course_t wanted;

void setUp(void)
{
    wanted = seed_course_ramp;
}

void tearDown(void) {}

/* Under a vehicle that is in the air from 1.5 s on. */
static double ground_m(double t_s, double *x_m)
{
    travel_t travel;
    double now_s = 0.0;

    travel_init(&travel, &course);
    for (; now_s < t_s - 0.5 * STEP_S; now_s += STEP_S) {
        travel_steer(&travel, now_s, STEP_S, 0.0);
        travel_step(&travel, STEP_S, 0.0, 0.0, 0.0, 9.8, now_s < 1.5);
    }
    *x_m = travel.x_m;
    return place_below(&place, travel.x_m, travel.y_m, 10.0, t_s).at.z;
}

/* The seed's profile: 0 to 0.25 m from 7.3 to 8.0 s, edge at 11.0 s. The course is stepped by half a
 * millisecond: 0.2 mm of way, 0.2 mm of the ramp's height. */
TEST_CASE(0.0, 0.0)
TEST_CASE(7.29, 0.0)
TEST_CASE(7.475, 0.0625)
TEST_CASE(7.65, 0.125)
TEST_CASE(7.93, 0.225)
TEST_CASE(8.02, 0.25)
TEST_CASE(9.5, 0.25)
TEST_CASE(10.995, 0.25)
TEST_CASE(11.005, 0.0)
TEST_CASE(20.0, 0.0)
void test_the_vehicle_is_where_the_seeds_was_when_the_seeds_was(double t_s, double height_m)
{
    double x_m;

    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(5e-4, height_m, ground_m(t_s, &x_m));
}

/* The same with an uneven floor around it, over which it flies from its take-off on. */
TEST_CASE(7.65, 0.125)
TEST_CASE(10.99, 0.25)
TEST_CASE(11.01, 0.0)
void test_the_platform_comes_when_it_must_over_an_uneven_floor_too(double t_s, double height_m)
{
    double x_m;

    wanted.rough_rms_m = 1e-6;
    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(1.5e-3, height_m, ground_m(t_s, &x_m));
}

void test_without_a_ramp_over_an_even_floor_it_stays_where_it_is(void)
{
    double x_m;

    seed_course_lay(&seed_course_flat, 1, &place, &course);
    NEAR(1e-12, 0.0, ground_m(20.0, &x_m));
    NEAR(1e-12, 0.0, x_m);
    TEST_ASSERT_EQUAL_INT(0, place.count);
}

void test_a_platform_of_no_height_is_flown_over_all_the_same(void)
{
    double x_m;

    wanted.platform_m = 0.0;
    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(1e-12, 0.0, ground_m(9.5, &x_m));
    TEST_ASSERT_TRUE(x_m > 1.0);
}

void test_a_platform_below_the_floor_is_a_pit(void)
{
    double x_m;

    wanted.platform_m = -0.4;
    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(1e-3, 0.0, ground_m(1.0, &x_m));
    NEAR(1e-3, -0.2, ground_m(7.65, &x_m));
    NEAR(1e-3, -0.4, ground_m(9.5, &x_m));
    NEAR(1e-3, 0.0, ground_m(11.1, &x_m));
}

/* What was told in seconds is so at 0.4 m/s. */
void test_roughness_and_bars_are_told_in_seconds_of_the_flight(void)
{
    wanted = seed_course_flat;
    wanted.rough_rms_m = 0.03;
    wanted.rough_s = 0.5;
    wanted.bars_m = 0.05;
    wanted.bars_s = 0.6;
    wanted.bars_share = 0.25;
    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(1e-12, 0.03, place.rough.rms_m);
    NEAR(1e-12, 0.2, place.rough.correlation_m);
    NEAR(1e-12, 0.24, place.bars.period_m);
    NEAR(1e-12, 0.05, place.bars.height_m);
    NEAR(1e-12, 0.25, place.bars.share);
}

/* A second later, within the 53 mm that taking up speed costs. */
void test_a_ramp_may_be_met_from_any_place_at_any_time(void)
{
    place_init(&place);
    seed_course_meet(&wanted, 5.0, 30.0, 1.0, &place, &course);
    NEAR(1e-12, 30.0, course.legs[0].start_s);
    NEAR(1e-9, 0.0, place_below(&place, 5.0 + 0.34, 0.0, 10.0, 0.0).at.z);
    NEAR(1e-9, 0.125, place_below(&place, 5.0 + 0.4 - 0.0533333333 + 0.14, 0.0, 10.0, 0.0).at.z);
}

/* The seed's times hold at any speed: the ramp is longer, not later. */
TEST_CASE(0.3)
TEST_CASE(0.5)
TEST_CASE(1.0)
void test_at_another_speed_it_is_where_the_seeds_was_when_the_seeds_was(double speed_mps)
{
    double x_m;

    wanted.speed_mps = speed_mps;
    seed_course_lay(&wanted, 1, &place, &course);
    NEAR(1e-3, 0.125, ground_m(7.65, &x_m));
    NEAR(1e-3, 0.25, ground_m(10.99, &x_m));
    NEAR(1e-3, 0.0, ground_m(11.01, &x_m));
    NEAR(0.01, speed_mps * (11.01 - 5.3) - 0.5 * speed_mps * speed_mps / COURSE_MPS2, x_m);
}

void test_tail_first_it_has_turned_round_before_the_ramp(void)
{
    course_point_t point;

    wanted.nose_rad = M_PI;
    seed_course_lay(&wanted, 1, &place, &course);
    course_begin(&point);
    for (double t_s = 0.0; t_s < wanted.ramp_start_s - 0.5; t_s += STEP_S) {
        course_step(&course, &point, t_s, STEP_S);
    }
    NEAR(1e-6, 0.0, remainder(point.heading_rad - M_PI, 2.0 * M_PI));
    TEST_ASSERT_TRUE(point.x_m > 0.3);
}
