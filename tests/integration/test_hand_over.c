/* The pilot takes the throttle in the air, 8 s after the reference, flies at the same height or another one,
 * and hands it back 4 s later. Pinned to three seeds; rates over pilots drawn anew: test_rates.py. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "control/thrust.h"
#include "firmware/probe.h"
#include "unity.h"

#define REFERENCE_M 0.6
#define HIGHER_M 0.85
#define STEP (10 * SIM_MS)

typedef struct {
    const char *commands;
    double hover_n, pilot_m;
    unsigned long seed;
} order_t;

typedef struct {
    flight_state_t before, during, after;
    uint16_t flags_before, flags_during, flags_after;
    bool stayed;           /* the state never changed while the pilot flew */
    double pilot_thrust_n; /* commanded just before he hands back; the pin may be wrong, so it is not hover */
    double first_n,
        largest_step_n; /* first command after that; steps from sample to sample in the second after it */
    double pilot_error_m, end_m; /* of his height at the end of his turn; the height 6 s later */
    double highest_m, lowest_m;  /* in those 6 s */
} seen_t;

void setUp(void) {}
void tearDown(void) {}

static double thrust_n(void)
{
    return (double)probe_flight->thrust_n;
}

static void stick(const order_t *order)
{
    const quadrotor_state_t *state = quadrotor_state(board_quadrotor());
    const double wanted_n = order->hover_n + 4.0 * (order->pilot_m - state->height_m) -
                            3.0 * state->speed_mps;

    board_stick((sim_time_t)llround((double)thrust_to_pulse_us((float)wanted_n) * 1000.0));
}

static void pilots_turn(const order_t *order, seen_t *seen)
{
    seen->before = probe_flight->state;
    seen->flags_before = probe_flight->flags;
    seen->stayed = true;
    board_select(false);
    for (int i = 0; i < 400; i++) {
        if (i % 2 == 0) {
            stick(order);
        }
        (void)kernel_run_until(timeline_now() + STEP);
        if (i == 20) {
            seen->during = probe_flight->state;
            seen->flags_during = probe_flight->flags;
        }
        seen->stayed = seen->stayed && (i < 20 || probe_flight->state == seen->during);
    }
    seen->pilot_thrust_n = thrust_n();
    seen->pilot_error_m = quadrotor_state(board_quadrotor())->height_m - order->pilot_m;
    board_select(true);
}

static void back_again(seen_t *seen)
{
    double before_n = thrust_n();

    seen->highest_m = 0.0;
    seen->lowest_m = 9.0;
    for (int i = 0; i < 600; i++) {
        (void)kernel_run_until(timeline_now() + STEP);
        const double height_m = quadrotor_state(board_quadrotor())->height_m;

        if (seen->first_n == 0.0) {
            seen->first_n = (probe_flight->state == FLIGHT_FLYING) ? thrust_n() : 0.0;
        } else if (i < 100) {
            seen->largest_step_n = fmax(seen->largest_step_n, fabs(thrust_n() - before_n));
        }
        before_n = thrust_n();
        seen->highest_m = fmax(seen->highest_m, height_m);
        seen->lowest_m = fmin(seen->lowest_m, height_m);
    }
    seen->end_m = quadrotor_state(board_quadrotor())->height_m;
    seen->after = probe_flight->state;
    seen->flags_after = probe_flight->flags;
}

static void fly(void *argument, void *result)
{
    const order_t *order = argument;
    board_config_t config = board_config(order->seed);
    char lines[128];

    config.quadrotor.hover_thrust_n = order->hover_n;
    board_power_on(&config, NULL, NULL);
    (void)kernel_run_until(SIM_S);
    board_type("#LAYOUT FRONT\n", strlen("#LAYOUT FRONT\n")); /* the bounds are of its height */
    (void)kernel_run_until(13 * SIM_S);
    snprintf(lines, sizeof lines, "%s#SETR %g\n", order->commands, REFERENCE_M);
    board_type(lines, strlen(lines));
    (void)kernel_run_until(21 * SIM_S);
    pilots_turn(order, result);
    back_again(result);
}

static seen_t flown(const char *commands, double hover_n, double pilot_m, unsigned long seed)
{
    order_t order = {commands, hover_n, pilot_m, seed};
    seen_t seen = {.stayed = false};

    child_run(fly, &order, &seen, sizeof seen);
    printf("%.8s hover %.1f N: pilot's end %.2f N, first %.2f N, largest step %.2f N, height %.3f to %.3f m, "
           "end %.3f m\n",
           commands, hover_n, seen.pilot_thrust_n, seen.first_n, seen.largest_step_n, seen.lowest_m,
           seen.highest_m, seen.end_m);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, seen.before);
    TEST_ASSERT_EQUAL_UINT16(0, seen.flags_before);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, seen.after);
    TEST_ASSERT_EQUAL_UINT16(0, seen.flags_after);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 0.0, seen.pilot_error_m);
    return seen;
}

static void floats_and_comes_back(const char *commands, double hover_n, double pilot_m, unsigned long seed)
{
    const seen_t seen = flown(commands, hover_n, pilot_m, seed);
    const double margin_m = strstr(commands, "PID") != NULL ? 0.25 : 0.06;
    const double step_n = fmax(1.0, hover_n * 1.0 / 7.4); /* the same acceleration on a heavy vehicle */

    TEST_ASSERT_EQUAL(FLIGHT_FLOATING, seen.during);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT, seen.flags_during);
    TEST_ASSERT_TRUE(seen.stayed);
    TEST_ASSERT_DOUBLE_WITHIN(2.4, hover_n, seen.pilot_thrust_n);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, hover_n, seen.first_n);
    TEST_ASSERT_TRUE(seen.largest_step_n > 0.0 &&
                     seen.largest_step_n < (pilot_m == REFERENCE_M ? step_n : 1.8));
    TEST_ASSERT_TRUE(seen.highest_m < pilot_m + margin_m && seen.lowest_m > REFERENCE_M - margin_m);
    TEST_ASSERT_DOUBLE_WITHIN(margin_m, REFERENCE_M, seen.end_m);
}

void test_with_the_pin_the_pilots_turn_ends_without_a_jump(void)
{
    for (double hover_n = 6.0; hover_n < 8.5; hover_n += 0.8) {
        for (unsigned long seed = 1; seed <= 3; seed++) {
            floats_and_comes_back("#LAW EST\n#SEL PIN\n", hover_n, REFERENCE_M, seed);
        }
    }
}

void test_from_another_height_it_returns_to_the_reference(void)
{
    for (double hover_n = 6.0; hover_n < 8.5; hover_n += 0.8) {
        for (unsigned long seed = 1; seed <= 3; seed++) {
            floats_and_comes_back("#LAW EST\n#SEL PIN\n", hover_n, HIGHER_M, seed);
        }
    }
}

void test_the_seeds_law_hands_over_too(void)
{
    for (unsigned long seed = 1; seed <= 3; seed++) {
        floats_and_comes_back("#LAW PID\n#SEL PIN\n", 7.4, REFERENCE_M, seed);
        floats_and_comes_back("#LAW PID\n#SEL PIN\n", 7.4, HIGHER_M, seed);
    }
}

/* It finds that its commands have no effect, and keeps them near what carries the vehicle: 0.6 N below a
 * hover thrust that it knows within 0.4 N. In one flight of 24 it has not found it by the end of the turn:
 * that one gives the throttle back at 3.9 N, and sinks to 0.52 m. */
void test_without_the_pin_the_law_goes_on_against_the_pilot_but_gently(void)
{
    int gentle = 0;

    for (unsigned long seed = 1; seed <= 12; seed++) {
        const seen_t seen = flown("#LAW EST\n", 7.4, HIGHER_M, seed);

        TEST_ASSERT_EQUAL(FLIGHT_FLYING, seen.during);
        TEST_ASSERT_EQUAL_UINT16(0, seen.flags_during);
        TEST_ASSERT_TRUE(seen.stayed);
        TEST_ASSERT_TRUE(seen.lowest_m > 0.4 && seen.highest_m < HIGHER_M + 0.15);
        TEST_ASSERT_DOUBLE_WITHIN(0.06, REFERENCE_M, seen.end_m);
        gentle += fabs(seen.first_n - (7.4 - 0.6)) < 0.4 && seen.lowest_m > REFERENCE_M - 0.06 &&
                  seen.highest_m < HIGHER_M + 0.06;
    }
    TEST_ASSERT_INT_WITHIN(1, 11, gentle);
}
