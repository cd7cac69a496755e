/* One operator's line from its text to its effect and its answers. TaskReceiveComm only. */
#ifndef FIRMWARE_COMMANDS_H
#define FIRMWARE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/xbee_port.h"

/* Parses, checks, applies (whole or not at all) and answers: `OK NAME value` or `ERR NAME reason`; a bare line only when
 * none was answered for a second. One that was overtaken by a stop starts nothing any more. */
void commands_execute(const xbee_message_t *message);

/* Goes on with the answers that take long, until they are complete or a line can be taken: one that presses at once, any
 * other when no list is being sent and the radio has room for its answer. Blocks between lines. True: it had to wait for
 * the radio. */
bool commands_continue(void);

/* Tells the operator that `count` lines came faster than they could be queued. */
void commands_report_lost(uint16_t count);

#endif
