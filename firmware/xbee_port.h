/* The radio's UART: the receive Hwi gathers command lines, XBee_SWI queues them for TaskReceiveComm; lines out are sent
 * whole, as one radio packet. */
#ifndef FIRMWARE_XBEE_PORT_H
#define FIRMWARE_XBEE_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/telecommand.h"
#include "drivers/telemetry.h"

#define XBEE_PORT_LINES 32U     /* command lines that may wait */
#define XBEE_PORT_URGENT 4U     /* and urgent ones beside them */

typedef struct {
    telecommand_line_t line;
    uint32_t arrival_us;        /* its line end */
    bool overtaken;             /* an urgent line came behind it and was taken before it */
} xbee_message_t;

/* main() only. */
void xbee_port_create(void);

/* Blocks TaskReceiveComm until a line is there; takes the oldest urgent one (telecommand_is_urgent()), else a bare one, else
 * the oldest. Of bare lines that wait the first alone is kept; when the urgent ones' places are full the newest takes the
 * last. Returns the number of lines that found the queue full since the previous call. */
uint16_t xbee_port_wait(xbee_message_t *message);

/* Sends an answer; waits (Task_sleep) until there is room. Task. */
void xbee_port_answer(const telemetry_line_t *line);

/* True when a line waits: xbee_port_wait would not block. TaskReceiveComm. */
bool xbee_port_waiting(void);

/* True when a line waits that is urgent or bare. TaskReceiveComm. */
bool xbee_port_pressing(void);

/* True while at most a fifth of a second of lines is still to go: an answer of whatever length then leaves the telemetry
 * its room. Task. */
bool xbee_port_clear(void);

/* Sends one line of a long answer, or returns false when more than a fifth of a second of lines would then be to go: so
 * telemetry and other answers are not held up. (One that is longer by itself goes when nothing else is.) Task. */
bool xbee_port_spare(const telemetry_line_t *line);

/* Sends a line that is old as soon as the next one is there, or drops it when four of its length wait before it. Task. */
void xbee_port_stream(const telemetry_line_t *line);

/* Sends a telemetry line, or drops it when answers fill the buffer. Task. */
void xbee_port_report(const telemetry_line_t *line);

#endif
