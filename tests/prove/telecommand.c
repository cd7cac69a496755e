/* Of a line: it has room for what it says, and one that has begun has its '#'. Each step starts from any
 * state that keeps this and must end in one, so the proof holds after any number of octets. */
#include "drivers/telecommand.h"

#include "prove.h"

static bool is_sound(const telecommand_collector_t *collector)
{
    return collector->line.length <= TELECOMMAND_LINE_MAX &&
           (!collector->started || collector->line.length > 0U);
}

void collector_starts_sound(void)
{
    telecommand_collector_t collector;

    telecommand_collector_init(&collector);
    PROVE(is_sound(&collector), "sound from the start");
}

void collector_stays_sound(void)
{
    telecommand_collector_t collector;

    ASSUME(is_sound(&collector));
    if (nondet_bool()) {
        telecommand_collector_broken(&collector);
    }
    (void)telecommand_collect(&collector, nondet_cell());
    PROVE(is_sound(&collector), "sound after any octet");
}

void any_line_is_parsed(void)
{
    telecommand_line_t line;
    telecommand_t command;
    telecommand_status_t status;

    ASSUME(line.length <= TELECOMMAND_LINE_MAX);
    status = telecommand_parse(&line, nondet_bool(), &command);
    PROVE(command.name_length <= TELECOMMAND_NAME_MAX, "the name fits");
    PROVE(command.argument_length <= TELECOMMAND_LINE_MAX, "the argument fits");
    PROVE(status == TELECOMMAND_OK || command.argument_length == 0U || status == TELECOMMAND_CHARACTER,
          "refused is empty");
}

void any_line_may_be_urgent(void)
{
    telecommand_line_t line;

    ASSUME(line.length <= TELECOMMAND_LINE_MAX);
    (void)telecommand_is_urgent(&line);
}
