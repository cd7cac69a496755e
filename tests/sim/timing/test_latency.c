#include "sim/timing/latency.h"

#include <string.h>

#include "control/flight_io.h"
#include "sim/firmware_view.h"
#include "sim/ti/driverlib/chip.h"
#include "unity.h"

/* The firmware's servers, the gates' names and the chip's compare register, as the test wants them. */
static uint32_t heights;
static uint16_t releases;
static uint32_t compare;

enum { ALTITUDE, PARAMETER, OTHER };

uint32_t firmware_view_heights(void)
{
    return heights;
}

uint16_t firmware_view_releases(void)
{
    return releases;
}

const char *kernel_gate_name(int number)
{
    static const char *const names[] = {"Altitude_server", "Parameter_server", "FlightStatus_server"};

    return names[number];
}

uint32_t chip_register(const char *name)
{
    TEST_ASSERT_EQUAL_STRING("EPWM2.CMPA", name);
    return compare;
}

static const kernel_job_t laser = {KERNEL_TASK, "TaskReceiveLaser", 1, 5, 0};
static const kernel_job_t control = {KERNEL_TASK, "TaskControl", 2, 4, 0};
static const kernel_job_t comm = {KERNEL_TASK, "TaskSendComm", 4, 2, 0};
static const kernel_job_t rx = {KERNEL_HWI, "TaskControl", 96, 96, 0};
static latency_t latency;

void setUp(void)
{
    timeline_reset();
    heights = 0;
    releases = FLIGHT_RELEASE_PERIOD;
    compare = 4166;
    latency_init(&latency);
}

void tearDown(void) {}

static void scan_ends_at_us(sim_time_t when)
{
    static const char end[] = "x\n\n";

    timeline_move_to(when * SIM_US);
    for (size_t i = 0; end[i] != '\0'; i++) {
        latency_octet(&latency, (unsigned char)end[i]);
    }
}

static void at_us(sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail)
{
    latency_observe(&latency, when * SIM_US, event, job, detail);
}

static void height_written_at_us(sim_time_t when)
{
    at_us(when, KERNEL_GATE_ENTERED, &laser, ALTITUDE);
    heights++;
    at_us(when, KERNEL_GATE_LEFT, &laser, ALTITUDE);
}

static void control_reads_at_us(sim_time_t when)
{
    at_us(when, KERNEL_GATE_LEFT, &control, PARAMETER);
    at_us(when, KERNEL_GATE_LEFT, &control, ALTITUDE);
}

static void compare_written_at_us(sim_time_t when, uint32_t value)
{
    compare = value;
    at_us(when, KERNEL_GATE_ENTERED, &control, OTHER);
    at_us(when + 9, KERNEL_GATE_LEFT, &control, OTHER);
    at_us(when + 9, KERNEL_FINISHED, &control, 4);
}

static const latency_figures_t *of(int release)
{
    return &latency.by_release[release];
}

void test_it_goes_from_the_scans_last_octet_to_the_write(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    control_reads_at_us(2900);
    compare_written_at_us(2950, 3000);
    TEST_ASSERT_EQUAL_INT(1, of(RELEASE_FREE)->answers);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_FREE)->longest);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_FREE)->shortest);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_FREE)->total);
    TEST_ASSERT_EQUAL_INT64(1000 * SIM_US, of(RELEASE_FREE)->longest_since);
    TEST_ASSERT_EQUAL_INT(0, of(RELEASE_SCAN)->answers);
}

void test_an_equal_value_counts_at_the_end_of_the_cycle(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    control_reads_at_us(2900);
    compare_written_at_us(2950, 4166);
    TEST_ASSERT_EQUAL_INT64(1959 * SIM_US, of(RELEASE_FREE)->longest);
}

void test_a_cycle_that_read_before_the_height_was_written_does_not_answer_it(void)
{
    scan_ends_at_us(1000);
    control_reads_at_us(1900);
    height_written_at_us(2000); /* TaskReceiveLaser comes between */
    compare_written_at_us(2050, 3000);
    TEST_ASSERT_EQUAL_INT(0, of(RELEASE_FREE)->answers);
    control_reads_at_us(3000);
    compare_written_at_us(3100, 3001);
    TEST_ASSERT_EQUAL_INT64(2100 * SIM_US, of(RELEASE_FREE)->longest);
}

void test_a_height_that_comes_between_read_and_write_does_not_shorten_it(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    control_reads_at_us(2900);
    scan_ends_at_us(2910);
    height_written_at_us(2920);
    compare_written_at_us(2950, 3000);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_FREE)->longest);
}

void test_each_height_is_answered_once(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    for (int i = 0; i < 3; i++) {
        control_reads_at_us(2900 + i * 1000);
        compare_written_at_us(2950 + i * 1000, 3000 + (uint32_t)i);
    }
    TEST_ASSERT_EQUAL_INT(1, of(RELEASE_FREE)->answers);
}

void test_a_scan_without_a_height_is_not_answered(void)
{
    scan_ends_at_us(1000);
    at_us(2000, KERNEL_GATE_LEFT, &laser, ALTITUDE);
    control_reads_at_us(2900);
    compare_written_at_us(2950, 3000);
    TEST_ASSERT_EQUAL_INT(0, of(RELEASE_FREE)->answers);
}

void test_a_compare_value_written_before_the_read_is_not_the_answer(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    compare = 2500;
    control_reads_at_us(2900);
    compare_written_at_us(2950, 3000);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_FREE)->longest);
}

void test_figures_are_kept_for_the_release_that_control_waited_for_when_the_height_came(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    releases = FLIGHT_RELEASE_HEIGHT; /* told by the cycle that answers */
    control_reads_at_us(90000);
    compare_written_at_us(90100, 3000);
    scan_ends_at_us(101000);
    height_written_at_us(102000);
    control_reads_at_us(102900);
    compare_written_at_us(102950, 3001);
    TEST_ASSERT_EQUAL_INT(1, of(RELEASE_FREE)->answers);
    TEST_ASSERT_EQUAL_INT64(89100 * SIM_US, of(RELEASE_FREE)->longest);
    TEST_ASSERT_EQUAL_INT(1, of(RELEASE_SCAN)->answers);
    TEST_ASSERT_EQUAL_INT64(1950 * SIM_US, of(RELEASE_SCAN)->longest);
}

void test_shortest_longest_and_sum(void)
{
    static const sim_time_t writes[] = {2950, 102900, 203000};

    for (int i = 0; i < 3; i++) {
        scan_ends_at_us(1000 + 100000 * i);
        height_written_at_us(2000 + 100000 * i);
        control_reads_at_us(2800 + 100000 * i);
        compare_written_at_us(writes[i], 3000 + (uint32_t)i);
    }
    TEST_ASSERT_EQUAL_INT(3, of(RELEASE_FREE)->answers);
    TEST_ASSERT_EQUAL_INT64(1900 * SIM_US, of(RELEASE_FREE)->shortest);
    TEST_ASSERT_EQUAL_INT64(2000 * SIM_US, of(RELEASE_FREE)->longest);
    TEST_ASSERT_EQUAL_INT64(201000 * SIM_US, of(RELEASE_FREE)->longest_since);
    TEST_ASSERT_EQUAL_INT64(5850 * SIM_US, of(RELEASE_FREE)->total);
}

void test_other_jobs_do_not_matter(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    at_us(2100, KERNEL_GATE_LEFT, &comm, ALTITUDE);
    at_us(2100, KERNEL_FINISHED, &comm, 2);
    at_us(2200, KERNEL_FINISHED, &rx, 96);
    compare = 3000;
    at_us(2300, KERNEL_FINISHED, &control, 4); /* it has not read */
    TEST_ASSERT_EQUAL_INT(0, of(RELEASE_FREE)->answers);
}

void test_the_observer_says_when_there_is_an_answer_and_to_what(void)
{
    scan_ends_at_us(1000);
    height_written_at_us(2000);
    control_reads_at_us(2900);
    TEST_ASSERT_FALSE(latency.answered);
    compare = 3000;
    at_us(2950, KERNEL_GATE_ENTERED, &control, OTHER);
    TEST_ASSERT_TRUE(latency.answered);
    TEST_ASSERT_EQUAL_INT64(1000 * SIM_US, latency.answer_to);
    at_us(2950, KERNEL_RELEASED, &rx, 96);
    TEST_ASSERT_FALSE(latency.answered);
}

static void scan_answered(sim_time_t from_us)
{
    scan_ends_at_us(from_us);
    height_written_at_us(from_us + 1000);
    control_reads_at_us(from_us + 1900);
    compare_written_at_us(from_us + 1950, compare + 1U);
}

void test_the_events_waited_for_are_one_of_three_releases(void)
{
    static const struct {
        uint16_t releases;
        int release;
    } cases[] = {
        {FLIGHT_RELEASE_PERIOD, RELEASE_FREE},
        {FLIGHT_RELEASE_HEIGHT, RELEASE_SCAN},
        {FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, LATENCY_FRAME},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        releases = cases[i].releases;
        scan_answered(1000);
        for (int release = 0; release < LATENCY_RELEASES; release++) {
            TEST_ASSERT_EQUAL_INT(release == cases[i].release, of(release)->answers);
        }
    }
}
