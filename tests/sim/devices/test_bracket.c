#include "sim/devices/bracket.h"

#include <math.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

void setUp(void) {}

void tearDown(void) {}

static void vector_is(double x, double y, double z, place_vector_t actual)
{
    NEAR(1e-6, x, actual.x);
    NEAR(1e-6, y, actual.y);
    NEAR(1e-6, z, actual.z);
}

/* Level over the origin, its nose along x: right is -y. Figures 5.7 and 5.8: L 220, d_f 105, l_f 100; d_1
 * 115, l_1 98, aft; d_2 107, l_2 105, fore. */
void test_a_mirrors_axis_ray_leaves_it_straight_down(void)
{
    const quadrotor_state_t state = {.altitude_m = 0.6};
    const bracket_pose_t pose = bracket_pose(&state);
    const bracket_ray_t front = bracket_ray(BRACKET_FRONT, &pose, 384);
    const bracket_ray_t aft = bracket_ray(BRACKET_AFT, &pose, 128);
    const bracket_ray_t fore = bracket_ray(BRACKET_FORE, &pose, 640);

    vector_is(0.0, -220.0, 700.0, front.from);
    vector_is(-115.0, -115.0, 698.0, aft.from);
    vector_is(107.0, -115.0, 705.0, fore.from);
    vector_is(0.0, 0.0, -1.0, front.direction);
    vector_is(0.0, 0.0, -1.0, aft.direction);
    vector_is(0.0, 0.0, -1.0, fore.direction);
    NEAR(1e-9, 105.0, front.before_mm);
    NEAR(1e-9, 115.0, aft.before_mm);
    NEAR(1e-9, 107.0, fore.before_mm);
}

/* Step 404 is 20 steps, 7.03125 degrees, towards the nose: it meets the mirror 105 tan = 12.951 mm fore. */
void test_a_ray_beside_the_axis_leaves_aside(void)
{
    const quadrotor_state_t state = {.altitude_m = 0.0};
    const bracket_pose_t pose = bracket_pose(&state);
    const bracket_ray_t ray = bracket_ray(BRACKET_FRONT, &pose, 404);

    NEAR(1e-3, 12.951, ray.from.x);
    NEAR(1e-6, 0.122411, ray.direction.x);
    NEAR(1e-6, -0.992480, ray.direction.z);
    NEAR(1e-3, 105.0 / 0.992480, ray.before_mm);
}

/* Nose to the left (+90 degrees): the front mirror's side is +x. Nose up by 5 degrees moves its spot forward.
 */
void test_heading_and_tilt_turn_the_bracket(void)
{
    const quadrotor_state_t turned = {.heading_rad = M_PI / 2.0, .x_m = 1.0, .y_m = 2.0};
    const quadrotor_state_t nose_up = {.pitch_rad = 5.0 * M_PI / 180.0};
    const quadrotor_state_t right_up = {.roll_rad = 5.0 * M_PI / 180.0};
    const bracket_pose_t a = bracket_pose(&turned), b = bracket_pose(&nose_up), c = bracket_pose(&right_up);

    vector_is(1220.0, 2000.0, 100.0, bracket_ray(BRACKET_FRONT, &a, 384).from);
    vector_is(0.0871557, 0.0, -0.9961947, bracket_ray(BRACKET_FRONT, &b, 384).direction);
    vector_is(0.0, -0.0871557, -0.9961947, bracket_ray(BRACKET_FRONT, &c, 384).direction);
    NEAR(1e-4, 100.0 * 0.9961947 + 220.0 * 0.0871557, bracket_ray(BRACKET_FRONT, &c, 384).from.z);
}

/* Step 300 is 84 steps, 29.53125 degrees, aft of right. The sensor stands 115 mm out, 100 mm up. */
void test_between_the_mirrors_a_ray_goes_straight_on(void)
{
    const quadrotor_state_t state = {.altitude_m = 0.0};
    const bracket_pose_t pose = bracket_pose(&state);

    TEST_ASSERT_EQUAL_INT(-1, bracket_mirror_at(300));
    TEST_ASSERT_EQUAL_INT(BRACKET_FRONT, bracket_mirror_at(372));
    TEST_ASSERT_EQUAL_INT(BRACKET_AFT, bracket_mirror_at(128));
    TEST_ASSERT_EQUAL_INT(BRACKET_FORE, bracket_mirror_at(640));
    vector_is(0.0, -115.0, 100.0, bracket_ray(-1, &pose, 300).from);
    vector_is(-0.492898, -0.870087, 0.0, bracket_ray(-1, &pose, 300).direction);
}
