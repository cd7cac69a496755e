#include "firmware/commands.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/answer.h"
#include "bsp/timebase.h"
#include "firmware/calibrator.h"
#include "firmware/ground.h"
#include "firmware/imu_gate.h"
#include "firmware/mirror_gate.h"
#include "drivers/decimal.h"
#include "control/in_air.h"
#include "control/parameters.h"
#include "firmware/listing.h"
#include "firmware/servers.h"
#include "firmware/verb_reference.h"
#include "firmware/verbs.h"
#include "firmware/version.h"
#include "firmware/xbee_port.h"

#define CONTINUE_POLL_MS 10U /* ten characters leave meanwhile */
#define BARE_ANSWER_US 1000000UL

typedef struct {
    const char *name;
    bool (*execute)(answer_t *answer);
    const char *takes; /* as #HELP tells it; "": refuses a value; NULL: ignores it, for it is never refused */
    const char *meaning;
} verb_t;

/* Between begin and end; on the way of `#GET` the name of the command differs from that of the row. */
static void write_value(answer_t *answer, parameter_id_t id)
{
    const parameter_row_t *row = &parameter_table[id];
    static parameters_t parameters;

    parameter_server_read(&parameters);
    const float value = parameters.value[id];
    telemetry_begin(&answer->line);
    telemetry_text(&answer->line, "OK ");
    telemetry_text(&answer->line, row->name);
    telemetry_text(&answer->line, " ");
    if (row->choices != NULL) {
        telemetry_text(&answer->line, row->choices[(uint16_t)value]);
    } else {
        telemetry_number(&answer->line, value);
    }
}

/* A gain that the law in force has no use for is set all the same, but its answer says so. */
static void report_set(answer_t *answer, parameter_id_t id)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    const control_law_t law = (control_law_t)(uint16_t)parameters.value[PARAMETER_LAW];
    write_value(answer, id);
    if (!parameter_is_used(id, law)) {
        telemetry_text(&answer->line, " (LAW ");
        telemetry_text(&answer->line, parameter_table[PARAMETER_LAW].choices[law]);
        telemetry_text(&answer->line, " does not use it)");
    }
    answer_send(answer);
}

/* The reference first, then the parameters. */
static bool write_setting(answer_t *answer, uint16_t number)
{
    if (number == 0U) {
        verb_reference_write_value(answer);
    } else if (number <= (uint16_t)PARAMETER_COUNT) {
        write_value(answer, (parameter_id_t)(number - 1U));
    }
    return number <= (uint16_t)PARAMETER_COUNT;
}

static bool execute_get(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    uint16_t id = (uint16_t)parameter_find(command->argument, command->argument_length);

    if (command->argument_length == 0U) {
        return listing_start(answer, write_setting);
    }
    if (answer_argument_is(answer, "SETR")) {
        verb_reference_write_value(answer);
    } else if (id < (uint16_t)PARAMETER_COUNT) {
        write_value(answer, (parameter_id_t)id);
    } else {
        return answer_refuse(answer, "unknown parameter");
    }
    answer_send(answer);
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

static bool execute_version(answer_t *answer)
{
    answer_begin(answer);
    telemetry_text(&answer->line, " " PLOMADA_VERSION);
    answer_send(answer);
    return true;
}

/* Read, changed and written in two accesses: no other task writes this server, so nothing comes
 * between. */
static void set_arm(bool arm)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    reference.arm = arm;
    ++reference.arm_sequence;
    reference_server_write(&reference);
}

/* An IMU that contradicts gravity turns the height the wrong way with the first tilt: better said
 * before the motors turn. */
static bool execute_arm(answer_t *answer)
{
    static parameters_t parameters;

    if (!ground_waits()) {
        return answer_refuse(answer, "not on the ground");
    }
    if (imu_gate_refuses(answer) || mirror_gate_refuses_arm(answer)) {
        return false;
    }
    set_arm(true);
    parameter_server_read(&parameters);
    answer_begin(answer);
    telemetry_text(&answer->line, " idle:");
    telemetry_number(&answer->line, parameters.value[PARAMETER_IDLE]);
    telemetry_text(&answer->line, "%");
    imu_gate_remark(answer, true);
    mirror_gate_remark(answer);
    answer_send(answer);
    return true;
}

/* In the air it lands first: to disarm there would let the vehicle fall. */
static bool execute_stop(answer_t *answer)
{
    set_arm(false);
    return verb_land(answer);
}

static bool execute_help(answer_t *answer);

static const verb_t verbs[] = {
    {"SETR", verb_setr, "0..3 m", "height reference; 0 lands"},
    {"ARM", execute_arm, "",
     "on the ground: IDLE percent of throttle instead of none, which keeps started motors turning"},
    {"STOP", execute_stop, NULL,
     "disarms: no throttle on the ground, in the air it lands first; goes before all that waits"},
    {"LAND", verb_land, NULL, "lands, as #SETR 0; goes before all that waits"},
    {"GET", execute_get, "[NAME]", "one parameter, or all"},
    {"SAVE", verb_save, "", "stores the parameters"},
    {"LOAD", verb_load, "", "the stored parameters"},
    {"DEFAULTS", verb_defaults, "[SEED]",
     "the parameters as delivered, or the seed's law and gains; the stored ones stay"},
    {"LOG", verb_log, "[SECONDS|CLEAR|STOP|RATE FAST|RATE SLOW]", "the flight recorder as CSV"},
    {"CALIBRATE", verb_calibrate, "[COUNTS [SECONDS]]",
     "thrust step by step, tied down; any line but #PING ends it"},
    {"RC", verb_rc, "", "the pulse of the pilot's stick, and whether it counts"},
    {"VOLTS", verb_volts, "", "the battery: its voltage, that of a cell, and how it is"},
    {"LASER", verb_laser, "", "the scanner's state, rate, frames and errors by cause"},
    {"IMU", verb_imu, "[LEVEL|RIGHT|NOSE]",
     "what the IMU sends; finds its unit and axes from how the vehicle is held"},
    {"MIRRORS", verb_mirrors, "",
     "whether each mirror showed the ground at rest, and what they tell of the IMU"},
    {"PERF", verb_perf, "[COSTS|RESET]",
     "responses, deadlines, stacks, load, waits; processor times; RESET clears them"},
    {"STREAM", verb_stream, "PULSE|OFF", "the pulse of each control cycle in place of telemetry"},
    {"HANG", verb_hang, "TASK", "hangs a task, for a test of the watchdog; on the ground only"},
    {"PING", execute_ping, "[TEXT]", "answers the same text"},
    {"VERSION", execute_version, "", "the firmware's version"},
    {"HELP", execute_help, "", "this list"},
};
#define VERB_COUNT (sizeof verbs / sizeof verbs[0])

static void begin_help(answer_t *answer, const char *name)
{
    answer_begin(answer);
    telemetry_text(&answer->line, " #");
    telemetry_text(&answer->line, name);
    telemetry_text(&answer->line, " ");
}

static void write_takes(answer_t *answer, const char *takes)
{
    if (takes != NULL && takes[0] != '\0') {
        telemetry_text(&answer->line, takes);
        telemetry_text(&answer->line, " ");
    }
}

static bool write_help(answer_t *answer, uint16_t number)
{
    const uint16_t verb = (uint16_t)(number - (uint16_t)PARAMETER_COUNT);

    if (number < (uint16_t)PARAMETER_COUNT) {
        begin_help(answer, parameter_table[number].name);
        answer_limits(answer, &parameter_table[number]);
        telemetry_text(&answer->line, " - ");
        telemetry_text(&answer->line, parameter_table[number].meaning);
        return true;
    }
    if (verb < VERB_COUNT) {
        begin_help(answer, verbs[verb].name);
        write_takes(answer, verbs[verb].takes);
        telemetry_text(&answer->line, "- ");
        telemetry_text(&answer->line, verbs[verb].meaning);
    }
    return verb < VERB_COUNT;
}

static bool execute_help(answer_t *answer)
{
    return listing_start(answer, write_help);
}

/* In the air only what the pace there allows. False: refused, and answered. */
static bool admit_change(answer_t *answer, const parameters_t *parameters, parameter_id_t id, float value)
{
    static const char *const reasons[] = {
        [IN_AIR_NEVER] = "not on the ground",
        [IN_AIR_TOO_MANY_N] = "in the air by 0.2 N in 10 s at most",
        [IN_AIR_OVER_QUARTER] = "in the air by a quarter in 10 s at most",
        [IN_AIR_TOO_OFTEN] = "in the air once in 10 s, EST at any time",
        [IN_AIR_OFF_HOVER] = "would put the hover thrust out of reach",
    };
    static in_air_pace_t pace;
    flight_outputs_t flight;

    if (!ground_left()) {
        return true;
    }
    flight_status_server_read(&flight);
    const in_air_t verdict = in_air_change(&pace, parameters, id, value, flight.hover_n, bsp_time_us());
    return verdict == IN_AIR_FINE || answer_refuse(answer, reasons[verdict]);
}

static bool execute_set(answer_t *answer, parameter_id_t id)
{
    const telecommand_t *command = answer->command;
    const parameter_row_t *row = &parameter_table[id];
    static parameters_t parameters, changed;
    float value = (float)parameter_find_choice(id, command->argument, command->argument_length);

    if (command->argument_length == 0U) {
        return answer_refuse(answer, "value missing");
    }
    if (row->choices == NULL && !decimal_read(command->argument, command->argument_length, &value)) {
        return answer_refuse(answer, "not a number");
    }
    parameter_server_read(&parameters);
    /* The limits are asked on a copy, so that a refused value has changed nothing for anybody. */
    changed = parameters;
    if (parameters_set(&changed, id, value) != PARAMETER_ACCEPTED) {
        return answer_refuse_range(answer, row);
    }
    if (!admit_change(answer, &parameters, id, value)) {
        return false;
    }
    /* What was proved by hand was proved for the axis of before. */
    if ((id == PARAMETER_IROLL || id == PARAMETER_IPITCH) && value != parameters.value[id]) {
        (void)parameters_set(&changed, PARAMETER_IAXES, (float)AXES_ASSUMED);
    }
    parameter_server_write(&changed);
    report_set(answer, id);
    return true;
}

/* `#ARM 0` looks like the opposite of what it would do. A value that nobody reads is a
 * misunderstanding. */
static bool execute_verb(answer_t *answer, const verb_t *verb)
{
    if (verb->takes != NULL && verb->takes[0] == '\0' && answer->command->argument_length > 0U) {
        return answer_refuse(answer, "takes no value");
    }
    return verb->execute(answer);
}

static bool execute(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    parameter_id_t id = parameter_find(command->name, command->name_length);

    if (id != PARAMETER_COUNT) {
        return execute_set(answer, id);
    }
    for (uint16_t i = 0U; i < VERB_COUNT; ++i) {
        if (strlen(verbs[i].name) == command->name_length &&
            strncmp(verbs[i].name, command->name, command->name_length) == 0) {
            return execute_verb(answer, &verbs[i]);
        }
    }
    return answer_refuse(answer, "unknown command, try #HELP");
}

/* Of obeyed lines only: noise that looks like a line is not an operator who is there. */
static void link_alive(uint32_t arrival_us)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    reference.link_time_us = arrival_us;
    ++reference.link_sequence;
    reference_server_write(&reference);
}

static bool is_named(const telecommand_t *command, const char *name)
{
    return strlen(name) == command->name_length && strncmp(name, command->name, command->name_length) == 0;
}

/* What starts motors, or keeps them turning. All other lines may be obeyed late. */
static bool starts(const telecommand_t *command)
{
    return is_named(command, "SETR") || is_named(command, "CALIBRATE") || is_named(command, "ARM");
}

/* A stop that was typed later has been obeyed already. */
static bool refuse_overtaken(answer_t *answer, const xbee_message_t *message)
{
    if (!message->overtaken || !starts(answer->command)) {
        return false;
    }
    (void)answer_refuse(answer, "overtaken by a stop");
    return true;
}

static void refuse_line(answer_t *answer, telecommand_status_t status, uint32_t arrival_us)
{
    static const char *const reasons[] = {
        [TELECOMMAND_OK] = "",
        [TELECOMMAND_DAMAGED] = "line damaged",
        [TELECOMMAND_BARE] = "commands begin with #",
        [TELECOMMAND_EMPTY] = "empty command",
        [TELECOMMAND_OVERLONG] = "line too long",
        [TELECOMMAND_SUM_WRONG] = "wrong sum",
        [TELECOMMAND_SUM_MISSING] = "sum missing, see #SUM",
        [TELECOMMAND_CHARACTER] = "bad character",
    };
    static uint32_t bare_us;
    static bool bare;

    /* Without `#` it is mostly a radio at another rate or another talker. Answers to each of its lines
     * would fill the air. */
    if (status == TELECOMMAND_BARE) {
        if (bare && arrival_us - bare_us < BARE_ANSWER_US) {
            return;
        }
        bare = true;
        bare_us = arrival_us;
    }
    (void)answer_refuse(answer, reasons[status]);
}

static bool sum_required(void)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    return parameters_choice(&parameters, PARAMETER_SUM) == (uint16_t)SUM_ON;
}

void commands_execute(const xbee_message_t *message)
{
    static telecommand_t command;
    static answer_t answer;
    const telecommand_status_t status = telecommand_parse(&message->line, sum_required(), &command);

    /* Whatever the line says: in trouble people type anything, and that must end a calibration. A ping
     * does not, because it keeps the link alive meanwhile. */
    if (status != TELECOMMAND_OK || !is_named(&command, "PING")) {
        calibrator_stop();
    }
    answer.command = &command;
    if (status != TELECOMMAND_OK) {
        refuse_line(&answer, status, message->arrival_us);
    } else if (!refuse_overtaken(&answer, message) && execute(&answer)) {
        link_alive(message->arrival_us);
    }
}

/* A line that has come must wait: a list ends first, and its answer needs room. A stop never waits. */
static bool held_up(void)
{
    if (xbee_port_pressing()) {
        return false;
    }
    return listing_more() || (xbee_port_waiting() && !xbee_port_clear());
}

/* Sends of the others what there is room for. True: there is more, and no line to take. */
static bool goes_on(void)
{
    if (xbee_port_waiting()) {
        return false;
    }
    const bool more = verb_log_more();
    return verb_calibrate_more() || more;
}

/* Lists and dumps take seconds on this radio. They are sent piece by piece where there is room, so
 * that a stop never waits behind them. */
uint32_t commands_continue(void)
{
    uint32_t free_us = bsp_time_us();
    bool held = held_up();

    while (held || goes_on()) {
        Task_sleep(CONTINUE_POLL_MS);
        /* While a list holds a line up, the task is not free for it: that wait is not the line's
         * response. */
        if (held && !xbee_port_pressing()) {
            free_us = bsp_time_us();
        }
        held = held_up();
    }
    return free_us;
}

/* A line that got lost is worse than one that is refused: the operator believes it obeyed. There is no
 * name to answer to, so their number is told. */
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
