#include "sim/devices/rotors.h"

#include <math.h>

#include "unity.h"

#define STEP_S 0.0005
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static rotors_t rotors;

void setUp(void)
{
    const rotors_config_t config = ROTORS_DEFAULT;

    rotors_init(&rotors, &config);
}

void tearDown(void) {}

static void run(double seconds, double throttle, double climb_mps)
{
    for (long n = lround(seconds / STEP_S); n > 0; n--) {
        rotors_step(&rotors, STEP_S, throttle, climb_mps);
    }
}

static double thrust_at(double throttle, double climb_mps)
{
    run(5.0, throttle, climb_mps);
    return rotors_thrust(&rotors, climb_mps);
}

void test_in_steady_air_thrust_is_the_throttle_to_the_power_of_the_exponent(void)
{
    NEAR(1e-3, 1.0, thrust_at(1.0, 0.0));
    NEAR(2e-3, pow(1.3, 1.5), thrust_at(1.3, 0.0));
    NEAR(2e-3, pow(0.6, 1.5), thrust_at(0.6, 0.0));
    rotors.config.exponent = 2.0;
    NEAR(2e-3, 1.44, thrust_at(1.2, 0.0));
}

void test_without_throttle_there_is_no_thrust(void)
{
    run(5.0, 1.0, 0.0);
    NEAR(1e-6, 0.0, thrust_at(0.0, 0.0));
}

/* Blades cut the air that comes from above at a smaller angle: at first 0.6 / 5.4 / 0.4 per m/s; then the
 * inflow gives way, half of the climb for small ones. */
void test_a_climb_takes_thrust_away_and_the_inflow_gives_half_of_it_back(void)
{
    run(5.0, 1.0, 0.0);
    NEAR(0.002, 1.0 - 0.2778 * 0.5, rotors_thrust(&rotors, 0.5));
    run(5.0, 1.0, 0.5);
    TEST_ASSERT_TRUE(rotors_thrust(&rotors, 0.5) > 1.0 - 0.2778 * 0.5 + 0.015);
    TEST_ASSERT_TRUE(rotors_thrust(&rotors, 0.5) < 1.0 - 0.02);
    TEST_ASSERT_TRUE(rotors_thrust(&rotors, -0.5) > 1.0);
}

/* Time to 63 % of a step of the rotor speed. */
static double lag_s(double from, double to)
{
    run(5.0, from, 0.0);
    const double begin = rotors.speed, end = pow(to, 0.75);
    double t_s = 0.0;

    while (fabs(rotors.speed - begin) < 0.632 * fabs(end - begin)) {
        rotors_step(&rotors, STEP_S, to, 0.0);
        t_s += STEP_S;
    }
    return t_s;
}

void test_the_rotors_spin_up_faster_than_they_slow_down(void)
{
    NEAR(0.002, 0.07, lag_s(1.0, 1.3));
    NEAR(0.002, 0.16, lag_s(1.3, 1.0));
}

/* More thrust at once than when the air has followed. */
void test_a_quick_push_gives_more_than_it_keeps(void)
{
    double most = 0.0;

    run(5.0, 1.0, 0.0);
    rotors.config.spin_up_s = 0.01;
    for (int i = 0; i < 400; i++) {
        rotors_step(&rotors, STEP_S, 1.3, 0.0);
        most = fmax(most, rotors_thrust(&rotors, 0.0));
    }
    TEST_ASSERT_TRUE(most > 1.04 * thrust_at(1.3, 0.0));
    TEST_ASSERT_TRUE(most < 1.30 * thrust_at(1.3, 0.0));
}

void test_drag_is_against_the_motion_and_grows_with_its_square_and_with_tilt(void)
{
    NEAR(1e-9, 0.35, rotors_drag_mps2(&rotors, 1.0, 1.0));
    NEAR(1e-9, -4.0 * 0.35, rotors_drag_mps2(&rotors, -2.0, 1.0));
    NEAR(1e-9, 0.35 * (1.0 + 6.0 * 0.25), rotors_drag_mps2(&rotors, 1.0, sqrt(0.75)));
}
