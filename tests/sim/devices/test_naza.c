/* The autopilot's rules for its motors, each as its manual has it. */
#include "sim/devices/naza.h"

#include "unity.h"

#define DT_S 0.0005

static naza_t naza;
static naza_inputs_t in;

static void use(double stop_type)
{
    const naza_config_t config = {stop_type};

    naza_init(&naza, &config);
    in = (naza_inputs_t){.pulses = true, .manual = true, .on_ground = true};
}

void setUp(void)
{
    use(NAZA_IMMEDIATELY);
}

void tearDown(void) {}

static void pass(double seconds)
{
    for (double t_s = 0.0; t_s < seconds; t_s += DT_S) {
        naza_step(&naza, &in, DT_S);
    }
}

static void hold_corners(void)
{
    in.throttle = 0.0;
    in.corners = true;
    pass(1.0);
    in.corners = false;
}

static void start_and_open(double throttle)
{
    hold_corners();
    in.throttle = throttle;
    pass(0.1);
    TEST_ASSERT_TRUE(naza.running);
}

void test_no_throttle_starts_motors(void)
{
    for (in.throttle = 0.0; in.throttle <= 1.0; in.throttle += 0.1) {
        pass(1.0);
        TEST_ASSERT_FALSE(naza.running);
    }
}

void test_the_stick_command_starts_them_once_and_not_above_ten_percent(void)
{
    in.throttle = 0.15;
    in.corners = true;
    pass(1.0);
    TEST_ASSERT_FALSE(naza.running);
    in.corners = false;
    hold_corners();
    TEST_ASSERT_TRUE(naza.running);
}

void test_without_ten_percent_within_three_seconds_of_the_start_they_stop(void)
{
    for (int type = 0; type < 2; type++) {
        use(type);
        hold_corners();
        in.throttle = 0.09;
        pass(1.9);
        TEST_ASSERT_TRUE(naza.running);
        pass(0.2);
        TEST_ASSERT_FALSE(naza.running);
        in.throttle = 0.5;
        pass(1.0);
        TEST_ASSERT_FALSE_MESSAGE(naza.running, "only the stick command starts them then");
    }
}

void test_immediately_stops_them_under_ten_percent_in_any_mode_in_the_air_too(void)
{
    for (int mode = 0; mode < 4; mode++) {
        use(NAZA_IMMEDIATELY);
        in.manual = mode % 2 == 0;
        in.on_ground = mode / 2 == 0;
        start_and_open(0.6);
        in.throttle = 0.11;
        pass(60.0);
        TEST_ASSERT_TRUE(naza.running);
        in.throttle = 0.09;
        pass(2 * DT_S);
        TEST_ASSERT_FALSE(naza.running);
    }
}

void test_immediately_lets_them_run_again_within_five_seconds(void)
{
    start_and_open(0.6);
    in.throttle = 0.0;
    pass(4.9);
    in.throttle = 0.5;
    pass(0.1);
    TEST_ASSERT_TRUE(naza.running);
    in.throttle = 0.0;
    pass(5.1);
    in.throttle = 0.5;
    pass(1.0);
    TEST_ASSERT_FALSE(naza.running);
}

void test_intelligent_in_manual_is_never_stopped_by_the_throttle(void)
{
    use(NAZA_INTELLIGENT);
    start_and_open(0.6);
    in.throttle = 0.0;
    pass(60.0);
    TEST_ASSERT_TRUE(naza.running);
    hold_corners();
    TEST_ASSERT_FALSE(naza.running);
}

void test_intelligent_in_attitude_stops_three_seconds_after_the_landing_and_when_turned_over(void)
{
    use(NAZA_INTELLIGENT);
    in.manual = false;
    start_and_open(0.6);
    in.throttle = 0.0;
    in.on_ground = false;
    pass(2.0);
    TEST_ASSERT_TRUE(naza.running);
    in.on_ground = true;
    pass(0.9);
    TEST_ASSERT_TRUE(naza.running);
    pass(0.2);
    TEST_ASSERT_FALSE(naza.running);
    start_and_open(0.6);
    in.tilt_rad = 1.2;
    pass(0.1);
    TEST_ASSERT_TRUE(naza.running);
    in.tilt_rad = 1.25;
    pass(0.1);
    TEST_ASSERT_FALSE(naza.running);
}

void test_the_stick_command_in_the_air_stops_them(void)
{
    use(NAZA_INTELLIGENT);
    start_and_open(0.6);
    in.on_ground = false;
    hold_corners();
    TEST_ASSERT_FALSE(naza.running);
}

void test_without_pulses_it_holds_the_height_and_then_lands_whatever_the_throttle(void)
{
    double climb_mps = 1.0;

    start_and_open(0.6);
    TEST_ASSERT_FALSE(naza_failsafe(&naza, &climb_mps));
    in.pulses = false;
    in.throttle = 0.0;
    pass(0.2);
    TEST_ASSERT_TRUE(naza_failsafe(&naza, &climb_mps));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, climb_mps);
    pass(3.0);
    TEST_ASSERT_TRUE(naza_failsafe(&naza, &climb_mps));
    TEST_ASSERT_TRUE(climb_mps < -0.1 && climb_mps > -1.0);
    TEST_ASSERT_TRUE(naza.running);
}

void test_an_always_armed_one_has_no_rules_and_no_manual_mode(void)
{
    double climb_mps;

    use(NAZA_ALWAYS_ARMED);
    TEST_ASSERT_TRUE(naza.running);
    pass(10.0);
    in.corners = true;
    in.tilt_rad = 3.0;
    in.pulses = false;
    pass(10.0);
    TEST_ASSERT_TRUE(naza.running);
    TEST_ASSERT_FALSE(naza_is_manual(&naza, true));
    TEST_ASSERT_FALSE(naza_failsafe(&naza, &climb_mps));
}
