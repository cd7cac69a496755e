/* TaskSendComm: one telemetry line every 200 ms, from the servers to the radio. */
#include "control/battery.h"
#include "control/bounds.h"
#include "control/sense/verdict.h"
#include "firmware/tasks.h"

#include <math.h>
#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_boot.h"
#include "mock_pulse_stream.h"
#include "mock_servers.h"
#include "mock_surroundings.h"
#include "mock_timebase.h"
#include "mock_xbee_port.h"
#include "control/facts.h"
#include "unity.h"

static laser_sample_t laser;
static flight_outputs_t flight;
static telemetry_line_t line;
static uint16_t lines; /* but those of the beams */
static telemetry_line_t beams;
static uint16_t beams_lines;
static const char *cause;   /* NULL: not told */
static uint16_t more_ticks; /* that come while the task runs */

static void laser_read(laser_sample_t *sample, int calls)
{
    (void)calls;
    *sample = laser;
}

static void flight_read(flight_outputs_t *status, int calls)
{
    (void)calls;
    *status = flight;
}

static void report(const telemetry_line_t *text, int calls)
{
    (void)calls;
    if (memcmp(text->text, "mf:", 3) == 0) {
        beams = *text;
        beams_lines++;
        return;
    }
    kernel_note("report");
    line = *text;
    lines++;
    if (more_ticks > 0U) {
        more_ticks--;
        kernel.clock.function(kernel.clock.params.arg);
    }
}

static const char *boot(int calls)
{
    (void)calls;
    return cause;
}

/* What stands around, when there is something to tell of it. */
static const char *around; /* NULL: nothing */
static uint16_t around_lines;
static bool room; /* in the transmitter */

static bool surroundings(telemetry_line_t *text, const flight_outputs_t *status, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_FLOAT(flight.height_mm, status->height_mm);
    if (around != NULL) {
        telemetry_begin(text);
        telemetry_text(text, around);
        telemetry_end(text);
    }
    return around != NULL;
}

static bool warns;
static uint16_t drift_lines;

static bool warn(int calls)
{
    (void)calls;
    return warns;
}

static bool drift(telemetry_line_t *text, int calls)
{
    (void)calls;
    telemetry_begin(text);
    telemetry_text(text, "drift:-");
    telemetry_end(text);
    return around != NULL;
}

static bool spare(const telemetry_line_t *text, int calls)
{
    (void)calls;
    kernel_note("spare");
    if (memcmp(text->text, "drift", 5) == 0) {
        drift_lines++;
        return room;
    }
    TEST_ASSERT_EQUAL_STRING_LEN(around, text->text, strlen(around));
    around_lines = (uint16_t)(around_lines + (room ? 1U : 0U));
    return room;
}

static bool streaming;

static bool stream_on(int calls)
{
    (void)calls;
    return streaming;
}

void setUp(void)
{
    kernel_reset();
    lines = beams_lines = 0U;
    (void)memset(&line, 0, sizeof line);
    (void)memset(&laser, 0, sizeof laser);
    flight.height_mm = 598.4F;
    laser.status = URG_OK;
    flight.thrust_n = 7.123F;
    flight.reference_m = 0.6F;
    flight.state = FLIGHT_FLYING;
    flight.flags = 0U;
    laser_server_read_Stub(laser_read);
    flight_status_server_read_Stub(flight_read);
    xbee_port_report_Stub(report);
    surroundings_line_Stub(surroundings);
    surroundings_warn_Stub(warn);
    surroundings_drift_Stub(drift);
    warns = false;
    drift_lines = 0U;
    xbee_port_spare_Stub(spare);
    around = NULL;
    around_lines = 0U;
    room = true;
    pulse_stream_on_Stub(stream_on);
    streaming = false;
    boot_cause_Stub(boot);
    bsp_time_us_IgnoreAndReturn(4711U);
    jobs_reset();
    cause = NULL;
    more_ticks = 0U;
    task_send_comm_create();
}

void tearDown(void)
{
    kernel_check();
}

static void assert_line(const char *expected)
{
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL_UINT16(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

void test_create_makes_a_binary_tick_every_200_ms_and_one_task_of_priority_2(void)
{
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    TEST_ASSERT_EQUAL(Semaphore_Mode_BINARY, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.clock.created);
    TEST_ASSERT_EQUAL_UINT(200, kernel.clock.timeout);
    TEST_ASSERT_EQUAL_UINT32(200, kernel.clock.params.period);
    TEST_ASSERT_TRUE(kernel.clock.params.startFlag);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskSendComm", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(2, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1152, kernel.task.params.stackSize);
}

void test_nothing_is_sent_before_the_first_tick(void)
{
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("pend ", kernel.notes);
}

void test_each_tick_sends_one_line(void)
{
    for (uint16_t n = 1; n <= 3U; n++) {
        kernel.clock.function(kernel.clock.params.arg);
        kernel_run_task();
        TEST_ASSERT_EQUAL_UINT16(n, lines);
    }
    TEST_ASSERT_EQUAL_STRING("pend report pend pend report pend pend report pend ", kernel.notes);
}

void test_what_stands_around_comes_behind_each_line_and_gives_way_to_lists(void)
{
    around = "w:-z-B";
    for (uint16_t n = 0; n < 5U; n++) {
        kernel.clock.function(kernel.clock.params.arg);
        kernel_run_task();
        room = n < 2U;
    }
    TEST_ASSERT_EQUAL_UINT16(5, lines);
    TEST_ASSERT_EQUAL_UINT16(1, beams_lines);
    TEST_ASSERT_EQUAL_UINT16(3, around_lines);
    TEST_ASSERT_EQUAL_UINT16(1, drift_lines);
    TEST_ASSERT_EQUAL_STRING_LEN("pend report spare pend ", kernel.notes, 23);
}

void test_a_warning_goes_as_telemetry_does_and_not_behind_a_list(void)
{
    around = "w:-z-B near:90,120,50";
    warns = true;
    room = false;
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("pend report report pend ", kernel.notes);
    TEST_ASSERT_EQUAL_STRING_LEN(around, line.text, strlen(around));
}

void test_the_line_stays_away_while_the_pulses_are_streamed(void)
{
    streaming = true;
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(0, lines);
    streaming = false;
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, lines);
}

void test_ticks_that_a_late_task_missed_are_not_made_up_for(void)
{
    kernel.clock.function(kernel.clock.params.arg);
    kernel.clock.function(kernel.clock.params.arg);
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, lines);
}

void test_the_line_says_what_the_servers_hold(void)
{
    assert_line("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n");
}

void test_without_a_fresh_height_the_altitude_is_a_dash(void)
{
    flight.flags = FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_LINK;
    flight.state = FLIGHT_COASTING;
    laser.status = URG_LOST;
    assert_line("alt:- ref:0.600 laser:LOST thr:7.12 state:COASTING flags:17\r\n");
}

void test_flags_other_than_the_heights_leave_the_altitude(void)
{
    flight.flags = FLIGHT_FLAG_ATTITUDE | FLIGHT_FLAG_DISAGREE | FLIGHT_FLAG_TOO_HIGH | FLIGHT_FLAG_LINK;
    flight.height_mm = -12.0F;
    assert_line("alt:-0.012 ref:0.600 laser:OK thr:7.12 state:FLYING flags:30\r\n");
}

void test_every_laser_status_and_every_state_is_told_by_its_name_and_fits_the_packet(void)
{
    flight.height_mm = -4999.0F;
    flight.reference_m = 3.0F;
    flight.thrust_n = 11.76F;
    flight.flags = 30U;
    for (uint16_t status = 0; status < URG_STATUS_COUNT; status++) {
        for (uint16_t state = 0; state < FLIGHT_STATE_COUNT; state++) {
            char expected[TELEMETRY_LINE_MAX + 1U] = "alt:-4.999 ref:3.000 laser:";

            laser.status = (urg_status_t)status;
            flight.state = (flight_state_t)state;
            (void)strcat(strcat(expected, urg_status_name(laser.status)), " thr:11.76 state:");
            (void)strcat(strcat(expected, flight_state_name(flight.state)), " flags:30\r\n");
            assert_line(expected);
        }
    }
}

static void run(uint16_t ticks)
{
    more_ticks = (uint16_t)(ticks - 1U);
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(ticks, lines);
}

void test_the_first_line_alone_tells_the_cause_of_the_reset(void)
{
    cause = "WATCHDOG";
    run(1U);
    TEST_ASSERT_EQUAL_STRING_LEN(
        "alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 reset:WATCHDOG\r\n", line.text,
        line.length);
    lines = 0U;
    run(2U);
    TEST_ASSERT_EQUAL_STRING_LEN("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n", line.text,
                                 line.length);
    lines = 0U;
    run(9U);
    TEST_ASSERT_EQUAL_STRING_LEN("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n", line.text,
                                 line.length);
}

/* The first of them says what the second says; the fifth has something to add. */
void test_each_second_a_line_tells_the_beams(void)
{
    const char expected[] = "mf:35,612,9,71,- m1:- m2:- out:-\r\n";

    flight.signal = (scan_signal_t){.scans = 1U, .arrival_us = 4711U};
    flight.signal.beams[MIRROR_FRONT] = (beam_signal_t){true, true, 35U, 612.0F, 9.0F, 70500U};
    flight.lies[MIRROR_FRONT] = NAN;
    run(4U);
    TEST_ASSERT_EQUAL_UINT16(0U, beams_lines);
    lines = 0U;
    run(1U);
    TEST_ASSERT_EQUAL_UINT16(1U, beams_lines);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, beams.text, sizeof expected - 1U);
    TEST_ASSERT_EQUAL_UINT16(sizeof expected - 1U, beams.length);
    lines = 0U;
    run(10U);
    TEST_ASSERT_EQUAL_UINT16(3U, beams_lines);
}

void test_every_job_is_measured_from_the_tick_that_released_it(void)
{
    run(3U);
    jobs_assert(MONITOR_SEND_COMM, 3U);
    TEST_ASSERT_EQUAL_UINT16(3, jobs[MONITOR_SEND_COMM].released);
    TEST_ASSERT_EQUAL_UINT32(4711, jobs[MONITOR_SEND_COMM].released_us);
}

static bool line_has(const char *word)
{
    char text[sizeof line.text + 1U];

    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    (void)memcpy(text, line.text, line.length);
    text[line.length] = '\0';
    return strstr(text, word) != NULL;
}

void test_a_doubt_is_told_but_in_the_first_line_after_a_reset(void)
{
    cause = "WATCHDOG";
    flight.reason = VERDICT_ALONE;
    TEST_ASSERT_FALSE(line_has("doubt:"));
    more_ticks = 1U;
    TEST_ASSERT_TRUE(line_has(" doubt:IMU/alone\r\n"));
    cause = NULL;
    TEST_ASSERT_TRUE(line_has(" doubt:IMU/alone\r\n"));
    flight.reason = VERDICT_NONE;
    TEST_ASSERT_FALSE(line_has("doubt:"));
}

void test_a_limit_is_told_off_the_ground_while_nothing_is_doubted(void)
{
    flight.state = FLIGHT_FLYING;
    TEST_ASSERT_FALSE(line_has("limit:"));
    flight.bound = BOUND_CLIMB;
    TEST_ASSERT_TRUE(line_has(" limit:CLIMB\r\n"));
    flight.reason = VERDICT_BLIND;
    TEST_ASSERT_TRUE(line_has("flags:0 doubt:SIGHT/blind\r\n"));
    flight.reason = VERDICT_NONE;
    flight.state = FLIGHT_GROUND; /* the idle is one, too */
    TEST_ASSERT_FALSE(line_has("limit:"));
}

void test_without_a_battery_the_line_has_none(void)
{
    TEST_ASSERT_FALSE(line_has("bat:"));
    flight.battery_v = 14.8F;
    TEST_ASSERT_FALSE(line_has("bat:"));
}

void test_the_battery_is_told_behind_all_others_where_it_fits(void)
{
    (void)line_has(""); /* the first after a reset tells its cause */
    flight = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    flight.state = FLIGHT_FLYING;
    flight.battery = BATTERY_GOOD;
    flight.battery_v = 14.83F;
    TEST_ASSERT_TRUE(line_has("flags:0 bat:14.8\r\n"));
    flight.bound = BOUND_CLIMB;
    TEST_ASSERT_TRUE(line_has(" limit:CLIMB bat:14.8\r\n"));
    flight.reason = VERDICT_NO_EFFECT;
    flight.state = FLIGHT_DESCENDING;
    flight.flags = 1280U;
    flight.height_mm = -1234.0F;
    flight.reference_m = flight.thrust_n = 3.0F;
    TEST_ASSERT_TRUE(line_has(" doubt:THRUST/noeffect\r\n") ||
                     line_has(" doubt:THRUST/noeffect bat:14.8\r\n"));
}

void test_a_battery_that_warns_has_the_place_of_a_limit_and_takes_turns_with_a_doubt(void)
{
    (void)line_has("");
    flight = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    flight.state = FLIGHT_FLYING;
    flight.battery = BATTERY_LOW;
    flight.battery_v = 14.13F;
    flight.bound = BOUND_CLIMB;
    TEST_ASSERT_TRUE(line_has("flags:0 bat:14.1/LOW\r\n"));
    flight.reason = VERDICT_ALONE;
    bool doubt = false, alone = false;
    for (int i = 0; i < 2; i++) {
        const bool told = line_has(" doubt:IMU/alone bat:14.1/LOW\r\n");
        doubt = doubt || told;
        alone = alone || !told;
    }
    TEST_ASSERT_TRUE(doubt && alone);
}

void test_a_battery_that_tells_nothing_is_a_dash(void)
{
    (void)line_has("");
    flight = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    flight.battery = BATTERY_ABSENT;
    flight.battery_v = NAN;
    TEST_ASSERT_TRUE(line_has("flags:0 bat:-/ABSENT\r\n"));
}
