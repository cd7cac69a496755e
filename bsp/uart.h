/* The three UARTs: laser on SCIA, IMU on SCIB, XBee on SCIC; 8N1, 16-deep FIFOs. An octet travels in the low
 * eight bits of a uint16_t. */
#ifndef BSP_UART_H
#define BSP_UART_H

#include <stdbool.h>
#include <stdint.h>

typedef enum { BSP_UART_LASER, BSP_UART_IMU, BSP_UART_XBEE, BSP_UART_COUNT } bsp_uart_t;

#define BSP_UART_FIFO_DEPTH 16U

typedef struct {
    uint16_t count; /* octets read, 0..16 */
    uint16_t octets[BSP_UART_FIFO_DEPTH];
    bool overrun; /* octets were lost before these were read; reception goes on */
    bool framing; /* a framing, parity or break error was seen; reception goes on */
} bsp_uart_burst_t;

/* SYS/BIOS interrupt numbers of a UART's receive and transmit interrupt (for Hwi_create). */
int16_t bsp_uart_receive_interrupt(bsp_uart_t uart);
int16_t bsp_uart_transmit_interrupt(bsp_uart_t uart);

/* Opens (or reopens at another rate) with empty FIFOs; receive interrupt on at one octet, transmit interrupt
 * off. main() or Task. rates: 9600 .. 250000. Reopening drops what is in the FIFOs. */
void bsp_uart_open(bsp_uart_t uart, uint32_t bit_rate);

/* Receive interrupt from that many octets in the FIFO on, 1..16; 1 after bsp_uart_open(). Fewer wait there:
 * the chip has no time-out of its own. Caller excludes both Hwis. */
void bsp_uart_set_receive_level(bsp_uart_t uart, uint16_t octets);

/* From the receive Hwi, or while it is excluded: takes what the FIFO holds, clears error and overflow
 * conditions so that reception goes on, and last the interrupt flag. */
void bsp_uart_receive(bsp_uart_t uart, bsp_uart_burst_t *burst);

/* Puts as many of `count` octets (low eight bits) into the transmit FIFO as fit and returns how many. Caller
 * excludes the transmit Hwi. */
uint16_t bsp_uart_transmit(bsp_uart_t uart, const uint16_t *octets, uint16_t count);

/* Transmit interrupt (FIFO empty) on or off. Off also clears its flag. */
void bsp_uart_transmit_interrupt_enable(bsp_uart_t uart, bool on);

/* From the transmit Hwi, last: clears the interrupt flag. */
void bsp_uart_transmit_acknowledge(bsp_uart_t uart);

/* True while an octet is still in the FIFO or on the wire. */
bool bsp_uart_transmitting(bsp_uart_t uart);

#endif
