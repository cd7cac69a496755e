#include "xbee_port.h"

#include <stddef.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "schedule.h"
#include "timebase.h"
#include "uart_port.h"

#define XBEE_BIT_RATE 9600UL
#define ROOM_POLL_MS 10U    /* ten characters leave meanwhile */
#define REPORT_ROOM (UART_PORT_TRANSMIT_CELLS / 2U)

static telecommand_collector_t collector;   /* receive Hwi only */
static xbee_message_t fresh;                /* written by the receive Hwi, read by XBee_SWI at once */
static xbee_message_t lines[XBEE_PORT_LINES];   /* the rest: XBee_SWI, and TaskReceiveComm with Swis off */
static uint16_t oldest;
static uint16_t waiting;
static uint16_t lost;
static Swi_Handle xbee_swi;
static Semaphore_Handle line_ready;

static void received(const bsp_uart_burst_t *burst)
{
    uint16_t i;

    for (i = 0U; i < burst->count; i++) {
        if (telecommand_collect(&collector, octet_of(burst->octets[i]))) {
            fresh.line = collector.line;
            fresh.arrival_us = bsp_time_us();
            Swi_post(xbee_swi);
        }
    }
}

static Void xbee_swi_run(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    if (waiting == XBEE_PORT_LINES) {
        lost++;
    } else {
        lines[(uint16_t)(oldest + waiting) % XBEE_PORT_LINES] = fresh;
        waiting++;
        Semaphore_post(line_ready);
    }
}

void xbee_port_create(void)
{
    Swi_Params swi;

    telecommand_collector_init(&collector);
    line_ready = Semaphore_create(0, NULL, NULL);
    Swi_Params_init(&swi);
    swi.instance->name = "XBee_SWI";
    swi.priority = XBEE_SWI_PRIORITY;
    xbee_swi = Swi_create(xbee_swi_run, &swi, NULL);
    uart_port_create(BSP_UART_XBEE, XBEE_BIT_RATE, received);
}

uint16_t xbee_port_wait(xbee_message_t *message)
{
    UInt key;
    uint16_t missed;

    (void)Semaphore_pend(line_ready, BIOS_WAIT_FOREVER);
    key = Swi_disable();
    *message = lines[oldest];
    oldest = (uint16_t)((oldest + 1U) % XBEE_PORT_LINES);
    waiting--;
    missed = lost;
    lost = 0U;
    Swi_restore(key);
    return missed;
}

void xbee_port_answer(const telemetry_line_t *line)
{
    while (!uart_port_send(BSP_UART_XBEE, line->text, line->length)) {
        Task_sleep(ROOM_POLL_MS);
    }
}

void xbee_port_report(const telemetry_line_t *line)
{
    if (uart_port_room(BSP_UART_XBEE) >= REPORT_ROOM) {
        (void)uart_port_send(BSP_UART_XBEE, line->text, line->length);
    }
}
