#include "sim/devices/course.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define STEP_S 0.0005
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static course_t course;
static course_point_t point;
static double t_s, fastest_mps;

void setUp(void)
{
    memset(&course, 0, sizeof course);
    course_begin(&point);
    t_s = fastest_mps = 0.0;
}

void tearDown(void) {}

static void leg(double start_s, double x_m, double y_m, double speed_mps)
{
    course.legs[course.count++] = (course_leg_t){
        .start_s = start_s, .x_m = x_m, .y_m = y_m, .speed_mps = speed_mps};
}

static void until(double end_s)
{
    while (t_s < end_s) {
        const double before = hypot(point.vx_mps, point.vy_mps);

        t_s += STEP_S;
        course_step(&course, &point, t_s, STEP_S);
        fastest_mps = fmax(fastest_mps, hypot(point.vx_mps, point.vy_mps));
        TEST_ASSERT_TRUE(hypot(point.vx_mps, point.vy_mps) <= before + COURSE_MPS2 * STEP_S + 1e-12);
    }
}

void test_without_a_leg_it_stays_at_the_origin(void)
{
    until(5.0);
    NEAR(0.0, 0.0, point.x_m);
    NEAR(0.0, 0.0, point.vx_mps);
}

/* 0.4 m/s after 0.27 s and 53 mm; as much to stand again: 3 m last 7.77 s. */
void test_a_leg_is_flown_at_its_speed_and_ends_at_rest(void)
{
    leg(2.0, 3.0, 0.0, 0.4);
    until(2.0);
    NEAR(1e-3, 0.0, point.x_m);
    until(5.0);
    NEAR(0.003, 0.4 * 3.0 - 0.0533, point.x_m);
    NEAR(1e-9, 0.4, point.vx_mps);
    until(9.70);
    TEST_ASSERT_TRUE(point.x_m < 3.0);
    until(9.85);
    NEAR(1e-9, 3.0, point.x_m);
    NEAR(0.0, 0.0, point.vx_mps);
    NEAR(1e-9, 0.4, fastest_mps);
}

void test_a_leg_waits_for_the_one_before(void)
{
    leg(1.0, 1.0, 0.0, 0.5);
    leg(1.5, 1.0, 2.0, 0.5);
    until(3.0);
    NEAR(1e-9, 0.0, point.y_m);
    until(20.0);
    NEAR(1e-9, 1.0, point.x_m);
    NEAR(1e-9, 2.0, point.y_m);
}

void test_the_nose_turns_the_short_way_round_and_not_without_being_told(void)
{
    leg(0.5, 1.0, 0.0, 0.5);
    until(6.0);
    NEAR(0.0, 0.0, point.heading_rad);
    course.legs[course.count++] = (course_leg_t){.start_s = 6.0,
                                                 .x_m = 1.0,
                                                 .y_m = 1.0,
                                                 .speed_mps = 0.5,
                                                 .heading_rad = 1.75 * M_PI,
                                                 .turn_radps = 0.5};
    until(7.0);
    NEAR(0.01, -0.5, point.heading_rad);
    until(12.0);
    NEAR(1e-6, -0.25 * M_PI, point.heading_rad);
}
