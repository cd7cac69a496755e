/* Builds and sends one answer line: `OK ...` or `ERR NAME reason`, up to TELEMETRY_ANSWER_MAX characters.
 * The verb's caller owns the answer_t. Context: Task; answer_send() and what
 * refuses, TaskReceiveComm only. */
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

/* True when the command's argument is that word, or these words. `word` is in upper case, with one blank
 * between two words; the operator may type either case, and blanks or tabs as he likes. */
bool answer_argument_is(const answer_t *answer, const char *word);
/* Begins the line with `OK ` and the name of the command. */
void answer_begin(answer_t *answer);
/* Sends the line. If it did not fit, sends `ERR NAME answer too long` instead. */
void answer_send(answer_t *answer);
/* Sends `ERR NAME reason`. Returns false, so a verb can return this call. */
bool answer_refuse(answer_t *answer, const char *reason);
/* Sends `ERR NAME out of range ...` or, for a choice, `ERR NAME one of ...`. Returns false. */
bool answer_refuse_range(answer_t *answer, const parameter_row_t *row);
/* Appends " name:count". */
void answer_count(answer_t *answer, const char *name, uint32_t count);
/* Appends the limits of a parameter: "0..1 N/mm" or "PD|PID". */
void answer_limits(answer_t *answer, const parameter_row_t *row);

#endif
