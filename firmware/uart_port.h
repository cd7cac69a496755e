/* Octets in and out of the three UARTs: the receive and transmit Hwis, and a bounded transmit buffer per UART.
 *
 * The receive Hwi comes when as many octets are in the FIFO as the receiver has asked for. Fewer are taken by the 1 ms
 * tick, so that none is older than that; and a receiver that an error has stopped hears again after one tick. */
#ifndef FIRMWARE_UART_PORT_H
#define FIRMWARE_UART_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "bsp/uart.h"

#define UART_PORT_TRANSMIT_CELLS 1024U

/* Most octets that an interrupt waits for: half of the FIFO stays free, 320 us at 250000 bits per second. */
#define UART_PORT_BURST (BSP_UART_FIFO_DEPTH / 2U)

/* Called with what has come, from the receive Hwi, or from the tick's Swi with interrupts off. Returns after how many
 * octets more it is to be called at the latest, 1 or more. */
typedef uint16_t (*uart_port_received_t)(const bsp_uart_burst_t *burst);

/* Creates both Hwis and opens the UART. main() only. */
void uart_port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received);

/* Starts the tick that takes what no interrupt has fetched. main(), once, when all are created. */
void uart_port_start(void);

/* Reopens the UART at another rate; what was not yet sent is dropped. Task. */
void uart_port_reopen(bsp_uart_t uart, uint32_t bit_rate);

/* Queues all `count` characters, or none when they do not fit (false). Never blocks. Task or main(). */
bool uart_port_send(bsp_uart_t uart, const char *text, uint16_t count);

/* Free cells in the transmit buffer. */
uint16_t uart_port_room(bsp_uart_t uart);

#endif
