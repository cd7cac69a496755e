/* From power-up to scans: what passes on the scanner's wire, and when. */
#include <stdio.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/driverlib.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    double power_up_rate;
    double streaming_s, ready_s;
    double sensor_rate, host_rate;
    unsigned commands;
    float height_mm;
    double pulse_us;
    const char *halt;
} start_t;

static void start(void *argument, void *result)
{
    start_t *s = result;
    board_config_t config = board_config(3);

    config.laser.power_up_rate = *(const double *)argument;
    board_power_on(&config, NULL, NULL);
    while (timeline_now() < 40 * SIM_S && s->ready_s == 0.0 && kernel_run_until(timeline_now() + SIM_MS)) {
        double now_s = (double)timeline_now() * 1e-9;

        s->streaming_s = s->streaming_s == 0.0 && urg04lx_state(board_laser()).streaming ? now_s
                                                                                         : s->streaming_s;
        s->ready_s = probe_altitude->sequence > 0U && probe_imu->ready ? now_s : 0.0;
    }
    kernel_run_until(timeline_now() + SIM_S);
    s->sensor_rate = urg04lx_state(board_laser()).rate;
    s->host_rate = chip_sci_rate(SCIA_BASE);
    s->commands = urg04lx_state(board_laser()).commands;
    s->height_mm = probe_altitude->altitude.height_mm;
    s->pulse_us = board_pulse_us();
    s->halt = kernel_halt_reason();
}

static start_t run(double power_up_rate)
{
    start_t s = {0};

    child_run(start, &power_up_rate, &s, sizeof s);
    TEST_ASSERT_NULL(s.halt);
    return s;
}

void test_the_scanner_streams_at_250000_soon_after_its_ten_second_wait(void)
{
    start_t s = run(115200.0);

    printf("streaming after %.3f s, first height after %.3f s\n", s.streaming_s, s.ready_s);
    TEST_ASSERT_TRUE(s.streaming_s > 10.0 && s.streaming_s < 12.5);
    TEST_ASSERT_TRUE(s.ready_s > s.streaming_s && s.ready_s < s.streaming_s + 0.5);
    TEST_ASSERT_EQUAL_DOUBLE(250000.0, s.sensor_rate);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 250000.0, s.host_rate);
    TEST_ASSERT_INT_WITHIN(1, 5, (int)s.commands);
}

void test_on_the_floor_the_height_is_zero_and_the_pulse_idle(void)
{
    start_t s = run(115200.0);

    TEST_ASSERT_FLOAT_WITHIN(12.0F, 0.0F, s.height_mm);
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 1999.68, s.pulse_us);
}

void test_a_sensor_at_the_factory_rate_is_found_too(void)
{
    start_t s = run(19200.0);

    printf("streaming after %.3f s\n", s.streaming_s);
    TEST_ASSERT_TRUE(s.streaming_s > 10.0 && s.streaming_s < 25.0);
    TEST_ASSERT_EQUAL_DOUBLE(250000.0, s.sensor_rate);
}
