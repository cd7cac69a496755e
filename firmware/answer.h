/* One answer line under construction, of up to TELEMETRY_ANSWER_MAX characters: `OK ...` or `ERR NAME reason`.
 * TaskReceiveComm only. */
#ifndef FIRMWARE_ANSWER_H
#define FIRMWARE_ANSWER_H

#include <stdbool.h>

#include "control/parameters.h"
#include "drivers/telecommand.h"
#include "drivers/telemetry.h"

typedef struct {
    const telecommand_t *command;
    telemetry_line_t line;
} answer_t;

/* The command's argument is that word (upper case here, either case typed). */
bool answer_argument_is(const answer_t *answer, const char *word);
/* Begins a line with `OK ` and the command's name. */
void answer_begin(answer_t *answer);
/* Sends the line; instead of one that did not fit, `ERR NAME answer too long`. */
void answer_send(answer_t *answer);
/* `ERR NAME reason`; returns false, so that a verb can return it. */
bool answer_refuse(answer_t *answer, const char *reason);
/* `ERR NAME out of range ...` or `ERR NAME one of ...`; returns false. */
bool answer_refuse_range(answer_t *answer, const parameter_row_t *row);
/* " name:count" */
void answer_count(answer_t *answer, const char *name, uint32_t count);
/* The limits of a row: "0..1 N/mm" or "PD|PID". */
void answer_limits(answer_t *answer, const parameter_row_t *row);

#endif
