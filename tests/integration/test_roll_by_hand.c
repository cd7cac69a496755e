/* The roll test of docs/hardware.md: the vehicle held at 0.5 m, its right side up by 10 degrees, then its
 * left side. What the two heights differ by tells how far L is off, and only the true L keeps them the same.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "unity.h"

#define ROLL_RAD 0.17453293 /* 10 degrees */
#define HEIGHT_M 0.5
#define HELD_S 12.0 /* the IMU's zero and the scanner's start are over */
#define LOOK_S 13.0
#define END_S 23.0

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    const char *command;
    double roll_rad;
} hold_t;

typedef struct {
    double height_mm, slant_mm; /* means while it is held so */
    unsigned heights;
    const char *halt;
} seen_t;

static void hold(void *argument, void *result)
{
    const hold_t *order = argument;
    seen_t *seen = result;
    board_config_t config = board_config(3);
    uint32_t sequence = 0U;

    config.quadrotor.anchored = true;
    config.quadrotor.bench_height_m = HEIGHT_M;
    config.quadrotor.bench_roll_rad = order->roll_rad;
    config.quadrotor.bench_roll_start_s = HELD_S;
    board_power_on(&config, NULL, NULL);
    kernel_run_until(500 * SIM_MS);
    board_type("#LAYOUT FRONT\n", strlen("#LAYOUT FRONT\n"));
    board_type(order->command, strlen(order->command));
    while ((double)timeline_now() * 1e-9 < END_S && kernel_run_until(timeline_now() + SIM_MS)) {
        if ((double)timeline_now() * 1e-9 > LOOK_S && probe_altitude->scan_valid &&
            probe_altitude->sequence != sequence) {
            sequence = probe_altitude->sequence;
            seen->height_mm += (double)probe_altitude->altitude.height_mm;
            seen->slant_mm += (double)probe_altitude->altitude.slant_mm;
            seen->heights++;
        }
    }
    seen->height_mm /= seen->heights;
    seen->slant_mm /= seen->heights;
    seen->halt = kernel_halt_reason();
}

static seen_t held(const char *command, double roll_rad)
{
    hold_t order = {command, roll_rad};
    seen_t seen = {0};

    child_run(hold, &order, &seen, sizeof seen);
    TEST_ASSERT_NULL(seen.halt);
    TEST_ASSERT_UINT_WITHIN(6, 100, seen.heights);
    return seen;
}

/* Height with the right side up less that with the left side up. */
static double difference_mm(const char *command)
{
    return held(command, ROLL_RAD).height_mm - held(command, -ROLL_RAD).height_mm;
}

void test_with_the_true_l_both_sides_give_the_same_height(void)
{
    TEST_ASSERT_FLOAT_WITHIN(2.0F, 0.0F, (float)difference_mm("#L 220\n"));
    TEST_ASSERT_FLOAT_WITHIN(5.0F, 500.0F, (float)held("#L 220\n", ROLL_RAD).height_mm);
}

/* The seed's two readings of L are 105 mm apart: 2 x 105 x sin(10 degrees) = 36.5 mm. */
void test_an_l_that_is_105_mm_off_shows_and_by_how_much_tells_the_true_one(void)
{
    const double over_mm = difference_mm("#L 325\n"), under_mm = difference_mm("#L 115\n");

    TEST_ASSERT_FLOAT_WITHIN(3.0F, -36.5F, (float)over_mm);
    TEST_ASSERT_FLOAT_WITHIN(3.0F, 36.5F, (float)under_mm);
    TEST_ASSERT_FLOAT_WITHIN(8.0F, 220.0F, (float)(325.0 + over_mm / (2.0 * sin(ROLL_RAD))));
    TEST_ASSERT_FLOAT_WITHIN(8.0F, 220.0F, (float)(115.0 + under_mm / (2.0 * sin(ROLL_RAD))));
}

/* Distances instead of heights, which know of no L. */
void test_the_distances_of_both_sides_tell_l_as_well(void)
{
    const double y_mm = held("#L 115\n", ROLL_RAD).slant_mm - held("#L 115\n", -ROLL_RAD).slant_mm;

    TEST_ASSERT_FLOAT_WITHIN(8.0F, 220.0F, (float)(y_mm / (2.0 * tan(ROLL_RAD))));
}
