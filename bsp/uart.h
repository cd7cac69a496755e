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
    bool overrun; /* octets were lost before these; reception continues */
    bool framing; /* a framing, parity or break error occurred; reception continues */
} bsp_uart_burst_t;

/* SYS/BIOS interrupt numbers of a UART's receive and transmit interrupt (for Hwi_create). */
int16_t bsp_uart_receive_interrupt(bsp_uart_t uart);
int16_t bsp_uart_transmit_interrupt(bsp_uart_t uart);

/* Opens the UART, or reopens it at another rate. bit_rate: 9600 .. 250000. The FIFOs are empty afterwards;
 * their old content is lost. The receive interrupt is on, from one octet; the transmit interrupt is off.
 * main() or Task. */
void bsp_uart_open(bsp_uart_t uart, uint32_t bit_rate);

/* Sets how many octets in the FIFO cause the receive interrupt, 1..16; 1 after bsp_uart_open(). Fewer octets
 * cause none, because the chip has no time-out. The caller excludes both Hwis. */
void bsp_uart_set_receive_level(bsp_uart_t uart, uint16_t octets);

/* Reads all octets from the FIFO. Clears errors and overflow, so that reception continues, and at last the
 * interrupt flag. Receive Hwi, or while it is excluded. */
void bsp_uart_receive(bsp_uart_t uart, bsp_uart_burst_t *burst);

/* Writes octets (low eight bits) to the transmit FIFO, at most `count` and as many as fit. Returns their
 * number. The caller excludes the transmit Hwi. */
uint16_t bsp_uart_transmit(bsp_uart_t uart, const uint16_t *octets, uint16_t count);

/* Switches the transmit interrupt (FIFO empty) on or off. Off also clears its flag. */
void bsp_uart_transmit_interrupt_enable(bsp_uart_t uart, bool on);

/* Clears the interrupt flag. Transmit Hwi, as its last call. */
void bsp_uart_transmit_acknowledge(bsp_uart_t uart);

/* True while an octet is still in the FIFO or on the wire. */
bool bsp_uart_transmitting(bsp_uart_t uart);

#endif
