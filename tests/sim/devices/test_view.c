#include "sim/devices/view.h"

#include <math.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)
#define DEG (M_PI / 180.0)

static place_t place;
static quadrotor_state_t vehicle; /* level, its nose along x, its gear 0.6 m above the floor */

void setUp(void)
{
    place_init(&place);
    vehicle = (quadrotor_state_t){.altitude_m = 0.6};
}

void tearDown(void) {}

static double ground_at(const view_t *view, double ahead_m)
{
    return view->ground_m[lround((ahead_m - VIEW_FIRST_M) / VIEW_STEP_M)];
}

static void put(double x_m, double y_m, double length_m, double width_m, double near_m, double far_m)
{
    TEST_ASSERT_TRUE(place_add(&place, &(place_block_t){.x_m = x_m,
                                                        .y_m = y_m,
                                                        .length_m = length_m,
                                                        .width_m = width_m,
                                                        .near_top_m = near_m,
                                                        .far_top_m = far_m}));
}

/* The bracket's drawing: the front mirror 220 mm to the right, the aft one 115 mm to the right and 115 back,
 * the fore one 115 to the right and 107 ahead; 100, 98 and 105 mm above the gear. */
static void expect_beams(const view_t *view, double front_m, double aft_m, double fore_m)
{
    static const double ahead_m[] = {0.0, -0.115, 0.107}, right_m[] = {0.22, 0.115, 0.115};
    static const double up_m[] = {0.1, 0.098, 0.105};
    const double ends_m[] = {front_m, aft_m, fore_m};

    for (int i = 0; i < VIEW_BEAMS; i++) {
        TEST_ASSERT_TRUE(view->beam[i].meets);
        NEAR(1e-9, ahead_m[i], view->beam[i].from.x);
        NEAR(1e-9, -right_m[i], view->beam[i].from.y);
        NEAR(1e-9, 0.6 + up_m[i], view->beam[i].from.z);
        NEAR(1e-9, ahead_m[i], view->beam[i].to.x);
        NEAR(1e-9, -right_m[i], view->beam[i].to.y);
        NEAR(1e-9, ends_m[i], view->beam[i].to.z);
    }
}

void test_over_an_even_floor_the_three_beams_end_on_it_under_their_mirrors(void)
{
    const view_t view = view_of(&place, &vehicle, 0.0);

    expect_beams(&view, 0.0, 0.0, 0.0);
    for (int i = 0; i < VIEW_POINTS; i++) {
        NEAR(1e-12, 0.0, view.ground_m[i]);
    }
}

/* An edge between the mirrors: a box that begins 5 cm ahead of the centre. */
void test_at_an_edge_the_beams_end_at_two_heights_and_the_ground_shows_it(void)
{
    put(1.05, 0.0, 2.0, 3.0, 0.3, 0.3);
    const view_t view = view_of(&place, &vehicle, 0.0);

    expect_beams(&view, 0.0, 0.0, 0.3);
    NEAR(1e-12, 0.0, ground_at(&view, 0.025));
    NEAR(1e-12, 0.3, ground_at(&view, 0.075));
    NEAR(1e-12, 0.0, ground_at(&view, -2.0));
}

/* A ramp from 0 at 1 m to 0.5 at 2 m ahead of a vehicle that looks along y. */
void test_the_ground_is_that_along_the_nose(void)
{
    vehicle.heading_rad = 90.0 * DEG;
    vehicle.x_m = 3.0;
    TEST_ASSERT_TRUE(place_add(&place, &(place_block_t){.x_m = 3.0,
                                                        .y_m = 1.5,
                                                        .heading_rad = 90.0 * DEG,
                                                        .length_m = 1.0,
                                                        .width_m = 1.0,
                                                        .far_top_m = 0.5}));
    const view_t view = view_of(&place, &vehicle, 0.0);

    NEAR(1e-9, 0.0, ground_at(&view, 0.95));
    NEAR(1e-9, 0.25, ground_at(&view, 1.5));
    NEAR(1e-9, 0.45, ground_at(&view, 1.9));
    NEAR(1e-9, 0.0, ground_at(&view, -1.5));
}

/* With its right side raised by 30 degrees the front's beam leads outwards: it is 0.22 m out and 0.1 m up
 * along the turned axes, and goes down at 30 degrees to the plumb line. */
void test_a_beam_of_a_tilted_vehicle_leans_with_it(void)
{
    vehicle.roll_rad = 30.0 * DEG;
    const view_t view = view_of(&place, &vehicle, 0.0);
    const double from_y_m = -(0.22 * cos(30.0 * DEG) - 0.1 * sin(30.0 * DEG));
    const double from_z_m = 0.6 + 0.22 * sin(30.0 * DEG) + 0.1 * cos(30.0 * DEG);

    NEAR(1e-9, from_y_m, view.beam[0].from.y);
    NEAR(1e-9, from_z_m, view.beam[0].from.z);
    NEAR(1e-9, from_y_m - from_z_m * tan(30.0 * DEG), view.beam[0].to.y);
    NEAR(1e-9, 0.0, view.beam[0].to.z);
}

void test_a_beam_that_meets_nothing_ends_with_the_sensors_reach(void)
{
    vehicle.altitude_m = 8.0;
    const view_t view = view_of(&place, &vehicle, 0.0);

    TEST_ASSERT_FALSE(view.beam[0].meets);
    NEAR(1e-9, 8.1 - (5.6 - 0.105), view.beam[0].to.z);
}
