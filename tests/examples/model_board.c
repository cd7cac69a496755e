/* The board of examples/scanner/scanner.c: the model of a URG-04LX as delivered (19200 bps, SCIP1.1) on a
 * virtual UART, in front of a wall that comes nearer; after 15 s the cable is out for two seconds. Ends after
 * 20 s. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "board.h"
#include "sim/devices/serial.h"
#include "sim/devices/urg04lx.h"
#include "sim/timeline.h"

#define POLL SIM_MS
#define END (20 * SIM_S)
#define CABLE_OUT (15 * SIM_S)
#define CABLE_IN (17 * SIM_S)

static urg04lx_t *sensor;
static serial_t transmitter;
static double rate;
static unsigned char fifo[4096];
static size_t fifo_n;
static uint32_t errors;
static unsigned shown, wrong;

static double wall_mm(sim_time_t when)
{
    return 2000.0 - 50.0 * (double)when / 1e9;
}

static void look(void *context, const urg_rays_t *rays, int *distance_mm)
{
    (void)context;
    for (int step = rays->from_step; step <= rays->to_step; step++) {
        distance_mm[step - rays->from_step] = (int)wall_mm(timeline_now());
    }
}

static bool cable(void)
{
    return timeline_now() < CABLE_OUT || timeline_now() >= CABLE_IN;
}

static void to_board(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    if (!cable()) {
        return;
    }
    if (fabs(bit_ns * rate / 1e9 - 1.0) > 0.045) {
        errors++;
    } else if (fifo_n < sizeof fifo) {
        fifo[fifo_n++] = (unsigned char)octet;
    }
}

static void to_sensor(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    if (cable()) {
        urg04lx_receive(sensor, octet, bit_ns);
    }
}

static void begin(void)
{
    urg04lx_config_t config = urg04lx_default;

    config.power_up_rate = 19200;
    sensor = urg04lx_create(&config, look, NULL, to_board, NULL);
    serial_init(&transmitter, 19200, to_sensor, NULL);
    urg04lx_power(sensor, true);
}

uint32_t board_time_us(void)
{
    return (uint32_t)(timeline_now() / SIM_US);
}

void board_uart_open(uint32_t bit_rate)
{
    if (sensor == NULL) {
        begin();
    }
    rate = bit_rate;
    fifo_n = 0;
    serial_set_rate(&transmitter, bit_rate);
}

size_t board_uart_read(octet_t *octets, size_t most)
{
    const size_t count = fifo_n < most ? fifo_n : most;

    for (size_t i = 0; i < count; i++) {
        octets[i] = fifo[i];
    }
    for (size_t i = count; i < fifo_n; i++) {
        fifo[i - count] = fifo[i];
    }
    fifo_n -= count;
    return count;
}

void board_uart_write(const octet_t *octets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        serial_send(&transmitter, &(unsigned char){(unsigned char)octets[i]}, 1);
    }
}

uint32_t board_uart_errors(void)
{
    const uint32_t seen = errors;

    errors = 0;
    return seen;
}

void board_cycle_sensor_power(void) {}

void board_show(bool valid, uint16_t distance_mm)
{
    const double seen_from_s = (double)timeline_now() / 1e9;

    wrong += !valid || fabs(distance_mm - wall_mm(timeline_now() - 80 * SIM_MS)) > 5.0;
    if (shown % 20 == 0) {
        printf("%5.1f s: %u mm\n", seen_from_s, distance_mm);
    }
    shown++;
}

bool board_runs(void)
{
    const sim_time_t until = timeline_now() + POLL;

    while (timeline_next() <= until) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(until);
    if (until < END) {
        return true;
    }
    printf("%u scans, %u wrong\n", shown, wrong);
    urg04lx_destroy(sensor);
    if (shown < 60 || wrong > 0) {
        exit(1);
    }
    return false;
}

int main(void)
{
    return scanner_run() == NULL ? 0 : 1;
}
