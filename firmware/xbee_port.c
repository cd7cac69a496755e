#include "firmware/xbee_port.h"

#include <stddef.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/cpu_time.h"
#include "firmware/schedule.h"
#include "bsp/timebase.h"
#include "firmware/uart_port.h"

#define XBEE_BIT_RATE 9600UL
#define ROOM_POLL_MS 10U /* ten characters leave meanwhile */
#define REPORT_ROOM (UART_PORT_TRANSMIT_CELLS / 2U)
#define SPARE_ROOM (UART_PORT_TRANSMIT_CELLS - 192U) /* 192 characters leave in 0.2 s */

typedef struct {
    xbee_message_t *lines;
    uint16_t places;
    uint16_t oldest;
    uint16_t waiting;
} queue_t;

/* Written by the receive Hwi; the queues are emptied by TaskReceiveComm with Hwis off. */
static telecommand_collector_t collector;
static xbee_message_t lines[XBEE_PORT_LINES];
static xbee_message_t urgent_lines[XBEE_PORT_URGENT];
static xbee_message_t bare_line[1];
static queue_t ordinary = {.lines = lines, .places = XBEE_PORT_LINES};
static queue_t urgent = {.lines = urgent_lines, .places = XBEE_PORT_URGENT};
static queue_t bare = {.lines = bare_line, .places = 1U};
static uint16_t unannounced; /* lines since XBee_SWI ran last */
static uint16_t lost;
static Swi_Handle xbee_swi;
static Semaphore_Handle line_ready;

static xbee_message_t *place(const queue_t *queue, uint16_t at)
{
    return &queue->lines[(uint16_t)(queue->oldest + at) % queue->places];
}

static void put(xbee_message_t *message)
{
    message->line = collector.line;
    message->arrival_us = bsp_time_us();
    message->overtaken = false;
}

/* False when the queue is full. */
static bool append(queue_t *queue)
{
    if (queue->waiting == queue->places) {
        return false;
    }
    put(place(queue, queue->waiting));
    ++queue->waiting;
    ++unannounced;
    Swi_post(xbee_swi);
    return true;
}

/* A stop goes before all that waits. What waits and starts something is marked: it was typed before
 * the stop, and must not be obeyed behind it. */
static void queue_urgent(void)
{

    for (uint16_t i = 0U; i < ordinary.waiting; ++i) {
        place(&ordinary, i)->overtaken = true;
    }
    if (!append(&urgent)) {
        /* Full of stops: the newest takes the last place. It says the same, and its arrival is the one
         * that counts. */
        put(place(&urgent, XBEE_PORT_URGENT - 1U));
    }
}

/* A line without `#` has one place: of many only one is answered in a second anyhow. */
static void queue_line(void)
{
    if (collector.line.bare) {
        (void)append(&bare);
    } else if (telecommand_is_urgent(&collector.line)) {
        queue_urgent();
    } else if (!append(&ordinary)) {
        ++lost;
    }
}

/* Which octet of a burst was hit is not known, nor whether some were lost before or behind it. */
static void doubt(const bsp_uart_burst_t *burst)
{
    if (burst->framing || burst->overrun) {
        telecommand_collector_broken(&collector);
    }
}

/* Every octet for itself: commands are short, rare and slow. */
static uint16_t received(const bsp_uart_burst_t *burst)
{

    for (uint16_t i = 0U; i < burst->count; ++i) {
        doubt(burst);
        if (telecommand_collect(&collector, octet_of(burst->octets[i]))) {
            queue_line();
        }
    }
    doubt(burst);
    return 1U;
}

/* Two lines may end between two runs of the Swi: a post that comes while one is pending is lost, so
 * the lines are counted. */
static Void xbee_swi_run(UArg unused0, UArg unused1)
{
    UInt key = Hwi_disable();
    uint16_t fresh = unannounced;

    (void)unused0;
    (void)unused1;
    unannounced = 0U;
    Hwi_restore(key);
    for (; fresh > 0U; --fresh) {
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
    cpu_time_watch(CPU_TIME_XBEE_SWI, xbee_swi);
    uart_port_create(BSP_UART_XBEE, XBEE_BIT_RATE, received);
}

static queue_t *next_queue(void)
{
    if (urgent.waiting > 0U) {
        return &urgent;
    }
    return (bare.waiting > 0U) ? &bare : &ordinary;
}

uint16_t xbee_port_wait(xbee_message_t *message)
{
    queue_t *queue;

    (void)Semaphore_pend(line_ready, BIOS_WAIT_FOREVER);
    const UInt key = Hwi_disable();
    queue = next_queue();
    *message = *place(queue, 0U);
    queue->oldest = (uint16_t)((queue->oldest + 1U) % queue->places);
    --queue->waiting;
    const uint16_t missed = lost;
    lost = 0U;
    Hwi_restore(key);
    return missed;
}

/* It waits for room rather than drop: an answer that is missing reads as a line that was not obeyed. */
void xbee_port_answer(const telemetry_line_t *line)
{
    while (!uart_port_send(BSP_UART_XBEE, line->text, line->length)) {
        Task_sleep(ROOM_POLL_MS);
    }
}

bool xbee_port_waiting(void)
{
    return ordinary.waiting > 0U || xbee_port_pressing();
}

bool xbee_port_pressing(void)
{
    return urgent.waiting > 0U || bare.waiting > 0U;
}

bool xbee_port_clear(void)
{
    return uart_port_room(BSP_UART_XBEE) >= SPARE_ROOM;
}

/* Only what leaves the transmitter nearly empty: an answer or a stop's echo never waits behind more
 * than 0.2 s of a list. A line longer than that needs all of it. */
bool xbee_port_spare(const telemetry_line_t *line)
{
    const uint16_t room = uart_port_room(BSP_UART_XBEE);

    return (room >= SPARE_ROOM + line->length || room == UART_PORT_TRANSMIT_CELLS) &&
           uart_port_send(BSP_UART_XBEE, line->text, line->length);
}

/* Four lines may wait. More would be pulses of another time. */
void xbee_port_stream(const telemetry_line_t *line)
{
    if (uart_port_room(BSP_UART_XBEE) >= UART_PORT_TRANSMIT_CELLS - 4U * line->length) {
        (void)uart_port_send(BSP_UART_XBEE, line->text, line->length);
    }
}

/* Half of the buffer stays free for answers. Telemetry that is left out is told again 0.2 s later. */
void xbee_port_report(const telemetry_line_t *line)
{
    if (uart_port_room(BSP_UART_XBEE) >= REPORT_ROOM) {
        (void)uart_port_send(BSP_UART_XBEE, line->text, line->length);
    }
}
