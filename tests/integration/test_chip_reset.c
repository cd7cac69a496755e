/* The whole firmware on the PC board, starved by an interrupt that never ceases, reset by the watchdog and
 * flying on. */
#include <stdio.h>
#include <string.h>

#include <xdc/runtime/System.h>

#include "firmware/probe.h"
#include "sim/board.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define STORM_INTERRUPT 93 /* SCIC transmit: its Hwi finds nothing to do */
#define STORM_STEP (2 * SIM_US)
#define LINES_MAX 4000

static char lines[LINES_MAX][176];
static sim_time_t line_at[LINES_MAX];
static int line_count;
static size_t length;
static sim_time_t storm_end;

static void terminal(void *context, unsigned octet)
{
    (void)context;
    if (octet == '\n') {
        lines[line_count][length] = '\0';
        line_at[line_count] = timeline_now();
        line_count++;
        TEST_ASSERT_LESS_THAN_INT(LINES_MAX, line_count);
        length = 0;
    } else if (octet != '\r' && length < sizeof lines[0] - 1U) {
        lines[line_count][length++] = (char)octet;
    }
}

static void storm(void *unused)
{
    (void)unused;
    kernel_raise(STORM_INTERRUPT);
    if (timeline_now() < storm_end) {
        (void)timeline_after(STORM_STEP, storm, NULL);
    }
}

static void run_until_s(double seconds)
{
    TEST_ASSERT_TRUE_MESSAGE(kernel_run_until((sim_time_t)(seconds * 1e9)), kernel_halt_reason());
}

static void type(const char *text)
{
    board_type(text, strlen(text));
}

/* The first line from `from_s` on that has the word, -1 when there is none. */
static int find(const char *word, double from_s)
{
    for (int i = 0; i < line_count; i++) {
        if (line_at[i] >= (sim_time_t)(from_s * 1e9) && strstr(lines[i], word) != NULL) {
            return i;
        }
    }
    return -1;
}

static double seconds_of(int line)
{
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, line);
    return (double)line_at[line] / 1e9;
}

void setUp(void)
{
    const board_config_t config = board_config(1);

    line_count = 0;
    length = 0;
    board_power_on(&config, terminal, NULL);
}

void tearDown(void)
{
    board_power_off();
}

void test_the_first_telemetry_line_tells_the_cause_of_the_reset_and_no_other_does(void)
{
    run_until_s(3.0);
    TEST_ASSERT_EQUAL_STRING("alt:- ref:0.000 laser:WAIT thr:0.00 state:GROUND flags:3 reset:POWER",
                             lines[0]);
    for (int i = 1; i < line_count; i++) {
        TEST_ASSERT_NULL(strstr(lines[i], "reset:"));
    }
}

void test_a_running_firmware_is_never_reset(void)
{
    run_until_s(60.0);
    TEST_ASSERT_EQUAL_INT(-1, find("reset:", 1.0));
}

void test_without_a_scanner_and_without_an_imu_the_watchdog_rests(void)
{
    board_connect(BOARD_LASER, NULL, NULL);
    board_connect(BOARD_IMU, NULL, NULL);
    run_until_s(60.0);
    TEST_ASSERT_EQUAL_INT(-1, find("reset:", 1.0));
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("laser:LOST", 20.0));
}

static void starve(double from_s, double for_s)
{
    run_until_s(from_s);
    storm_end = (sim_time_t)((from_s + for_s) * 1e9);
    storm(NULL);
}

void test_half_a_second_without_tasks_is_survived(void)
{
    starve(5.0, 0.5);
    run_until_s(10.0);
    TEST_ASSERT_EQUAL_INT(-1, find("reset:", 1.0));
}

void test_a_starved_firmware_is_reset_and_says_so_first_of_all(void)
{
    starve(5.0, 1.0);
    run_until_s(10.0);
    const int first = find("reset:", 1.0);

    TEST_ASSERT_DOUBLE_WITHIN(0.3, 5.0 + 0.84 + 0.35, seconds_of(first));
    TEST_ASSERT_NOT_NULL(strstr(lines[first], "reset:WATCHDOG"));
    TEST_ASSERT_EQUAL_INT(-1, find("reset:", seconds_of(first) + 0.001));
    type("#PERF\n");
    run_until_s(12.0);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("OK PERF reset:WATCHDOG load:", 10.0));
}

/* In the air there is no time for the sensors' power-up, and level is what it was on the ground. */
void test_after_a_watchdog_reset_scanner_and_imu_are_back_at_once(void)
{
    imu_sample_t before;

    run_until_s(14.0);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("laser:OK", 11.0));
    before = *probe_imu;
    starve(15.0, 1.0);
    run_until_s(16.2); /* 0.2 s hold 8 frames, an offset takes 20 */
    TEST_ASSERT_TRUE(probe_imu->ready);
    TEST_ASSERT_LESS_THAN_UINT32(before.sequence, probe_imu->sequence);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, (double)before.median.roll_rad, (double)probe_imu->median.roll_rad);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, (double)before.median.pitch_rad, (double)probe_imu->median.pitch_rad);
    run_until_s(20.0);
    TEST_ASSERT_EQUAL_INT(-1, find("laser:WAIT", 16.3));
    TEST_ASSERT_TRUE(seconds_of(find("laser:OK", 16.0)) < 18.5);
}

void test_a_reset_leaves_nothing_of_what_the_operator_had_set(void)
{
    run_until_s(12.0);
    type("#KP 0.02\n");
    run_until_s(12.5);
    starve(12.5, 1.0);
    run_until_s(16.0);
    type("#GET KP\n");
    run_until_s(17.0);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("OK KP 0.02", 12.0));
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("OK KP 0.015", 16.0));
}

static double height_m(void)
{
    return quadrotor_state(board_quadrotor())->height_m;
}

/* R11: a fault of the firmware itself may cost height, but it ends in a flight that the operator can command.
 */
void test_a_flight_goes_on_after_a_watchdog_reset(void)
{
    run_until_s(13.0);
    type("#SETR 0.6\n");
    starve(20.0, 1.0);
    TEST_ASSERT_TRUE(height_m() > 0.3);
    run_until_s(24.0);
    type("#SETR 0.6\n");
    run_until_s(34.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 0.6, height_m());
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("state:FLYING", 30.0));
}

static void abort_now(void *unused)
{
    (void)unused;
    System_abort("as a failed assert would");
}

/* Where the firmware stops for good nobody services the watchdog any more. */
void test_a_fault_of_the_firmware_ends_in_a_reset_too(void)
{
    run_until_s(5.0);
    (void)timeline_after(SIM_MS, abort_now, NULL);
    TEST_ASSERT_FALSE(kernel_run_until(5 * SIM_S + 100 * SIM_MS));
    (void)kernel_run_until(6 * SIM_S); /* the reset is within */
    run_until_s(8.0);
    const int first = find("reset:WATCHDOG", 5.0);

    TEST_ASSERT_TRUE(seconds_of(first) < 6.3);
    type("#PING 1\n");
    run_until_s(9.0);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("OK PING 1", 8.0));
}

void test_the_watchdog_bites_a_second_time(void)
{
    starve(5.0, 1.0);
    run_until_s(9.0);
    starve(9.0, 1.0);
    run_until_s(12.0);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("reset:WATCHDOG", 5.0));
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, find("reset:WATCHDOG", 9.0));
}

/* What began as the third flight in one process begins as the first one did. */
void test_every_power_on_begins_alike(void)
{
    static char first[40][176];
    const board_config_t config = board_config(1);

    run_until_s(8.0);
    TEST_ASSERT_GREATER_THAN_INT(30, line_count);
    (void)memcpy(first, lines, sizeof first);
    for (int flight = 0; flight < 2; flight++) {
        board_power_off();
        line_count = 0;
        length = 0;
        board_power_on(&config, terminal, NULL);
        run_until_s(8.0);
        for (int i = 0; i < 30; i++) {
            TEST_ASSERT_EQUAL_STRING(first[i], lines[i]);
        }
    }
}
