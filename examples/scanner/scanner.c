/* The scanner's driver in an application of its own: no operating system, no heap, one loop. From whatever
 * state the sensor is in it is brought to stream, and after any loss again; each scan's mean distance
 * straight ahead is shown. board.h is all that it needs of a machine. */
#include <plomada/scip_layout.h>
#include <plomada/urg.h>

#include "board.h"

#ifndef STREAM_RATE
#define STREAM_RATE 115200U /* up to 750000 where the line allows it */
#endif
#define FIRST_STEP 367U /* 384 is straight ahead; 1024 steps make a turn */
#define LAST_STEP 401U
#define POINTS (LAST_STEP - FIRST_STEP + 1U)

static const urg_config_t config = {
    .wait_us = 0U,        /* it may boot still: the search finds it as soon as it listens */
    .first_rate = 19200U, /* as delivered */
    .stream_rate = STREAM_RATE,
    .stream = SCIP_STREAM_2,
    .range = {.first_step = FIRST_STEP, .last_step = LAST_STEP, .cluster = 1U, .interval = 0U, .scans = 0U},
};

static urg_driver_t urg;
static uint16_t points[2U * POINTS]; /* two scans: one is used while the next comes in */
static uint32_t stepped_us;

static void use_scan(void)
{
    const scip_group_t ahead = {FIRST_STEP, LAST_STEP};
    scip_scan_t scan;

    if (urg_take_scan(&urg, &scan)) {
        const scip_group_mean_t mean = scip_group_mean(&scan, &ahead);
        board_show(mean.valid, (uint16_t)(mean.mean_mm + 0.5F));
    }
}

static void receive(void)
{
    octet_t octets[32];
    const size_t count = board_uart_read(octets, sizeof octets / sizeof octets[0]);
    const uint32_t errors = board_uart_errors();

    if (errors > 0U) {
        urg_line_broken(&urg, errors);
    }
    if (urg_feed(&urg, octets, count)) {
        urg_scan_at(&urg, board_time_us());
        use_scan();
    }
}

static void send(void)
{
    urg_output_t output;

    if (!urg_next_to_send(&urg, &output)) {
        return;
    }
    if (output.cycle_power) {
        board_cycle_sensor_power();
    }
    if (output.set_rate) {
        board_uart_open(output.rate);
    }
    board_uart_write(output.octets, output.count);
}

const char *scanner_run(void)
{
    const urg_refusal_t refusal = urg_refusal(&config, 2U * POINTS);

    if (refusal != URG_ACCEPTED) {
        return urg_refusal_text(refusal);
    }
    (void)urg_init(&urg, &config, points, 2U * POINTS, board_time_us());
    board_uart_open(config.first_rate);
    stepped_us = board_time_us();
    while (board_runs()) {
        receive();
        if (board_time_us() - stepped_us >= urg_pause_us(&urg)) {
            stepped_us = board_time_us();
            urg_step(&urg, stepped_us);
            send();
        }
    }
    return NULL;
}
