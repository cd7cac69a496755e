/* The operator at the world's terminal: types commands, waits for their answers. */
#ifndef TOOLS_PLOMADA_TERMINAL_H
#define TOOLS_PLOMADA_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/timeline.h"

void terminal_begin(void);
/* world_config_t.line */
void terminal_line(const char *text);

/* Types `#COMMAND`, up to three times, until a line begins with OK or ERR and the command's name; then that
 * line is in `answer`. False: refused, not answered, interrupted; `answer` is "" when nothing came. */
bool terminal_ask(const char *command, char *answer, size_t size);

/* All lines of answers since terminal_ask() began, each ended by LF; waits for so long for more of them. */
const char *terminal_rest(sim_time_t patience);

/* The newest telemetry line, "" before the first, and when it came. */
const char *terminal_telemetry(sim_time_t *when);
/* The cause of the latest reset, as the first telemetry line after it tells: "" when none was told since
 * then. */
const char *terminal_reset(sim_time_t since);
/* The text behind `name` (with its colon) in it, up to the next blank; "" when there is none. */
void terminal_field(const char *name, char *value, size_t size);

#endif
