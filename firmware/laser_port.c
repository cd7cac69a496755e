#include "firmware/laser_port.h"

#include <stddef.h>
#include <string.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <xdc/std.h>

#include "firmware/cpu_time.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "bsp/timebase.h"
#include "firmware/uart_port.h"
#include "firmware/usb_port.h"

/* Fed by the receive Hwi; all others use it with interrupts off. */
static urg_driver_t urg;
static uint16_t points[2U * SCIP_LAYOUT_POINTS_MAX]; /* of two scans: one fills, one waits for Laser_SWI */
static uint32_t scan_arrival_us;
static uint32_t overruns;
static uint32_t rate;

static laser_message_t mailbox; /* written by Laser_SWI, read by TaskReceiveLaser with Swis off */
static Swi_Handle laser_swi;
static Semaphore_Handle laser_ready;

/* Stamped here, where the last octet is taken. Any task would stamp it with its own delay in it, and
 * the estimator would take that for the age of the rays. */
static void scan_done(void)
{
    scan_arrival_us = bsp_time_us();
    urg_scan_at(&urg, scan_arrival_us);
    monitor_released(MONITOR_RECEIVE_LASER, scan_arrival_us);
    Swi_post(laser_swi);
}

static void note_errors(const bsp_uart_burst_t *burst)
{
    if (burst->framing || burst->overrun) {
        urg_line_broken(&urg, burst->framing ? 1U : 0U);
        overruns += burst->overrun ? 1U : 0U;
    }
}

static void feed(const bsp_uart_burst_t *burst)
{
    octet_t run[BSP_UART_FIFO_DEPTH];

    for (uint16_t i = 0U; i < burst->count; ++i) {
        run[i] = octet_of(burst->octets[i]);
    }
    if (urg_feed(&urg, run, burst->count)) {
        scan_done();
    }
}

/* The last octet of a scan makes an interrupt; where the end is not known, the tick is soon enough. */
static uint16_t received(const bsp_uart_burst_t *burst)
{

    note_errors(burst);
    feed(burst);
    const uint16_t expected = urg_expected(&urg);
    return (expected > 0U) ? expected : (uint16_t)UART_PORT_BURST;
}

static Void laser_swi_run(UArg unused0, UArg unused1)
{
    scip_scan_t scan;
    UInt key = Hwi_disable();
    bool fresh = urg_take_scan(&urg, &scan);

    (void)unused0;
    (void)unused1;
    mailbox.arrival_us = scan_arrival_us;
    mailbox.bit_rate = rate;
    Hwi_restore(key);
    if (!fresh) {
        return;
    }
    /* With interrupts on: the copy may be of 171 cells, and octets come meanwhile. The driver fills
     * its other buffer. */
    mailbox.scan = scan;
    (void)memcpy(mailbox.distance_mm, scan.distance_mm, scan.points * sizeof scan.distance_mm[0]);
    Semaphore_post(laser_ready);
}

void laser_port_create(const urg_config_t *config)
{
    Swi_Params swi;
    Semaphore_Params semaphore;

    /* A configuration of constants: one that is refused has never flown. */
    (void)urg_init(&urg, config, points, (uint16_t)(sizeof points / sizeof points[0]), bsp_time_us());
    rate = config->first_rate;
    overruns = 0U;
    mailbox.scan.points = 0U;
    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    laser_ready = Semaphore_create(0, &semaphore, NULL);
    Swi_Params_init(&swi);
    swi.instance->name = "Laser_SWI";
    swi.priority = LASER_SWI_PRIORITY;
    laser_swi = Swi_create(laser_swi_run, &swi, NULL);
    cpu_time_watch(CPU_TIME_LASER_SWI, laser_swi);
    uart_port_create(BSP_UART_LASER, rate, received);
    if (config->wait_us > 0U) {
        usb_port_start();
    }
}

/* Swis off is enough, because only Laser_SWI writes the mailbox. Octets are still received during the
 * copy. */
void laser_port_wait(laser_message_t *message)
{

    (void)Semaphore_pend(laser_ready, BIOS_WAIT_FOREVER);
    const UInt key = Swi_disable();
    *message = mailbox;
    Swi_restore(key);
    message->scan.distance_mm = message->distance_mm;
}

bool laser_port_newer(laser_message_t *message)
{
    const UInt key = Swi_disable();
    const bool newer = mailbox.scan.points > 0U &&
                       (message->scan.points == 0U || mailbox.arrival_us != message->arrival_us);

    if (newer) {
        *message = mailbox;
    }
    Swi_restore(key);
    message->scan.distance_mm = message->distance_mm;
    return newer;
}

static void copy_statistics(laser_statistics_t *statistics)
{
    urg_report(&urg, &statistics->urg);
    statistics->overruns = overruns;
}

void laser_port_statistics(laser_statistics_t *statistics)
{
    UInt key = Hwi_disable();

    copy_statistics(statistics);
    Hwi_restore(key);
}

/* While the scanner starts up, nothing is sent to it. */
static void lend_transmitter(urg_status_t status)
{
    if (status == URG_WAIT) {
        usb_port_step();
    } else {
        usb_port_end();
    }
}

static void send(const urg_output_t *output)
{
    char text[SCIP_REQUEST_MAX];

    for (uint16_t i = 0U; i < output->count; ++i) {
        text[i] = (char)octet_of(output->octets[i]);
    }
    if (output->count > 0U) {
        (void)uart_port_send(BSP_UART_LASER, text, output->count);
    }
}

uint32_t laser_port_pause_us(void)
{
    UInt key = Hwi_disable();
    const uint32_t pause_us = urg_pause_us(&urg);

    Hwi_restore(key);
    return pause_us;
}

void laser_port_order(const scip_range_t *range)
{
    UInt key = Hwi_disable();

    /* Of parameters within their limits; one that is refused has never flown. */
    (void)urg_order(&urg, range);
    Hwi_restore(key);
}

void laser_port_step(laser_statistics_t *statistics)
{
    urg_output_t output;
    UInt key = Hwi_disable();

    urg_step(&urg, bsp_time_us());
    (void)urg_next_to_send(&urg, &output);
    rate = output.rate;
    copy_statistics(statistics);
    Hwi_restore(key);
    /* Before the UART is reopened: the transmitter must be the scanner's again when the first command
     * leaves. */
    lend_transmitter(statistics->urg.status);
    /* Before the octets: they are for the sensor at its new rate. */
    if (output.set_rate) {
        uart_port_reopen(BSP_UART_LASER, output.rate);
    }
    send(&output);
}
