/* TaskSendLaser with the real state machine, against a sensor that answers as the receiving side would report
 * it. */
#include "firmware/tasks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_alive.h"
#include "mock_laser_port.h"
#include "mock_led.h"
#include "mock_servers.h"
#include "mock_timebase.h"
#include "unity.h"

#define PERIOD_US 150000U
#define TICKS_OF_WAIT 67U /* 10 s */

static const urg_config_t config = {
    .wait_us = 10000000U,
    .first_rate = 115200U,
    .stream_rate = 250000U,
    .fastest_rate = 250000U,
    .stream = SCIP_STREAM_2,
    .range = {.first_step = 372U, .last_step = 406U, .cluster = 1U},
};

static uint32_t now_us;
static laser_statistics_t receiving;
static laser_sample_t laser; /* as published */
static bool blue, red;
static uint16_t writes;
static uint16_t alive_reports;
static bool sensor_answers;
static bool sensor_streams;
static bool streaming;

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

static void look(laser_statistics_t *statistics, int calls)
{
    (void)calls;
    kernel_note("look");
    *statistics = receiving;
}

static void publish(const laser_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note(urg_status_name(sample->status));
    laser = *sample;
    writes++;
}

static void set_rate(uint32_t bit_rate, int calls)
{
    char word[16];

    (void)calls;
    (void)snprintf(word, sizeof word, "rate=%lu", (unsigned long)bit_rate);
    kernel_note(word);
}

static uint16_t awaited;

static void expect(const scip_request_t *request, int calls)
{
    (void)request;
    (void)calls;
    awaited++;
}

/* The reply is in by the next tick. */
static void send(const scip_request_t *request, int calls)
{
    char word[SCIP_REQUEST_MAX + 1U];
    uint16_t length = 0;

    (void)calls;
    for (uint16_t i = 0; i < request->text_length; i++) {
        if (request->text[i] != SCIP_LINE_FEED) {
            word[length++] = (char)request->text[i];
        }
    }
    word[length] = '\0';
    kernel_note(word);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, awaited, "sent before its reply is awaited");
    awaited = 0;
    if (sensor_answers) {
        receiving.seen.reply_count++;
        receiving.seen.octet_count += 10U;
        receiving.seen.reply_kind = request->kind;
        receiving.seen.reply = (scip_reply_t){.status = {'0', '0'}};
        if (request->kind == SCIP_LASER_OFF_1 || request->kind == SCIP_SWITCH) {
            receiving.seen.reply = (scip_reply_t){.status = {'0', 0}, .legacy = true};
        }
        streaming = sensor_streams && request->kind == SCIP_STREAM_2;
    }
}

static void led_blue(bool on, int calls)
{
    (void)calls;
    blue = on;
}

static void led_red(bool on, int calls)
{
    (void)calls;
    red = on;
}

static void alive(alive_t task, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(ALIVE_SEND_LASER, task);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(alive_reports + 1U, writes, "alive before the cycle was complete");
    alive_reports++;
}

void setUp(void)
{
    kernel_reset();
    now_us = 0xFFF00000U; /* wraps soon */
    (void)memset(&laser, 0, sizeof laser);
    (void)memset(&receiving, 0, sizeof receiving);
    writes = 0U;
    blue = red = false;
    sensor_answers = sensor_streams = true;
    streaming = false;
    awaited = 0;
    bsp_time_us_Stub(time_us);
    laser_port_statistics_Stub(look);
    laser_server_write_Stub(publish);
    laser_port_set_rate_Stub(set_rate);
    laser_port_expect_Stub(expect);
    laser_port_send_Stub(send);
    bsp_led_blue_Stub(led_blue);
    bsp_led_red_Stub(led_red);
    alive_report_Stub(alive);
    alive_reports = 0U;
    jobs_reset();
    task_send_laser_create(&config);
}

void tearDown(void)
{
    kernel_check();
}

static void tick(void)
{
    now_us += PERIOD_US;
    if (streaming) {
        receiving.seen.scan_count += 1U;
        receiving.seen.octet_count += 101U;
    }
    kernel.notes[0] = '\0';
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
}

static void ticks(uint16_t count)
{
    while (count-- > 0U) {
        tick();
    }
}

static void until(urg_status_t status, uint16_t at_most)
{
    while (laser.status != status) {
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, at_most--, urg_status_name(laser.status));
        tick();
    }
}

void test_create_makes_a_binary_tick_every_150_ms_and_one_task_of_priority_3(void)
{
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    TEST_ASSERT_EQUAL(Semaphore_Mode_BINARY, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.clock.created);
    TEST_ASSERT_EQUAL_UINT(150, kernel.clock.timeout);
    TEST_ASSERT_EQUAL_UINT32(150, kernel.clock.params.period);
    TEST_ASSERT_TRUE(kernel.clock.params.startFlag);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskSendLaser", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(3, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1024, kernel.task.params.stackSize);
}

void test_nothing_happens_before_the_first_tick(void)
{
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("pend ", kernel.notes);
}

void test_each_tick_looks_steps_and_publishes_once(void)
{
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look WAIT pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look WAIT pend ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT16(2, writes);
}

void test_ticks_that_a_late_task_missed_are_not_made_up_for(void)
{
    kernel.clock.function(kernel.clock.params.arg);
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, writes);
}

void test_the_sensor_is_left_alone_for_ten_seconds_and_then_taken_through_its_start_up(void)
{
    for (uint16_t n = 1; n < TICKS_OF_WAIT; n++) {
        tick();
        TEST_ASSERT_EQUAL_STRING("pend look WAIT pend ", kernel.notes);
    }
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look L0 STOP1 pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look SCIP2.0 SWITCH pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look SS250000 RATE pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look RATE pend ", kernel.notes); /* the sensor's own change of rate */
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look rate=250000 QT STOP2 pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look MS0372040601000 STREAM pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look OK pend ", kernel.notes);
}

void test_a_command_is_sent_again_only_after_its_own_time_out(void)
{
    sensor_answers = false;
    ticks(TICKS_OF_WAIT);
    TEST_ASSERT_EQUAL_STRING("pend look L0 STOP1 pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look STOP1 pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look STOP1 pend ", kernel.notes);
    tick();
    TEST_ASSERT_EQUAL_STRING("pend look L0 STOP1 pend ", kernel.notes); /* 450 ms > 400 ms */
}

void test_the_blue_light_blinks_until_scans_arrive_and_then_stays_on(void)
{
    bool last;

    tick();
    for (uint16_t n = 0; n < 20U; n++) {
        last = blue;
        tick();
        TEST_ASSERT_NOT_EQUAL(last, blue);
        TEST_ASSERT_FALSE(red);
    }
    until(URG_OK, TICKS_OF_WAIT + 20U);
    for (uint16_t n = 0; n < 20U; n++) {
        TEST_ASSERT_TRUE(blue);
        TEST_ASSERT_FALSE(red);
        tick();
    }
}

void test_the_red_light_tells_that_the_sensor_is_lost_and_goes_out_when_it_is_back(void)
{
    uint16_t lit = 0;

    until(URG_OK, TICKS_OF_WAIT + 20U);
    streaming = false;
    sensor_answers = false;
    until(URG_LOST, 10U);
    for (uint16_t n = 0; n < 10U; n++) {
        TEST_ASSERT_TRUE(red);
        lit = (uint16_t)(lit + (blue ? 1U : 0U));
        tick();
    }
    TEST_ASSERT_EQUAL_UINT16(5, lit);
    sensor_answers = true;
    until(URG_OK, 60U);
    TEST_ASSERT_FALSE(red);
    TEST_ASSERT_TRUE(blue);
}

void test_what_is_published_is_the_links_state_and_what_was_seen_at_that_tick(void)
{
    until(URG_OK, TICKS_OF_WAIT + 20U);
    TEST_ASSERT_EQUAL_UINT32(250000, laser.rate);
    TEST_ASSERT_EQUAL_UINT32(0, laser.restarts);
    TEST_ASSERT_EQUAL_UINT32(0, laser.timeouts);
    TEST_ASSERT_EQUAL_MEMORY(&receiving.seen, &laser.seen, sizeof laser.seen);
    streaming = false;
    sensor_answers = false;
    until(URG_LOST, 10U);
    ticks(10U);
    TEST_ASSERT_EQUAL_UINT32(1, laser.restarts);
    TEST_ASSERT_GREATER_THAN_UINT32(0, laser.timeouts);
    TEST_ASSERT_EQUAL_MEMORY(&receiving.seen, &laser.seen, sizeof laser.seen);
}

void test_the_rate_published_is_the_one_the_own_uart_has(void)
{
    uint32_t rate = 115200U;
    const char *change;

    sensor_answers = false;
    for (uint16_t n = 0; n < 200U; n++) {
        tick();
        change = strstr(kernel.notes, "rate=");
        if (change != NULL) {
            rate = (uint32_t)strtoul(change + 5, NULL, 10);
        }
        TEST_ASSERT_EQUAL_UINT32(rate, laser.rate);
    }
    TEST_ASSERT_NOT_EQUAL(115200U, rate);
}

void test_a_rate_is_set_before_the_request_that_needs_it(void)
{
    const char *rate;
    const char *request;

    sensor_answers = false;
    ticks(TICKS_OF_WAIT);
    while (strstr(kernel.notes, "rate=") == NULL) {
        TEST_ASSERT_LESS_THAN_UINT16(100, writes);
        tick();
    }
    rate = strstr(kernel.notes, "rate=");
    request = strstr(kernel.notes, "QT");
    TEST_ASSERT_NOT_NULL(request);
    TEST_ASSERT_TRUE(rate < request);
}

void test_every_complete_cycle_is_a_sign_of_life_whether_or_not_the_sensor_answers(void)
{
    sensor_answers = false;
    ticks(3U * TICKS_OF_WAIT);
    TEST_ASSERT_EQUAL_UINT16(3U * TICKS_OF_WAIT, alive_reports);
}

void test_every_job_is_measured_from_the_tick_that_released_it(void)
{
    ticks(4U);
    jobs_assert(MONITOR_SEND_LASER, 4U);
    TEST_ASSERT_EQUAL_UINT16(4, jobs[MONITOR_SEND_LASER].released);
    TEST_ASSERT_EQUAL_UINT32(now_us, jobs[MONITOR_SEND_LASER].released_us);
}
