#include "firmware/uart_port.h"

#include <stddef.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Clock.h>
#include <xdc/std.h>

#include "firmware/cpu_time.h"

#define POLL_TICKS 1U

typedef struct {
    uart_port_received_t received;
    uint16_t level; /* octets that the receive interrupt waits for */
    uint16_t cells[UART_PORT_TRANSMIT_CELLS];
    uint16_t head; /* next to send */
    uint16_t count;
} uart_port_t;

static uart_port_t ports[BSP_UART_COUNT];

/* The receiver says when it wants to be called again. So the last octet of a scan makes an interrupt
 * at once, and all others wait for half a FIFO. */
static void read_fifo(bsp_uart_t uart)
{
    uart_port_t *port = &ports[uart];
    bsp_uart_burst_t burst;

    bsp_uart_receive(uart, &burst);
    uint16_t level = port->received(&burst);
    if (level > UART_PORT_BURST) {
        level = UART_PORT_BURST;
    }
    /* The level is a register of the chip. It changes with a frame's end only, so most calls leave it
     * alone. */
    if (level != port->level) {
        port->level = level;
        bsp_uart_set_receive_level(uart, level);
    }
}

static Void receive_hwi(UArg uart)
{
    read_fifo((bsp_uart_t)uart);
}

/* Also where every octet makes an interrupt: an error that rises between the look at the receive status and
 * the clearing of the interrupt flag holds the interrupt line up, and without a new edge no interrupt comes
 * any more. */
static Void poll(UArg unused)
{

    (void)unused;
    for (uint16_t uart = 0U; uart < (uint16_t)BSP_UART_COUNT; ++uart) {
        UInt key = Hwi_disable();

        read_fifo((bsp_uart_t)uart);
        Hwi_restore(key);
    }
}

/* Up to the end of the buffer; the rest of a text that goes round the corner is another run. */
static uint16_t feed_run(bsp_uart_t uart)
{
    uart_port_t *port = &ports[uart];
    uint16_t run = (uint16_t)(UART_PORT_TRANSMIT_CELLS - port->head);

    if (run > port->count) {
        run = port->count;
    }
    const uint16_t sent = bsp_uart_transmit(uart, &port->cells[port->head], run);
    port->head = (uint16_t)((uint16_t)(port->head + sent) % UART_PORT_TRANSMIT_CELLS);
    port->count = (uint16_t)(port->count - sent);
    return sent;
}

/* Until the FIFO is full or the buffer empty, so that the interrupt is on only behind a full FIFO. */
static void feed_transmitter(bsp_uart_t uart)
{
    while (ports[uart].count > 0U && feed_run(uart) > 0U) {
    }
    bsp_uart_transmit_interrupt_enable(uart, ports[uart].count > 0U);
}

static Void transmit_hwi(UArg uart)
{
    feed_transmitter((bsp_uart_t)uart);
    bsp_uart_transmit_acknowledge((bsp_uart_t)uart);
}

static Hwi_Handle hwi_create(int16_t number, Hwi_FuncPtr function, bsp_uart_t uart)
{
    Hwi_Params params;

    Hwi_Params_init(&params);
    params.arg = (UArg)uart;
    return Hwi_create((Int)number, function, &params, NULL);
}

/* bsp_uart_open() sets the level to one octet, so here it is one too. */
static void open(bsp_uart_t uart, uint32_t bit_rate)
{
    bsp_uart_open(uart, bit_rate);
    ports[uart].level = 1U;
}

void uart_port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received)
{
    ports[uart].received = received;
    open(uart, bit_rate);
    cpu_time_watch((cpu_time_job_t)(CPU_TIME_LASER_RECEIVE + 2U * uart),
                   hwi_create(bsp_uart_receive_interrupt(uart), receive_hwi, uart));
    cpu_time_watch((cpu_time_job_t)(CPU_TIME_LASER_TRANSMIT + 2U * uart),
                   hwi_create(bsp_uart_transmit_interrupt(uart), transmit_hwi, uart));
}

void uart_port_start(void)
{
    Clock_Params params;

    Clock_Params_init(&params);
    params.period = POLL_TICKS;
    params.startFlag = TRUE;
    (void)Clock_create(poll, POLL_TICKS, &params, NULL);
}

void uart_port_reopen(bsp_uart_t uart, uint32_t bit_rate)
{
    UInt key = Hwi_disable();

    /* At the old rate they would be noise at the new one. */
    ports[uart].head = 0U;
    ports[uart].count = 0U;
    open(uart, bit_rate);
    Hwi_restore(key);
}

bool uart_port_send(bsp_uart_t uart, const char *text, uint16_t count)
{
    uart_port_t *port = &ports[uart];
    UInt key = Hwi_disable();
    bool fits = (uint16_t)(UART_PORT_TRANSMIT_CELLS - port->count) >= count;

    /* All or nothing: half a line on the air is a damaged line for whoever reads it. */
    for (uint16_t i = 0U; fits && i < count; ++i) {
        port->cells[(uint16_t)(port->head + port->count) % UART_PORT_TRANSMIT_CELLS] = (uint16_t)text[i] &
                                                                                       0xFFU;
        ++port->count;
    }
    feed_transmitter(uart);
    Hwi_restore(key);
    return fits;
}

uint16_t uart_port_room(bsp_uart_t uart)
{
    UInt key = Hwi_disable();
    uint16_t room = (uint16_t)(UART_PORT_TRANSMIT_CELLS - ports[uart].count);

    Hwi_restore(key);
    return room;
}
