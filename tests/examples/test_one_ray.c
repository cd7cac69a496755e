/* Flights of the whole firmware by examples/one_ray: a model of a TFmini Plus is on the scanner's wire.
 * SYNTHETIC: white noise of 5 mm; the sensor's data sheet promises 5 cm of accuracy, and tells no noise. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "firmware/probe.h"
#include "sim/board.h"
#include "sim/noise.h"
#include "unity.h"

#define PERIOD (10 * SIM_MS)
#define RATE 115200.0
#define POWER_UP SIM_S

static struct {
    noise_t noise;
    bool on, deaf;         /* deaf: an old sensor, which knows no orders */
    bool millimetres;      /* as it was told, until it loses its supply */
    double blocked_mm;     /* > 0: what is in front of it */
    unsigned char told[9]; /* latest octets from the firmware */
    bool ordered;          /* a reply is due */
} model;
static bool doubted;
static double highest_m;

/* As in sim/devices/bracket.c for the front mirror, and control/altitude.h the other way round. */
static double slant_mm(void)
{
    const quadrotor_state_t *body = quadrotor_state(board_quadrotor());
    const double upright = cos(body->roll_rad) * cos(body->pitch_rad);

    return 105.0 + (1000.0 * board_seen_m() + 100.0 + 220.0 * sin(body->roll_rad)) / upright;
}

static void say(const unsigned char *octets, size_t count)
{
    unsigned char frame[9];
    unsigned sum = 0;

    memcpy(frame, octets, count);
    for (size_t i = 0; i < count; i++) {
        sum += frame[i];
    }
    frame[count] = (unsigned char)sum;
    board_receive_at(BOARD_LASER, RATE, frame, count + 1);
}

static void measure(void *unused)
{
    static const unsigned char reply[4] = {0x5A, 0x05, 0x05, 0x06};
    const double true_mm = model.blocked_mm > 0.0 ? model.blocked_mm : slant_mm();
    const double told = (true_mm + 5.0 * noise_gauss(&model.noise)) / (model.millimetres ? 1.0 : 10.0);
    const unsigned distance = (unsigned)lround(fmax(0.0, told));

    (void)unused;
    if (!model.on) {
        return;
    }
    if (model.ordered) {
        model.ordered = false;
        model.millimetres = true;
        say(reply, sizeof reply);
    } else {
        say((const unsigned char[8]){0x59, 0x59, (unsigned char)distance, (unsigned char)(distance >> 8),
                                     0xE8, 3, 0, 9},
            8);
    }
    (void)timeline_after(PERIOD, measure, NULL);
}

static void hear(void *unused, unsigned octet)
{
    static const unsigned char order[9] = {0x5A, 0x05, 0x05, 0x06, 0x6A, 0x5A, 0x04, 0x11, 0x6F};

    (void)unused;
    memmove(model.told, &model.told[1], 8);
    model.told[8] = (unsigned char)octet;
    if (model.on && !model.deaf && memcmp(model.told, order, sizeof order) == 0) {
        model.ordered = true;
    }
}

static void supply(bool on)
{
    model.on = on;
    model.millimetres = false;
    if (on) {
        (void)timeline_after(POWER_UP, measure, NULL);
    }
}

static void run_until_s(double seconds)
{
    const sim_time_t end = (sim_time_t)(seconds * 1e9);

    while (timeline_now() < end) {
        TEST_ASSERT_TRUE_MESSAGE(kernel_run_until(timeline_now() + 20 * SIM_MS), kernel_halt_reason());
        doubted = doubted || (probe_flight->flags & FLIGHT_FLAG_SIGHT) != 0U;
        highest_m = fmax(highest_m, quadrotor_state(board_quadrotor())->height_m);
    }
}

static void type(const char *line)
{
    board_type(line, strlen(line));
}

static void start(unsigned long seed, bool deaf)
{
    const board_config_t config = board_config(seed);

    memset(&model, 0, sizeof model);
    noise_init(&model.noise, seed, "tfmini");
    model.deaf = deaf;
    doubted = false;
    highest_m = 0.0;
    board_power_on(&config, NULL, NULL);
    board_connect(BOARD_LASER, hear, NULL);
    supply(true);
    run_until_s(5.0);
}

static void take_off(unsigned long seed)
{
    start(seed, false);
    type("#SETR 0.6\n");
    run_until_s(15.0);
    TEST_ASSERT_EQUAL_STRING("FLYING", flight_state_name(probe_flight->state));
}

static double height_m(void)
{
    return quadrotor_state(board_quadrotor())->height_m;
}

static void run_until_down(double at_most_s)
{
    while (probe_flight->state != FLIGHT_GROUND && (double)timeline_now() < at_most_s * 1e9) {
        run_until_s((double)timeline_now() * 1e-9 + 0.1);
    }
    TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(probe_flight->state));
}

void setUp(void) {}

void tearDown(void)
{
    board_power_off();
}

TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
void test_it_hovers_and_doubts_nothing_and_lands(unsigned long seed)
{
    double square = 0.0;

    take_off(seed);
    for (int i = 0; i < 300; i++) {
        run_until_s(15.1 + 0.1 * i);
        square += pow(height_m() - 0.6, 2.0);
    }
    printf("hover rms %.1f mm\n", 1000.0 * sqrt(square / 300.0));
    TEST_ASSERT_FALSE(doubted);
    TEST_ASSERT_EQUAL(URG_OK, probe_laser->status);
    TEST_ASSERT_TRUE(sqrt(square / 300.0) < 0.03);
    type("#SETR 0\n");
    run_until_down(65.0);
    TEST_ASSERT_FALSE(doubted);
}

/* 40 to 1000 mm of height, below and above the reference. */
TEST_CASE(1, 250)
TEST_CASE(2, 450)
TEST_CASE(3, 700)
TEST_CASE(4, 800)
TEST_CASE(5, 900)
TEST_CASE(6, 1200)
/* It sinks onto the ground, by heights above the reference; it stayed there, FLYING. */
TEST_CASE(106, 850)
TEST_CASE(107, 900)
TEST_CASE(113, 1000)
TEST_CASE(114, 950)
void test_a_blocked_beam_is_doubted_and_it_comes_down(unsigned long seed, int slant)
{
    take_off(seed);
    model.blocked_mm = slant;
    run_until_down(120.0);
    printf("blocked at %d mm: highest %.2f m, down after %.1f s\n", slant, highest_m,
           (double)timeline_now() * 1e-9 - 15.0);
    TEST_ASSERT_TRUE(doubted);
    TEST_ASSERT_TRUE(highest_m < 1.5);
}

void test_a_sensor_that_does_not_repeat_the_order_never_flies(void)
{
    start(1, true);
    type("#SETR 0.6\n");
    run_until_s(15.0);
    TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(probe_flight->state));
    TEST_ASSERT_EQUAL(URG_STREAM, probe_laser->status);
    TEST_ASSERT_EQUAL_UINT32(0U, probe_altitude->sequence);
    TEST_ASSERT_TRUE(highest_m < 0.02);
}

void test_a_sensor_that_loses_its_supply_is_lost_and_it_lands(void)
{
    take_off(2);
    supply(false);
    run_until_s(16.0);
    TEST_ASSERT_EQUAL(URG_LOST, probe_laser->status);
    run_until_down(120.0);
    TEST_ASSERT_TRUE(highest_m < 1.5);
}

/* It is back after a second, in centimetres, which are taken for nothing until it has its order again. */
void test_a_sensor_whose_supply_fails_for_an_instant_is_told_again(void)
{
    take_off(3);
    supply(false);
    run_until_s(15.2);
    supply(true);
    run_until_s(18.0);
    TEST_ASSERT_EQUAL(URG_OK, probe_laser->status);
    TEST_ASSERT_TRUE(model.millimetres);
    TEST_ASSERT_FLOAT_WITHIN(100.0F, 1000.0F * (float)height_m(), probe_altitude->altitude.height_mm);
    TEST_ASSERT_TRUE(highest_m < 1.5);
}
