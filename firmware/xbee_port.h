/* UART of the radio. The receive Hwi collects command lines. XBee_SWI signals them to TaskReceiveComm.
 * Lines to the operator are sent as a whole, as one radio packet. */
#ifndef FIRMWARE_XBEE_PORT_H
#define FIRMWARE_XBEE_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/telecommand.h"
#include "drivers/telemetry.h"

#define XBEE_PORT_LINES 32U /* command lines that can wait */
#define XBEE_PORT_URGENT 4U /* urgent lines that can wait, in addition */

typedef struct {
    telecommand_line_t line;
    uint32_t arrival_us; /* arrival of its line end */
    bool overtaken;      /* an urgent line arrived later and was taken first */
} xbee_message_t;

/* Creates the port. main() only. */
void xbee_port_create(void);

/* Blocks until a line waits, then copies it to *message. Order: the oldest urgent line
 * (telecommand_is_urgent()), then a line without '#', then the oldest other line. Of waiting lines without
 * '#' only the first is kept. When the urgent queue is full, the newest urgent line replaces the last one.
 * Returns how many lines were lost since the previous call because the queue was full. TaskReceiveComm
 * only. */
uint16_t xbee_port_wait(xbee_message_t *message);

/* Sends an answer. Blocks (Task_sleep) until there is room. Task. */
void xbee_port_answer(const telemetry_line_t *line);

/* True when a line waits, so xbee_port_wait() would not block. TaskReceiveComm. */
bool xbee_port_waiting(void);

/* True when an urgent line or a line without '#' waits. TaskReceiveComm. */
bool xbee_port_pressing(void);

/* True while the transmit buffer holds at most a fifth of a second of lines. Then an answer of any length
 * leaves room for the telemetry. Task. */
bool xbee_port_clear(void);

/* Sends one line of a long answer. Returns false, and sends nothing, when the buffer would then hold more
 * than a fifth of a second of lines; so telemetry and other answers are not delayed. A line that is longer
 * than that by itself is sent when the buffer is empty. Task. */
bool xbee_port_spare(const telemetry_line_t *line);

/* Sends a line that the next line makes obsolete. Drops it when more than four times its length already
 * waits in the buffer. Task. */
void xbee_port_stream(const telemetry_line_t *line);

/* Sends a telemetry line. Drops it when answers fill the buffer. Task. */
void xbee_port_report(const telemetry_line_t *line);

#endif
