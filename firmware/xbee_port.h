/* The radio's UART: the receive Hwi gathers command lines, XBee_SWI queues them for TaskReceiveComm; lines out are sent
 * whole, as one radio packet. */
#ifndef FIRMWARE_XBEE_PORT_H
#define FIRMWARE_XBEE_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/telecommand.h"
#include "drivers/telemetry.h"

#define XBEE_PORT_LINES 32U     /* command lines that may wait */

typedef struct {
    telecommand_line_t line;
    uint32_t arrival_us;        /* its line end */
} xbee_message_t;

/* main() only. */
void xbee_port_create(void);

/* Blocks TaskReceiveComm until a line is there; takes the oldest. Returns the number of lines that found the queue full
 * since the previous call. */
uint16_t xbee_port_wait(xbee_message_t *message);

/* Sends an answer; waits (Task_sleep) until there is room. Task. */
void xbee_port_answer(const telemetry_line_t *line);

/* True when a line waits: xbee_port_wait would not block. TaskReceiveComm. */
bool xbee_port_waiting(void);

/* Sends one line of a long answer, or returns false when more than a fifth of a second of lines is still to go: so
 * telemetry and other answers are not held up. Task. */
bool xbee_port_spare(const telemetry_line_t *line);

/* Sends a telemetry line, or drops it when answers fill the buffer. Task. */
void xbee_port_report(const telemetry_line_t *line);

#endif
