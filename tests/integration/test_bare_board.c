/* The whole firmware on the PC board, seen from the LaunchPad's own USB serial port. */
#include <string.h>

#include "firmware/probe.h"
#include "firmware/schedule.h"
#include "firmware/version.h"
#include "sim/board.h"
#include "sim/timeline.h"
#include "unity.h"

#define LINES_MAX 200
#define BIT_NS (1e9 / 115200.0)

static char lines[LINES_MAX][128];
static int line_count;
static size_t length;
static sim_time_t latest;

static void hear(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * BIT_NS, BIT_NS, bit_ns);
    latest = timeline_now();
    if (octet == '\n') {
        TEST_ASSERT_TRUE(length > 0U && lines[line_count][length - 1U] == '\r');
        lines[line_count][length - 1U] = '\0';
        line_count++;
        TEST_ASSERT_LESS_THAN_INT(LINES_MAX, line_count);
        length = 0U;
    } else {
        TEST_ASSERT_LESS_THAN(sizeof lines[0] - 1U, length);
        lines[line_count][length++] = (char)octet;
    }
}

static void run_until_s(double seconds)
{
    TEST_ASSERT_TRUE_MESSAGE(kernel_run_until((sim_time_t)(seconds * 1e9)), kernel_halt_reason());
}

static int count_of(const char *beginning)
{
    int count = 0;

    for (int i = 0; i < line_count; i++) {
        count += strncmp(lines[i], beginning, strlen(beginning)) == 0;
    }
    return count;
}

void setUp(void)
{
    const board_config_t config = board_config(1);

    line_count = 0;
    length = 0U;
    latest = 0;
    memset(lines, 0, sizeof lines);
    board_power_on(&config, NULL, NULL);
    board_connect_usb(hear, NULL);
}

void tearDown(void)
{
    board_power_off();
}

void test_it_says_its_version_first_and_then_what_perf_says(void)
{
    run_until_s(3.0);
    TEST_ASSERT_EQUAL_STRING("OK VERSION " PLOMADA_VERSION, lines[0]);
    TEST_ASSERT_EQUAL_STRING_LEN("OK PERF reset:POWER load:", lines[1], 25);
    TEST_ASSERT_EQUAL_INT(2, count_of("OK PERF TaskControl worst_us:"));
    TEST_ASSERT_EQUAL_INT(2, count_of("OK PERF TaskIMU worst_us:"));
    TEST_ASSERT_EQUAL_INT(2, count_of("OK PERF wait_us altitude:"));
    TEST_ASSERT_EQUAL_INT(line_count, count_of("OK "));
}

void test_it_falls_silent_before_the_scanner_is_spoken_to_and_the_scanner_hears_none_of_it(void)
{
    run_until_s(9.9);
    TEST_ASSERT_EQUAL_UINT(0U, urg04lx_state(board_laser()).octets_mismatched);
    TEST_ASSERT_EQUAL_UINT(0U, urg04lx_state(board_laser()).commands);
    TEST_ASSERT_EQUAL_UINT(0U, urg04lx_state(board_laser()).refused);
    run_until_s(14.0);
    TEST_ASSERT_TRUE(latest > 9 * SIM_S && latest < 10 * SIM_S + 200 * SIM_MS);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(0U, length, "the last line is a whole one");
    TEST_ASSERT_TRUE(probe_altitude->sequence > 0U);
    TEST_ASSERT_INT_WITHIN(1, 5, (int)urg04lx_state(board_laser()).commands);
}

/* Without a scanner, IMU and radio: nothing but a USB cable. */
void test_a_bare_board_speaks_too(void)
{
    board_power_laser(false);
    board_power_imu(false);
    run_until_s(9.0);
    TEST_ASSERT_GREATER_THAN_INT(5, count_of("OK VERSION " PLOMADA_VERSION));
    TEST_ASSERT_GREATER_THAN_INT(5, count_of("OK PERF TaskSendComm worst_us:"));
}

void test_after_a_watchdog_reset_no_time_is_lost_on_it(void)
{
    sim_time_t before;

    run_until_s(20.0);
    board_type("#HANG TASK\n", 11U);
    before = latest;
    run_until_s(40.0);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(before, latest, "nothing is told after the reset");
    TEST_ASSERT_TRUE_MESSAGE(probe_altitude->sequence > 100U && probe_altitude->sequence < 200U,
                             "counted anew since the reset");
}

void test_an_idle_pulse_goes_on_all_the_while(void)
{
    for (double s = 0.1; s < 12.0; s += 0.05) {
        run_until_s(s);
        TEST_ASSERT_DOUBLE_WITHIN(0.3, 1999.68, board_pulse_us());
    }
}
