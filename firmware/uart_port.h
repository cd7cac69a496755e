/* Octets in and out of the three UARTs: the receive and transmit Hwis, and a bounded transmit buffer per UART. */
#ifndef FIRMWARE_UART_PORT_H
#define FIRMWARE_UART_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "uart.h"

#define UART_PORT_TRANSMIT_CELLS 1024U

/* Called from the receive Hwi with what has come. */
typedef void (*uart_port_received_t)(const bsp_uart_burst_t *burst);

/* Creates both Hwis and opens the UART. main() only. */
void uart_port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received);

/* Reopens the UART at another rate; what was not yet sent is dropped. Task. */
void uart_port_reopen(bsp_uart_t uart, uint32_t bit_rate);

/* Queues all `count` characters, or none when they do not fit (false). Never blocks. Task or main(). */
bool uart_port_send(bsp_uart_t uart, const char *text, uint16_t count);

/* Free cells in the transmit buffer. */
uint16_t uart_port_room(bsp_uart_t uart);

#endif
