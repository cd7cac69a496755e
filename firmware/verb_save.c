#include <stddef.h>

#include "firmware/ground.h"
#include "firmware/parameter_store.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"
#include "firmware/version.h"

static const char *const reasons[] = {
    [PARAMETER_STORE_EMPTY] = "nothing stored",
    [PARAMETER_STORE_DAMAGED] = "stored set damaged",
    [PARAMETER_STORE_FOREIGN] = "stored by another firmware, this is " PLOMADA_VERSION,
    [PARAMETER_STORE_FAULT] = "storage fault",
};

static bool refuse_stored(answer_t *answer, const parameter_row_t *row)
{
    telemetry_begin_answer(&answer->line);
    telemetry_text(&answer->line, "ERR ");
    telemetry_characters(&answer->line, answer->command->name, answer->command->name_length);
    telemetry_text(&answer->line, " stored ");
    telemetry_text(&answer->line, row->name);
    telemetry_text(&answer->line, " out of range ");
    answer_limits(answer, row);
    answer_send(answer);
    return false;
}

static bool report(answer_t *answer, const parameter_store_result_t *result)
{
    if (result->status == PARAMETER_STORE_RANGE) {
        return refuse_stored(answer, &parameter_table[result->parameter]);
    }
    if (result->status != PARAMETER_STORE_DONE) {
        return answer_refuse(answer, reasons[result->status]);
    }
    answer_begin(answer);
    answer_count(answer, "generation", result->generation);
    answer_send(answer);
    return true;
}

static parameter_store_result_t load(void)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    const parameter_store_result_t result = parameter_store_load(&parameters);
    if (result.status == PARAMETER_STORE_DONE) {
        parameter_server_write(&parameters);
    }
    return result;
}

/* False after the refusal. */
/* To erase the flash takes tens of milliseconds without interrupts, and a stored set may change
 * everything at once. Neither is for a vehicle that flies. */
static bool admit_on_ground(answer_t *answer)
{
    return ground_idle() ||
           answer_refuse(answer, ground_waits() ? "motors idle, see #STOP" : "not on the ground");
}

bool verb_save(answer_t *answer)
{
    static parameters_t parameters;
    static laser_sample_t laser;

    if (!admit_on_ground(answer)) {
        return false;
    }
    parameter_server_read(&parameters);
    laser_server_read(&laser);
    parameter_store_result_t result = parameter_store_save(&parameters, laser.power_up_rate);
    return report(answer, &result);
}

bool verb_load(answer_t *answer)
{

    if (!admit_on_ground(answer)) {
        return false;
    }
    parameter_store_result_t result = load();
    return report(answer, &result);
}

/* `#DEFAULTS SEED`: the law and the gains of the seed, nothing else. */
static bool set_seed(answer_t *answer)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    parameters_set_seed(&parameters);
    parameter_server_write(&parameters);
    answer_begin(answer);
    telemetry_text(&answer->line, " SEED");
    answer_send(answer);
    return true;
}

static bool set_defaults(answer_t *answer)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    /* It counts on: whoever compares it sees that the set is another one. */
    const uint32_t generation = parameters.generation;
    parameters_init(&parameters);
    parameters.generation = generation + 1U;
    parameter_server_write(&parameters);
    answer_begin(answer);
    answer_send(answer);
    return true;
}

bool verb_defaults(answer_t *answer)
{
    const bool seed = answer_argument_is(answer, "SEED");

    if (!seed && answer->command->argument_length > 0U) {
        return answer_refuse(answer, "one of SEED");
    }
    if (!admit_on_ground(answer)) {
        return false;
    }
    return seed ? set_seed(answer) : set_defaults(answer);
}

void verb_load_at_start(void)
{
    static const telecommand_t command = {.name = "LOAD", .name_length = 4U};
    static answer_t answer;
    const parameter_store_result_t result = load();

    answer.command = &command;
    /* A new board has nothing stored, and nothing is wrong with that. All else the operator must know
     * before he flies. */
    if (result.status != PARAMETER_STORE_EMPTY) {
        (void)report(&answer, &result);
    }
}
