/* An IMU that speaks another convention than the parameters say, on the vehicle on the ground: the firmware
 * names what is wrong, before the vehicle flies by it. The models speak the wrong convention; the answers are
 * what the operator's terminal gets. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "unity.h"

#define DEG (M_PI / 180.0)
#define TYPED_S 16.0 /* scans arrive, the IMU's zero is taken, gravity was looked at */
#define LISTEN_S 2.5
#define LINES 18U

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    board_config_t config;
    const char *lines[LINES]; /* typed a second apart */
} order_t;

typedef struct {
    child_terminal_t terminal;
    flight_outputs_t flight;
    double true_mm;
} seen_t;

static seen_t seen;

static void operate(void *argument, void *result)
{
    const order_t *order = argument;
    seen_t *s = result;

    board_power_on(&order->config, child_terminal_take, &s->terminal);
    kernel_run_until((sim_time_t)(TYPED_S * 1e9));
    for (unsigned i = 0; i < LINES && order->lines[i] != NULL; i++) {
        board_type(order->lines[i], strlen(order->lines[i]));
        kernel_run_until(timeline_now() + SIM_S);
    }
    kernel_run_until(timeline_now() + (sim_time_t)(LISTEN_S * 1e9));
    s->flight = *probe_flight;
    if (kernel_halt_reason() != NULL) {
        abort();
    }
}

/* A vehicle on which the IMU lies two degrees off level each way. */
static order_t order_of(unsigned long seed)
{
    order_t order = {.config = board_config(seed)};

    order.config.imu.mount_roll_rad = 2.0 * DEG;
    order.config.imu.mount_pitch_rad = -2.0 * DEG;
    order.lines[0] = "#SETR 0.5\n";
    return order;
}

static void run(const order_t *order)
{
    order_t copy = *order;

    memset(&seen, 0, sizeof seen);
    child_run(operate, &copy, &seen, sizeof seen);
}

static void assert_said(const char *line)
{
    char wanted[160];

    snprintf(wanted, sizeof wanted, "\n%s\r\n", line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, wanted), seen.terminal.text);
}

static void assert_stays_down(const order_t *order, const char *answer)
{
    run(order);
    assert_said(answer);
    TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(seen.flight.state));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, seen.flight.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, seen.flight.reference_m);
}

static void assert_flies_without_accelerations(const order_t *order, const char *answer)
{
    run(order);
    assert_said(answer);
    TEST_ASSERT_NOT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_IMU);
    TEST_ASSERT_TRUE(seen.flight.thrust_n > 3.0F);
}

/* ---- eight wrong conventions */

void test_accelerations_in_g_are_named(void)
{
    order_t order = order_of(1);
    order.config.imu.acceleration_scale = 1.0 / 256.0;
    assert_flies_without_accelerations(&order, "OK SETR 0.5 (IMU UNIT wrong, see #IMU)");
}

void test_accelerations_in_metres_per_second_squared_are_named(void)
{
    order_t order = order_of(2);
    order.config.imu.acceleration_scale = 9.80665 / 256.0;
    assert_flies_without_accelerations(&order, "OK SETR 0.5 (IMU UNIT wrong, see #IMU)");
}

void test_accelerations_in_thousandths_of_g_are_named(void)
{
    order_t order = order_of(3);
    order.config.imu.acceleration_scale = 1000.0 / 256.0;
    assert_flies_without_accelerations(&order, "OK SETR 0.5 (IMU UNIT wrong, see #IMU)");
}

void test_accelerations_with_the_other_sign_are_named(void)
{
    order_t order = order_of(4);
    order.config.imu.acceleration_sign = -1.0;
    assert_flies_without_accelerations(&order, "OK SETR 0.5 (IMU DOWN wrong, see #IMU)");
}

void test_roll_with_the_other_sign_is_refused(void)
{
    order_t order = order_of(5);
    order.config.imu.roll_sign = -1.0;
    assert_stays_down(&order, "ERR SETR IMU ROLL against gravity, see #IMU");
}

void test_pitch_with_the_other_sign_is_refused(void)
{
    order_t order = order_of(6);
    order.config.imu.pitch_sign = -1.0;
    assert_stays_down(&order, "ERR SETR IMU PITCH against gravity, see #IMU");
}

void test_roll_and_pitch_in_each_others_place_are_refused(void)
{
    order_t order = order_of(7);
    order.config.imu.mount_pitch_rad = 0.0;
    order.config.imu.swapped = 1.0;
    assert_stays_down(&order, "ERR SETR IMU SWAPPED: roll is pitch, see #IMU");
}

void test_angles_in_radians_are_refused(void)
{
    order_t order = order_of(8);
    order.config.imu.angle_scale = M_PI / 180.0;
    assert_stays_down(&order, "ERR SETR IMU RADIANS: angles too small, see #IMU");
}

/* ---- what gravity cannot tell */

void test_motors_are_not_armed_either_and_the_names_stand_in_imu(void)
{
    order_t order = order_of(9);
    order.config.imu.roll_sign = -1.0;
    order.config.imu.pitch_sign = -1.0;
    order.lines[0] = "#ARM\n";
    order.lines[1] = "#IMU\n";
    assert_stays_down(&order, "ERR ARM IMU ROLL+PITCH against gravity, see #IMU");
    TEST_ASSERT_NOT_NULL(strstr(seen.terminal.text, " IAXES:ASSUMED fault:ROLL+PITCH\r\n"));
}

void test_axes_that_nobody_has_proved_are_told_when_it_arms(void)
{
    order_t order = order_of(10);
    order.config.imu.stock = 1.0;
    order.config.imu.period = 20 * SIM_MS;
    order.lines[0] = "#ARM\n";
    order.lines[1] = "#STOP\n";
    order.lines[2] = "#IAXES PROVED\n";
    order.lines[3] = "#ARM\n";
    run(&order);
    assert_said("OK ARM idle:15% (IMU axes assumed, see #IMU)");
    assert_said("OK ARM idle:15%");
}

void test_axes_that_were_typed_must_be_proved_first(void)
{
    order_t order = order_of(11);
    order.config.imu.stock = 1.0;
    order.config.imu.period = 20 * SIM_MS;
    order.lines[0] = "#IROLL ROLL\n";
    order.lines[1] = "#SETR 0.5\n";
    assert_stays_down(&order, "ERR SETR IMU axes set but not proved, see #IMU");
}

/* Mounted with its nose to the tail: gravity and angles agree. The vehicle's right side is held up. */
void test_an_imu_that_looks_backwards_is_found_by_raising_the_right_side(void)
{
    order_t order = order_of(12);
    order.config.imu.turned = 1.0;
    order.config.quadrotor.anchored = true;
    order.config.quadrotor.bench_height_m = 0.5;
    order.config.quadrotor.bench_roll_rad = 20.0 * DEG;
    order.config.quadrotor.bench_roll_start_s = TYPED_S + 0.7;
    order.lines[0] = "#IMU LEVEL\n";
    order.lines[1] = "#PING wait\n";
    order.lines[2] = "#IMU RIGHT\n";
    run(&order);
    assert_said("OK IMU RIGHT IROLL:ROLL IAXES:ASSUMED");
}

/* ---- what three mirrors tell, LAYOUT THREE */

static void order_lines(order_t *order, const char *const *lines, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        order->lines[i] = lines[i];
    }
}

/* The IMU lies level, so gravity tells nothing. It flies, lands, and does not fly again. */
static void assert_named_in_flight(const order_t *order, const char *refused, const char *told)
{
    static const char *const lines[] = {
        "#LAYOUT THREE\n", "#PING 1\n", "#SETR 0.6\n", "#PING 1\n", "#PING 1\n", "#PING 1\n",
        "#PING 1\n",       "#PING 1\n", "#SETR 0\n",   "#PING 1\n", "#PING 1\n", "#PING 1\n",
        "#PING 1\n",       "#PING 1\n", "#PING 1\n",   "#PING 1\n", "#ARM\n",    "#MIRRORS\n"};
    order_t flown = *order;

    order_lines(&flown, lines, LINES);
    run(&flown);
    assert_said(refused);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, told), seen.terminal.text);
    TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(seen.flight.state));
    TEST_ASSERT_NOT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_MIRRORS);
}

void test_what_gravity_cannot_tell_of_roll_the_mirrors_tell_in_flight(void)
{
    order_t order = {.config = board_config(31)};
    order.config.imu.roll_sign = -1.0;
    assert_named_in_flight(&order, "ERR ARM IMU ROLL against the mirrors, see #MIRRORS", " imu:ROLL\r\n");
}

void test_an_imu_that_looks_backwards_is_found_in_flight(void)
{
    order_t order = {.config = board_config(32)};
    order.config.imu.turned = 1.0;
    assert_named_in_flight(&order, "ERR ARM IMU ROLL+PITCH against the mirrors, see #MIRRORS",
                           " imu:ROLL+PITCH\r\n");
}

/* ---- mirrors at rest, LAYOUT THREE */

static order_t order_at_rest(unsigned long seed)
{
    static const char *const lines[] = {"#IAXES PROVED\n", "#LAYOUT THREE\n", "#PING 1\n", "#PING 1\n",
                                        "#PING 1\n",       "#MIRRORS\n",      "#ARM\n"};
    order_t order = {.config = board_config(seed)};

    order_lines(&order, lines, sizeof lines / sizeof lines[0]);
    return order;
}

void test_mirrors_that_show_the_ground_let_it_arm_without_a_word(void)
{
    const order_t order = order_at_rest(33);
    run(&order);
    assert_said("OK ARM idle:15%");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, " wrong:- "), seen.terminal.text);
    TEST_ASSERT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_MIRRORS);
}

void test_a_mirror_that_is_missing_is_named_when_it_arms(void)
{
    order_t order = order_at_rest(34);
    order.config.scene.missing_mirror = 3.0;
    run(&order);
    assert_said("OK ARM idle:15% (mirror FORE shows no ground, see #MIRRORS)");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, " fore_mm:- "), seen.terminal.text);
    TEST_ASSERT_NOT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_MIRRORS);
}

void test_rays_beside_a_mirror_are_named_when_it_arms(void)
{
    order_t order = order_at_rest(35);
    order.lines[2] = "#S1 180\n";
    run(&order);
    assert_said("OK ARM idle:15% (mirror AFT shows no ground, see #MIRRORS)");
}

void test_a_length_that_is_eight_centimetres_wrong_is_named_when_it_arms(void)
{
    order_t order = order_at_rest(36);
    order.lines[2] = "#L2 185\n";
    run(&order);
    assert_said("OK ARM idle:15% (mirror FORE shows no ground, see #MIRRORS)");
}

void test_two_missing_mirrors_do_not_arm_and_the_front_one_alone_does(void)
{
    order_t order = order_at_rest(37);
    order.config.scene.missing_mirror = 6.0;
    order.lines[7] = "#LAYOUT FRONT\n";
    order.lines[8] = "#PING 1\n";
    order.lines[9] = "#ARM\n";
    run(&order);
    assert_said("ERR ARM two mirrors show no ground, see #MIRRORS");
    assert_said("OK ARM idle:15%");
}

/* All mirrors at one length, so that none contradicts another. */
void test_mirrors_that_are_all_blocked_refuse_a_reference(void)
{
    for (unsigned long layout = 0; layout < 2; layout++) {
        order_t order = {.config = board_config(38 + layout)};
        order.config.scene.sight_blocked = 1.0;
        order.config.scene.sight_blocked_span = (span_t){-1.0e12, 2.0e12}; /* no scenario begins here */
        order.config.scene.block_mm = 640.0;
        order.lines[0] = layout == 0 ? "#LAYOUT THREE\n" : "#LAYOUT FRONT\n";
        order.lines[1] = "#PING 1\n";
        order.lines[2] = "#SETR 0.5\n";
        assert_stays_down(&order, "ERR SETR height shows no ground: mirrors blocked, or past an edge");
        TEST_ASSERT_NOT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_MIRRORS);
    }
}

void test_two_blocked_mirrors_of_three_refuse_a_reference_and_say_so(void)
{
    order_t order = {.config = board_config(40)};
    order.config.scene.sight_blocked = 1.0;
    order.config.scene.sight_blocked_span = (span_t){-1.0e12, 2.0e12};
    order.config.scene.block_mm = 640.0;
    order.config.scene.struck_beam = 6.0;
    order.lines[0] = "#SETR 0.5\n";
    assert_stays_down(&order, "ERR SETR two mirrors show no ground, see #MIRRORS");
}

/* ---- a sound one is never refused */

void test_a_sound_imu_is_not_refused_however_it_lies_and_shakes(void)
{
    static const double noises_mps2[] = {0.4, 1.6, 3.0};
    for (unsigned long seed = 20; seed < 32; seed++) {
        order_t order = order_of(seed);
        order.config.imu.mount_roll_rad = (double)(int)(seed % 5 - 2) * 3.0 * DEG;
        order.config.imu.mount_pitch_rad = (double)((int)(seed % 7) - 3) * 2.0 * DEG;
        order.config.imu.acceleration_noise_mps2 = noises_mps2[seed % 3];
        order.config.imu.acceleration_bias_mps2 = seed % 2 ? 0.8 : -0.8;
        run(&order);
        printf("seed %lu\n", seed);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, "\nOK SETR 0.5"), seen.terminal.text);
    }
}
