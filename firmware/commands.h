/* One operator's line from its text to its effect and its answers. TaskReceiveComm only. */
#ifndef FIRMWARE_COMMANDS_H
#define FIRMWARE_COMMANDS_H

#include <stdint.h>

#include "drivers/telecommand.h"

/* Parses, checks, applies (whole or not at all) and answers: `OK NAME value` or `ERR NAME reason`. May block while the
 * radio takes the answers. arrival_us: when the line was complete. */
void commands_execute(const telecommand_line_t *line, uint32_t arrival_us);

/* Goes on with the answers that take long, until they are complete or a line waits. Blocks between their lines. */
void commands_continue(void);

/* Tells the operator that `count` lines came faster than they could be queued. */
void commands_report_lost(uint16_t count);

#endif
