/* Executes one line of the operator: text in, effect and answers out. Context: Task, TaskReceiveComm only. */
#ifndef FIRMWARE_COMMANDS_H
#define FIRMWARE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/xbee_port.h"

/* Parses, checks and executes the line, as a whole or not at all. Answers `OK NAME value` or `ERR NAME
 * reason`. A line without '#' is answered at most once a second. A line that was overtaken by an urgent
 * stop does not start anything. */
void commands_execute(const xbee_message_t *message);

/* Continues a long answer until it is complete, or until a new line can be processed. An urgent line or a
 * line without '#' can be processed at once; any other line only when no list is being sent and the radio
 * has room for its answer. Blocks between the lines of the answer. Returns since when, on
 * bsp_time_us(), a line that had come would not have had to wait for that. */
uint32_t commands_continue(void);

/* Tells the operator that `count` lines were lost because the queue was full. */
void commands_report_lost(uint16_t count);

#endif
