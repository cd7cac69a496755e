#include "sim/devices/travel.h"

#include <math.h>

#include "unity.h"

#define STEP_S 0.0005
#define GRAVITY_MPS2 9.80665
#define DEG (M_PI / 180.0)
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static course_t course;
static travel_t travel;

void setUp(void)
{
    course = (course_t){.count = 0};
    travel_init(&travel, &course);
}

void tearDown(void) {}

/* An attitude that follows at once. */
static void fly(double from_s, double to_s, double heading_rad)
{
    for (double t_s = from_s; t_s < to_s; t_s += STEP_S) {
        travel_steer(&travel, t_s, STEP_S, heading_rad);
        travel_step(&travel, STEP_S, heading_rad, travel.roll_rad, travel.pitch_rad, GRAVITY_MPS2, false);
    }
}

/* The seed's angles: the nose up brakes, the right side up leads to the left (y). */
TEST_CASE(0.0, 2.0, -1.0, 0.0)
TEST_CASE(0.0, -2.0, 1.0, 0.0)
TEST_CASE(2.0, 0.0, 0.0, 1.0)
TEST_CASE(-2.0, 0.0, 0.0, -1.0)
void test_a_lean_accelerates_to_its_low_side(double roll_deg, double pitch_deg, double x_sign, double y_sign)
{
    for (int i = 0; i < 200; i++) {
        travel_step(&travel, STEP_S, 0.0, roll_deg * DEG, pitch_deg * DEG, GRAVITY_MPS2, false);
    }
    /* g sin 2 degrees for 0.1 s */
    NEAR(0.001, x_sign * 0.0342, travel.vx_mps);
    NEAR(0.001, y_sign * 0.0342, travel.vy_mps);
}

void test_a_course_is_followed_and_leans_the_vehicle_forward(void)
{
    course.legs[course.count++] = (course_leg_t){.start_s = 1.0, .x_m = 4.0, .y_m = 0.0, .speed_mps = 0.4};
    fly(0.0, 5.0, 0.0);
    TEST_ASSERT_TRUE(travel.pitch_rad < 0.0);
    NEAR(0.02, 0.4, travel.vx_mps);
    NEAR(0.03, travel.wanted.x_m, travel.x_m);
    /* At a steady speed the lean carries the drag: 0.3 * 0.4 / g. */
    NEAR(0.001, -0.3 * 0.4 / GRAVITY_MPS2, travel.pitch_rad);
    fly(5.0, 25.0, 0.0);
    NEAR(0.005, 4.0, travel.x_m);
    NEAR(0.005, 0.0, travel.vx_mps);
}

/* The same way whichever way the nose points. */
TEST_CASE(0.0)
TEST_CASE(90.0)
TEST_CASE(-135.0)
void test_the_way_does_not_depend_on_the_heading(double heading_deg)
{
    course.legs[course.count++] = (course_leg_t){.start_s = 0.5, .x_m = 1.0, .y_m = -2.0, .speed_mps = 0.5};
    fly(0.0, 20.0, heading_deg * DEG);
    NEAR(0.005, 1.0, travel.x_m);
    NEAR(0.005, -2.0, travel.y_m);
}

void test_what_stands_stays(void)
{
    course.legs[course.count++] = (course_leg_t){.start_s = 0.0, .x_m = 1.0, .y_m = 0.0, .speed_mps = 0.5};
    for (int i = 0; i < 4000; i++) {
        travel_steer(&travel, i * STEP_S, STEP_S, 0.0);
        travel_step(&travel, STEP_S, 0.0, 0.1, 0.1, GRAVITY_MPS2, true);
    }
    NEAR(0.0, 0.0, travel.x_m);
}

void test_nobody_who_steers_is_no_lean(void)
{
    travel_init(&travel, NULL);
    fly(0.0, 1.0, 0.0);
    NEAR(0.0, 0.0, travel.pitch_rad);
    NEAR(0.0, 0.0, travel.x_m);
}

/* Whatever the lean does: the pitch here would brake it. */
void test_a_course_that_carries_is_kept_exactly(void)
{
    course.carried = true;
    course.legs[course.count++] = (course_leg_t){.start_s = 1.0, .x_m = 40.0, .speed_mps = 0.4};
    for (double t_s = 0.0; t_s < 6.0; t_s += STEP_S) {
        travel_steer(&travel, t_s, STEP_S, 0.0);
        travel_step(&travel, STEP_S, 0.0, 2.0 * DEG, 5.0 * DEG, GRAVITY_MPS2, false);
    }
    /* 5 s at 0.4 m/s less the 53 mm of taking up speed */
    NEAR(1e-3, 2.0 - 0.0533, travel.x_m);
    NEAR(1e-9, 0.0, travel.y_m);
    NEAR(1e-3, 0.4, travel.vx_mps);
}
