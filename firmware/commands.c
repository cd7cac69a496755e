#include "firmware/commands.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/answer.h"
#include "firmware/calibrator.h"
#include "drivers/decimal.h"
#include "control/parameters.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"
#include "firmware/xbee_port.h"

#define CONTINUE_POLL_MS 10U    /* ten characters leave meanwhile */

typedef struct {
    const char *name;
    bool (*execute)(answer_t *answer);
    const char *meaning;
} verb_t;

static float value_of(parameter_id_t id, const parameters_t *parameters)
{
    reference_sample_t reference;

    if (id != PARAMETER_SETR) {
        return parameters->value[id];
    }
    reference_server_read(&reference);
    return reference.reference_m;
}

static void report_value(answer_t *answer, parameter_id_t id)
{
    const parameter_row_t *row = &parameter_table[id];
    parameters_t parameters;
    float value;

    parameter_server_read(&parameters);
    value = value_of(id, &parameters);
    telemetry_begin(&answer->line);
    telemetry_text(&answer->line, "OK ");
    telemetry_text(&answer->line, row->name);
    telemetry_text(&answer->line, " ");
    if (row->choices != NULL) {
        telemetry_text(&answer->line, row->choices[(uint16_t)value]);
    } else {
        telemetry_number(&answer->line, value);
    }
    answer_send(answer);
}

static bool execute_get(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    uint16_t id;

    if (command->argument_length > 0U) {
        id = (uint16_t)parameter_find(command->argument, command->argument_length);
        if (id == (uint16_t)PARAMETER_COUNT) {
            return answer_refuse(answer, "unknown parameter");
        }
        report_value(answer, (parameter_id_t)id);
        return true;
    }
    for (id = 0U; id < (uint16_t)PARAMETER_COUNT; id++) {
        report_value(answer, (parameter_id_t)id);
    }
    return true;
}

static bool execute_ping(answer_t *answer)
{
    answer_begin(answer);
    if (answer->command->argument_length > 0U) {
        telemetry_text(&answer->line, " ");
        telemetry_characters(&answer->line, answer->command->argument, answer->command->argument_length);
    }
    answer_send(answer);
    return true;
}

static bool execute_help(answer_t *answer);

static const verb_t verbs[] = {
    {"GET", execute_get, "[NAME] - one parameter, or all"},
    {"SAVE", verb_save, "- stores the parameters, all but SETR"},
    {"LOAD", verb_load, "- the stored parameters"},
    {"DEFAULTS", verb_defaults, "- the parameters as delivered; the stored ones stay"},
    {"LOG", verb_log, "[SECONDS|CLEAR|STOP] - the flight recorder as CSV"},
    {"CALIBRATE", verb_calibrate, "[COUNTS [SECONDS]] - thrust step by step, tied down; any line but #PING ends it"},
    {"LASER", verb_laser, "- the scanner's state, rate, frames and errors by cause"},
    {"PERF", verb_perf, "[RESET] - responses, deadlines, stacks, load, waits; RESET clears them"},
    {"PING", execute_ping, "[TEXT] - answers the same text"},
    {"HELP", execute_help, "- this list"},
};
#define VERB_COUNT (sizeof verbs / sizeof verbs[0])

static void begin_help(answer_t *answer, const char *name)
{
    answer_begin(answer);
    telemetry_text(&answer->line, " #");
    telemetry_text(&answer->line, name);
    telemetry_text(&answer->line, " ");
}

static bool execute_help(answer_t *answer)
{
    uint16_t i;

    for (i = 0U; i < (uint16_t)PARAMETER_COUNT; i++) {
        begin_help(answer, parameter_table[i].name);
        answer_limits(answer, &parameter_table[i]);
        telemetry_text(&answer->line, " - ");
        telemetry_text(&answer->line, parameter_table[i].meaning);
        answer_send(answer);
    }
    for (i = 0U; i < VERB_COUNT; i++) {
        begin_help(answer, verbs[i].name);
        telemetry_text(&answer->line, verbs[i].meaning);
        answer_send(answer);
    }
    return true;
}

static void set_reference(float reference_m)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    reference.reference_m = reference_m;
    reference.sequence++;
    reference_server_write(&reference);
}

static bool execute_set(answer_t *answer, parameter_id_t id)
{
    const telecommand_t *command = answer->command;
    const parameter_row_t *row = &parameter_table[id];
    parameters_t parameters;
    float value = (float)parameter_choice(id, command->argument, command->argument_length);

    if (command->argument_length == 0U) {
        return answer_refuse(answer, "value missing");
    }
    if (row->choices == NULL && !decimal_read(command->argument, command->argument_length, &value)) {
        return answer_refuse(answer, "not a number");
    }
    parameter_server_read(&parameters);
    if (parameters_set(&parameters, id, value) != PARAMETER_ACCEPTED) {
        return answer_refuse_range(answer, row);
    }
    if (id == PARAMETER_SETR) {
        set_reference(value);
    } else {
        parameter_server_write(&parameters);
    }
    report_value(answer, id);
    return true;
}

static bool execute(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    parameter_id_t id = parameter_find(command->name, command->name_length);
    uint16_t i;

    if (id != PARAMETER_COUNT) {
        return execute_set(answer, id);
    }
    for (i = 0U; i < VERB_COUNT; i++) {
        if (strlen(verbs[i].name) == command->name_length &&
            strncmp(verbs[i].name, command->name, command->name_length) == 0) {
            return verbs[i].execute(answer);
        }
    }
    return answer_refuse(answer, "unknown command, try #HELP");
}

static void link_alive(uint32_t arrival_us)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    reference.link_time_us = arrival_us;
    reference.link_sequence++;
    reference_server_write(&reference);
}

static bool is_ping(const telecommand_t *command)
{
    return command->name_length == strlen("PING") && strncmp(command->name, "PING", command->name_length) == 0;
}

void commands_execute(const telecommand_line_t *line, uint32_t arrival_us)
{
    static const char *const reasons[] = {
        [TELECOMMAND_OK] = "",
        [TELECOMMAND_DAMAGED] = "line damaged",
        [TELECOMMAND_EMPTY] = "empty command",
        [TELECOMMAND_OVERLONG] = "line too long",
        [TELECOMMAND_CHARACTER] = "bad character",
    };
    static telecommand_t command;
    static answer_t answer;
    telecommand_status_t status = telecommand_parse(line, &command);

    if (status != TELECOMMAND_OK || !is_ping(&command)) {
        calibrator_stop();
    }
    answer.command = &command;
    if (status != TELECOMMAND_OK) {
        (void)answer_refuse(&answer, reasons[status]);
    } else if (execute(&answer)) {
        link_alive(arrival_us);
    }
}

void commands_continue(void)
{
    bool more = true;

    while (more && !xbee_port_waiting()) {
        more = verb_log_more();
        more = verb_calibrate_more() || more;
        if (more) {
            Task_sleep(CONTINUE_POLL_MS);
        }
    }
}

void commands_report_lost(uint16_t count)
{
    static telemetry_line_t line;

    telemetry_begin(&line);
    telemetry_text(&line, "ERR - ");
    telemetry_count(&line, count);
    telemetry_text(&line, " lines lost: sent too fast");
    telemetry_end(&line);
    xbee_port_answer(&line);
}
