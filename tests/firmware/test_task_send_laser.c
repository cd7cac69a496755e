/* TaskSendLaser: the driver's step, and what is told of it. */
#include "firmware/tasks.h"

#include <string.h>

#include "firmware/geometry.h"
#include "jobs.h"
#include "kernel.h"
#include "mock_alive.h"
#include "mock_laser_port.h"
#include "mock_led.h"
#include "mock_servers.h"
#include "mock_timebase.h"
#include "unity.h"

#define PERIOD_US 150000U
#define TICK_US 10000U

static uint32_t now_us;
static laser_statistics_t receiving; /* as the port's step has it */
static laser_sample_t laser;         /* as published */
static bool blue, red;
static uint16_t writes;
static uint16_t alive_reports;

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

static void step(laser_statistics_t *statistics, int calls)
{
    (void)calls;
    kernel_note("step");
    *statistics = receiving;
}

static scip_range_t ordered;

static void order(const scip_range_t *range, int calls)
{
    (void)calls;
    kernel_note("order");
    ordered = *range;
}

static void mount(control_layout_t layout)
{
    parameters_t parameters;

    parameters_init(&parameters);
    parameters.value[PARAMETER_LAYOUT] = (float)layout;
    geometry_mount(&parameters);
}

static void publish(const laser_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note(urg_status_name(sample->status));
    laser = *sample;
    writes++;
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

static uint32_t pause_us(int calls)
{
    (void)calls;
    return receiving.urg.pause_us;
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
    receiving.urg.pause_us = PERIOD_US;
    writes = 0U;
    blue = red = false;
    bsp_time_us_Stub(time_us);
    laser_port_step_Stub(step);
    laser_port_order_Stub(order);
    mount(LAYOUT_FRONT);
    laser_port_pause_us_Stub(pause_us);
    laser_server_write_Stub(publish);
    bsp_led_blue_Stub(led_blue);
    bsp_led_red_Stub(led_red);
    alive_report_Stub(alive);
    alive_reports = 0U;
    jobs_reset();
    task_send_laser_create();
}

void tearDown(void)
{
    kernel_check();
}

static void clock_ticks(uint16_t count)
{
    while (count-- > 0U) {
        now_us += TICK_US;
        kernel.clock.function(kernel.clock.params.arg);
    }
}

static void tick(void)
{
    kernel.notes[0] = '\0';
    clock_ticks(15U);
    kernel_run_task();
}

static void ticks(uint16_t count)
{
    while (count-- > 0U) {
        tick();
    }
}

void test_create_makes_a_binary_semaphore_a_clock_of_10_ms_and_one_task_of_priority_3(void)
{
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    TEST_ASSERT_EQUAL(Semaphore_Mode_BINARY, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.clock.created);
    TEST_ASSERT_EQUAL_UINT(10, kernel.clock.timeout);
    TEST_ASSERT_EQUAL_UINT32(10, kernel.clock.params.period);
    TEST_ASSERT_TRUE(kernel.clock.params.startFlag);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskSendLaser", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(3, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1152, kernel.task.params.stackSize);
}

void test_nothing_happens_before_150_ms(void)
{
    clock_ticks(14U);
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("pend ", kernel.notes);
}

void test_each_tick_steps_and_publishes_once(void)
{
    tick();
    TEST_ASSERT_EQUAL_STRING("pend order step WAIT pend ", kernel.notes);
    receiving.urg.status = URG_STOP1;
    tick();
    TEST_ASSERT_EQUAL_STRING("pend order step STOP1 pend ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT16(2, writes);
}

void test_the_rays_are_those_of_the_layout_at_each_step(void)
{
    tick();
    TEST_ASSERT_EQUAL_UINT16(372, ordered.first_step);
    TEST_ASSERT_EQUAL_UINT16(406, ordered.last_step);
    TEST_ASSERT_EQUAL_UINT16(1, ordered.cluster);
    mount(LAYOUT_THREE);
    tick();
    TEST_ASSERT_EQUAL_UINT16(111, ordered.first_step);
    TEST_ASSERT_EQUAL_UINT16(654, ordered.last_step);
    TEST_ASSERT_EQUAL_UINT16(4, ordered.cluster);
}

void test_ticks_that_a_late_task_missed_are_not_made_up_for(void)
{
    clock_ticks(30U);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, writes);
}

/* Up to the next tick of the clock. */
static void assert_next_step_after(uint16_t count)
{
    const uint16_t before = writes;

    clock_ticks((uint16_t)(count - 1U));
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(before, writes);
    clock_ticks(1U);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(before + 1U, writes);
}

void test_a_step_comes_earlier_while_the_driver_asks_for_it(void)
{
    tick();
    assert_next_step_after(15U);
    receiving.urg.pause_us = 40000U;
    assert_next_step_after(4U);
    assert_next_step_after(4U);
    receiving.urg.pause_us = 40001U;
    assert_next_step_after(5U);
    receiving.urg.pause_us = PERIOD_US;
    clock_ticks(9U);
    kernel_run_task();
    receiving.urg.pause_us = 100000U; /* as soon as it is wanted */
    assert_next_step_after(1U);
    receiving.urg.pause_us = 10U * PERIOD_US;
    assert_next_step_after(15U);
}

void test_a_late_step_does_not_shift_the_150_ms(void)
{
    tick();
    clock_ticks(15U);
    clock_ticks(3U);
    kernel_run_task();
    assert_next_step_after(12U);
}

void test_the_blue_light_blinks_until_scans_arrive_and_then_stays_on(void)
{
    for (int status = URG_WAIT; status < URG_STATUS_COUNT; status++) {
        receiving.urg.status = (urg_status_t)status;
        tick();
        for (uint16_t n = 0; n < 5U; n++) {
            const bool last = blue;

            tick();
            TEST_ASSERT_EQUAL(status == URG_OK || !last, blue);
        }
    }
}

void test_the_red_light_tells_that_the_sensor_is_lost(void)
{
    for (int status = URG_WAIT; status < URG_STATUS_COUNT; status++) {
        receiving.urg.status = (urg_status_t)status;
        tick();
        TEST_ASSERT_EQUAL(status == URG_LOST, red);
    }
}

void test_what_is_published_is_the_drivers_state_at_that_tick(void)
{
    receiving.urg = (urg_report_t){.status = URG_LOST,
                                   .rate = 57600U,
                                   .first_rate = 19200U,
                                   .first_rate_known = true,
                                   .restarts = 3U,
                                   .timeouts = 4U,
                                   .seen = {.scan_count = 5U, .octet_count = 6U, .damage_count = 7U}};
    tick();
    TEST_ASSERT_EQUAL(URG_LOST, laser.status);
    TEST_ASSERT_EQUAL_UINT32(57600, laser.rate);
    TEST_ASSERT_EQUAL_UINT32(19200, laser.power_up_rate);
    TEST_ASSERT_EQUAL_UINT32(3, laser.restarts);
    TEST_ASSERT_EQUAL_UINT32(4, laser.timeouts);
    TEST_ASSERT_EQUAL_MEMORY(&receiving.urg.seen, &laser.seen, sizeof laser.seen);
    receiving.urg.first_rate_known = false;
    tick();
    TEST_ASSERT_EQUAL_UINT32(0, laser.power_up_rate);
}

void test_every_complete_cycle_is_a_sign_of_life(void)
{
    ticks(200U);
    TEST_ASSERT_EQUAL_UINT16(200U, alive_reports);
}

void test_every_job_is_measured_from_the_tick_that_released_it(void)
{
    ticks(4U);
    jobs_assert(MONITOR_SEND_LASER, 4U);
    TEST_ASSERT_EQUAL_UINT16(4, jobs[MONITOR_SEND_LASER].released);
    TEST_ASSERT_EQUAL_UINT32(now_us, jobs[MONITOR_SEND_LASER].released_us);
}
