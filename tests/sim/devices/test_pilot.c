#include "sim/devices/pilot.h"

#include <math.h>

#include "sim/devices/quadrotor.h"
#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static pilot_config_t config;
static pilot_t *pilot;
static pilot_view_t view; /* what there is to see */
static bool mine;
static unsigned takes, gives, pulses;
static sim_time_t pulse_ns, pulsed_at;
static quadrotor_t *quad; /* NULL: the view is set by the test */

static pilot_view_t look(void *context)
{
    TEST_ASSERT_EQUAL_PTR(&config, context);
    if (quad != NULL) {
        const quadrotor_state_t *state = quadrotor_state(quad);
        return (pilot_view_t){quadrotor_scenario_s(quad), state->height_m, state->speed_mps};
    }
    view.t_s = (double)timeline_now() * 1e-9;
    return view;
}

static void take(void *context, bool taken)
{
    TEST_ASSERT_EQUAL_PTR(&config, context);
    TEST_ASSERT_TRUE(taken != mine);
    mine = taken;
    takes += taken;
    gives += !taken;
}

static void stick(void *context, sim_time_t high_ns)
{
    TEST_ASSERT_EQUAL_PTR(&config, context);
    pulses++;
    pulse_ns = high_ns;
    pulsed_at = timeline_now();
    if (quad != NULL) {
        quadrotor_pulse(quad, high_ns);
    }
}

void setUp(void)
{
    timeline_reset();
    config = (pilot_config_t)PILOT_DEFAULT;
    config.unrest_n = 0.0;
    view = (pilot_view_t){.height_m = 0.6};
    mine = false;
    takes = gives = pulses = 0;
    pilot = NULL;
    quad = NULL;
}

void tearDown(void)
{
    pilot_destroy(pilot);
    quadrotor_destroy(quad);
}

static void start(void)
{
    const pilot_hands_t hands = {look, take, stick, NULL, &config};

    pilot = pilot_create(&config, &hands, 1);
}

static void run_until(double t_s)
{
    const sim_time_t end = (sim_time_t)llround(t_s * 1e9);

    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static double stick_n(void)
{
    return (4166.0 - (double)pulse_ns / 480.0) / 177.21;
}

void test_a_pilot_without_a_turn_never_moves(void)
{
    start();
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_the_throttle_is_taken_and_given_back_once_and_the_stick_comes_every_frame(void)
{
    config.turn = (span_t){2.0, 3.0};
    start();
    run_until(1.99);
    TEST_ASSERT_EQUAL_UINT(0, takes);
    TEST_ASSERT_EQUAL_UINT(0, pulses);
    run_until(2.03);
    TEST_ASSERT_TRUE(mine);
    run_until(4.99);
    TEST_ASSERT_TRUE(mine);
    run_until(60.0);
    TEST_ASSERT_EQUAL_UINT(1, takes);
    TEST_ASSERT_EQUAL_UINT(1, gives);
    TEST_ASSERT_UINT_WITHIN(1, 150, pulses);
    TEST_ASSERT_INT64_WITHIN(21 * SIM_MS, 5 * SIM_S, pulsed_at);
}

void test_turns_come_again_when_told_so(void)
{
    config.turn = (span_t){2.0, 1.0};
    config.every_s = 5.0;
    start();
    run_until(21.0);
    TEST_ASSERT_EQUAL_UINT(4, takes);
    TEST_ASSERT_EQUAL_UINT(4, gives);
}

void test_the_last_turn_begins_before_its_time_and_is_flown_to_its_end(void)
{
    config.turn = (span_t){2.0, 1.0};
    config.every_s = 5.0;
    config.until_s = 7.5;
    start();
    run_until(7.9);
    TEST_ASSERT_TRUE(mine);
    run_until(30.0);
    TEST_ASSERT_EQUAL_UINT(2, takes);
    TEST_ASSERT_EQUAL_UINT(2, gives);
}

void test_the_turn_begins_with_the_stick_at_its_trim(void)
{
    config.turn = (span_t){1.0, 3.0};
    config.trim_n = 6.5;
    start();
    run_until(1.05);
    NEAR(0.02, 6.5, stick_n());
}

void test_the_hand_moves_only_after_the_eye_has_seen(void)
{
    config.turn = (span_t){1.0, 9.0};
    start();
    run_until(3.0);
    const double before_n = stick_n();
    view.height_m = 1.6;
    run_until(3.19);
    NEAR(0.001, before_n, stick_n());
    run_until(3.5);
    TEST_ASSERT_TRUE(stick_n() < before_n - 0.5);
    TEST_ASSERT_TRUE(stick_n() > before_n - 2.0);
}

/* By eye: within a hand's breadth. */
static void holds(double airframe, double hover_n, double height_m)
{
    quadrotor_config_t vehicle = quadrotor_default;
    double worst_m = 0.0;

    vehicle.airframe = airframe;
    vehicle.hover_thrust_n = hover_n;
    timeline_reset();
    quad = quadrotor_create(&vehicle, NULL, NULL, 3);
    quadrotor_set_origin(quad, 0);
    config.turn = (span_t){0.0, 60.0};
    config.height_m = height_m;
    config.unrest_n = 0.05;
    start();
    for (double t_s = 0.1; t_s < 60.0; t_s += 0.1) {
        run_until(t_s);
        if (t_s > 15.0) {
            worst_m = fmax(worst_m, fabs(quadrotor_state(quad)->height_m - height_m));
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(worst_m > 0.02 && worst_m < 0.3, "how far from the height");
    pilot_destroy(pilot);
    quadrotor_destroy(quad);
    pilot = NULL;
    quad = NULL;
    mine = false;
}

void test_a_vehicle_is_held_at_the_height_by_eye(void)
{
    holds(0.0, 7.4, 1.2);
    holds(0.0, 6.0, 0.8);
    holds(0.0, 8.4, 1.5);
    holds(1.0, 7.4, 1.2);
}

void test_height_zero_lands_it_and_leaves_the_throttle_down(void)
{
    const quadrotor_config_t vehicle = quadrotor_default;

    quad = quadrotor_create(&vehicle, NULL, NULL, 3);
    quadrotor_set_origin(quad, 0);
    config.turn = (span_t){0.0, 60.0};
    config.height_m = 0.0;
    start();
    run_until(10.0);
    NEAR(0.01, 0.0, stick_n());
    TEST_ASSERT_TRUE(quadrotor_state(quad)->on_ground);
}

void test_a_pilot_who_is_gone_leaves_nothing_behind(void)
{
    config.turn = (span_t){1.0, 3.0};
    start();
    run_until(2.0);
    pilot_destroy(pilot);
    pilot = NULL;
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}
