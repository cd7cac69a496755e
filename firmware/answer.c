#include "firmware/answer.h"

#include <stddef.h>

#include "firmware/xbee_port.h"

/* A line without a readable name is answered too: the operator waits for one answer to each line that
 * he sends. */
static void add_name(answer_t *answer)
{
    if (answer->command->name_length > 0U) {
        telemetry_characters(&answer->line, answer->command->name, answer->command->name_length);
    } else {
        telemetry_text(&answer->line, "-");
    }
}

/* People type two blanks, tabs and small letters. All blanks between two words count as one. */
bool answer_argument_is(const answer_t *answer, const char *word)
{
    const telecommand_t *command = answer->command;
    uint16_t i = 0U;

    for (; i < command->argument_length && *word != '\0'; ++word) {
        const char character = command->argument[i++];

        if (*word != (telecommand_is_blank(character) ? ' ' : telecommand_upper(character))) {
            return false;
        }
        while (telecommand_is_blank(character) && i < command->argument_length &&
               telecommand_is_blank(command->argument[i])) {
            ++i;
        }
    }
    return i == command->argument_length && *word == '\0';
}

void answer_begin(answer_t *answer)
{
    telemetry_begin_answer(&answer->line);
    telemetry_text(&answer->line, "OK ");
    add_name(answer);
}

static void begin_error(answer_t *answer)
{
    telemetry_begin_answer(&answer->line);
    telemetry_text(&answer->line, "ERR ");
    add_name(answer);
    telemetry_text(&answer->line, " ");
}

void answer_send(answer_t *answer)
{
    telemetry_end(&answer->line);
    /* Half an answer would read as a whole one. So the refusal comes in its place. */
    if (answer->line.overflowed) {
        begin_error(answer);
        telemetry_text(&answer->line, "answer too long");
        telemetry_end(&answer->line);
    }
    xbee_port_answer(&answer->line);
}

bool answer_refuse(answer_t *answer, const char *reason)
{
    begin_error(answer);
    telemetry_text(&answer->line, reason);
    answer_send(answer);
    return false;
}

bool answer_refuse_range(answer_t *answer, const parameter_row_t *row)
{
    begin_error(answer);
    telemetry_text(&answer->line, (row->choices == NULL) ? "out of range " : "one of ");
    answer_limits(answer, row);
    answer_send(answer);
    return false;
}

void answer_count(answer_t *answer, const char *name, uint32_t count)
{
    telemetry_text(&answer->line, " ");
    telemetry_text(&answer->line, name);
    telemetry_text(&answer->line, ":");
    telemetry_count(&answer->line, count);
}

void answer_limits(answer_t *answer, const parameter_row_t *row)
{
    telemetry_line_t *line = &answer->line;

    /* A number has limits; a choice has names, of which the values are the places. */
    if (row->choices == NULL) {
        telemetry_number(line, row->minimum);
        telemetry_text(line, "..");
        telemetry_number(line, row->maximum);
        telemetry_text(line, " ");
        telemetry_text(line, row->unit);
        return;
    }
    for (uint16_t i = 0U; i <= (uint16_t)row->maximum; ++i) {
        telemetry_text(line, (i > 0U) ? "|" : "");
        telemetry_text(line, row->choices[i]);
    }
}
