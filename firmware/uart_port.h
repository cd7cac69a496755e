/* Input and output of the three UARTs: receive Hwi, transmit Hwi, and a transmit buffer of fixed size per
 * UART.
 *
 * The receive Hwi runs when the FIFO holds as many octets as the receiver has asked for. The tick of 1 ms
 * reads fewer octets than that, so no octet waits longer. The tick also restarts a receiver that stopped
 * after an error. */
#ifndef FIRMWARE_UART_PORT_H
#define FIRMWARE_UART_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "bsp/uart.h"

#define UART_PORT_TRANSMIT_CELLS 1024U

/* Maximum number of octets that an interrupt waits for. Half of the FIFO stays free: 320 us at 250000 bits
 * per second. */
#define UART_PORT_BURST (BSP_UART_FIFO_DEPTH / 2U)

/* Called with the received octets, which are borrowed for the call. Context: the receive Hwi, or the
 * tick's Swi with interrupts disabled. Returns after how many more octets, at the latest, it is to be
 * called again; >= 1. */
typedef uint16_t (*uart_port_received_t)(const bsp_uart_burst_t *burst);

/* Creates both Hwis and opens the UART. bit_rate in bits per second. main() only. */
void uart_port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received);

/* Starts the tick that reads the octets that caused no interrupt. Call once in main(), after all ports are
 * created. */
void uart_port_start(void);

/* Reopens the UART at another bit rate. Octets that are not sent yet are lost. Task. */
void uart_port_reopen(bsp_uart_t uart, uint32_t bit_rate);

/* Queues all `count` characters; or none, and returns false, when they do not fit. The text is copied.
 * Does not block. Task or main(). */
bool uart_port_send(bsp_uart_t uart, const char *text, uint16_t count);

/* Number of free cells in the transmit buffer. Task or main(). */
uint16_t uart_port_room(bsp_uart_t uart);

#endif
