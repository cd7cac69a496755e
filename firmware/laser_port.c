#include "firmware/laser_port.h"

#include <stddef.h>
#include <string.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <xdc/std.h>

#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "bsp/timebase.h"
#include "firmware/uart_port.h"

/* Written by the receive Hwi. The parser fills one of two scans while the other, complete, waits for
 * Laser_SWI. */
static scip_parser_t parser;
static uint16_t points[2][SCIP_LAYOUT_POINTS_MAX];
static scip_scan_t scans[2];
static uint16_t filling;
static uint32_t scan_arrival_us;
static urg_seen_t seen;
static uint32_t overruns;
static uint32_t rate;

static laser_message_t mailbox; /* written by Laser_SWI, read by TaskReceiveLaser with Swis off */
static Swi_Handle laser_swi;
static Semaphore_Handle laser_ready;

static void scan_done(void)
{
    scan_arrival_us = bsp_time_us();
    monitor_released(MONITOR_RECEIVE_LASER, scan_arrival_us);
    filling ^= 1U;
    scip_parser_scan_into(&parser, &scans[filling]);
    Swi_post(laser_swi);
}

static void note(scip_event_t event)
{
    urg_seen_event(&seen, &parser, event);
    if (event == SCIP_SCAN) {
        scan_done();
    }
}

static void note_errors(const bsp_uart_burst_t *burst)
{
    if (burst->framing || burst->overrun) {
        scip_parser_line_broken(&parser);
        seen.framing_count += burst->framing ? 1U : 0U;
        overruns += burst->overrun ? 1U : 0U;
    }
}

static void feed(const bsp_uart_burst_t *burst)
{
    octet_t run[BSP_UART_FIFO_DEPTH];
    size_t taken = 0U;
    uint16_t i;

    for (i = 0U; i < burst->count; i++) {
        run[i] = octet_of(burst->octets[i]);
    }
    urg_seen_octets(&seen, run, burst->count);
    while (taken < burst->count) {
        scip_event_t event;

        taken += scip_parser_feed_run(&parser, &run[taken], burst->count - taken, &event);
        note(event);
    }
}

/* The last octet of a scan makes an interrupt; where the end is not known, the tick is soon enough. */
static uint16_t received(const bsp_uart_burst_t *burst)
{
    uint16_t expected;

    note_errors(burst);
    feed(burst);
    expected = scip_parser_expected(&parser);
    return (expected > 0U) ? expected : (uint16_t)UART_PORT_BURST;
}

static Void laser_swi_run(UArg unused0, UArg unused1)
{
    UInt key = Hwi_disable();
    const scip_scan_t *done = &scans[filling ^ 1U];

    (void)unused0;
    (void)unused1;
    mailbox.arrival_us = scan_arrival_us;
    mailbox.bit_rate = rate;
    Hwi_restore(key);
    mailbox.scan = *done;
    (void)memcpy(mailbox.distance_mm, done->distance_mm, done->points * sizeof done->distance_mm[0]);
    Semaphore_post(laser_ready);
}

void laser_port_create(uint32_t bit_rate)
{
    Swi_Params swi;
    Semaphore_Params semaphore;
    uint16_t i;

    rate = bit_rate;
    scip_parser_init(&parser);
    for (i = 0U; i < 2U; i++) {
        scans[i].distance_mm = points[i];
        scans[i].capacity = SCIP_LAYOUT_POINTS_MAX;
    }
    scip_parser_scan_into(&parser, &scans[filling]);
    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    laser_ready = Semaphore_create(0, &semaphore, NULL);
    Swi_Params_init(&swi);
    swi.instance->name = "Laser_SWI";
    swi.priority = LASER_SWI_PRIORITY;
    laser_swi = Swi_create(laser_swi_run, &swi, NULL);
    uart_port_create(BSP_UART_LASER, bit_rate, received);
}

void laser_port_wait(laser_message_t *message)
{
    UInt key;

    (void)Semaphore_pend(laser_ready, BIOS_WAIT_FOREVER);
    key = Swi_disable();
    *message = mailbox;
    Swi_restore(key);
    message->scan.distance_mm = message->distance_mm;
}

void laser_port_statistics(laser_statistics_t *statistics)
{
    UInt key = Hwi_disable();

    statistics->seen = seen;
    statistics->scip = parser.counters;
    statistics->last_damage = parser.last_damage;
    statistics->overruns = overruns;
    Hwi_restore(key);
}

void laser_port_set_rate(uint32_t bit_rate)
{
    UInt key = Hwi_disable();

    scip_parser_line_broken(&parser);
    rate = bit_rate;
    Hwi_restore(key);
    uart_port_reopen(BSP_UART_LASER, bit_rate);
}

void laser_port_expect(const scip_request_t *request)
{
    UInt key = Hwi_disable();

    scip_parser_expect(&parser, request);
    Hwi_restore(key);
}

void laser_port_send(const scip_request_t *request)
{
    char text[SCIP_REQUEST_MAX];
    uint16_t i;

    for (i = 0U; i < request->text_length; i++) {
        text[i] = (char)request->text[i];
    }
    (void)uart_port_send(BSP_UART_LASER, text, request->text_length);
}
