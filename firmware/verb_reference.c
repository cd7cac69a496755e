#include "firmware/verb_reference.h"

#include <stddef.h>

#include "control/battery_orders.h"
#include "control/flight_io.h"
#include "drivers/decimal.h"
#include "firmware/imu_gate.h"
#include "firmware/mirror_gate.h"
#include "firmware/servers.h"

static const parameter_row_t limits = {.name = "SETR", .unit = "m", .maximum = FLIGHT_REFERENCE_MAX_M};

/* So that nobody waits for a take-off that does not come. */
static bool battery_refuses(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    if (!battery_orders_forbid((battery_verdict_t)flight.battery, flight.state)) {
        return false;
    }
    (void)answer_refuse(answer, "battery EMPTY, see #VOLTS");
    return true;
}

static void set_reference(float reference_m)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    reference.reference_m = reference_m;
    ++reference.sequence;
    reference_server_write(&reference);
}

void verb_reference_write_value(answer_t *answer)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    telemetry_begin(&answer->line);
    telemetry_text(&answer->line, "OK SETR ");
    telemetry_number(&answer->line, reference.reference_m);
}

bool verb_setr(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    float reference_m;

    if (command->argument_length == 0U) {
        return answer_refuse(answer, "value missing");
    }
    if (!decimal_read(command->argument, command->argument_length, &reference_m)) {
        return answer_refuse(answer, "not a number");
    }
    /* In this form it refuses NaN as well. */
    if (!(reference_m >= limits.minimum && reference_m <= limits.maximum)) {
        return answer_refuse_range(answer, &limits);
    }
    /* #SETR 0 lands, and landing is never refused. */
    if (reference_m > 0.0F &&
        (imu_gate_refuses(answer) || mirror_gate_refuses_reference(answer) || battery_refuses(answer))) {
        return false;
    }
    set_reference(reference_m + 0.0F); /* -0 becomes 0 */
    verb_reference_write_value(answer);
    if (reference_m > 0.0F) {
        imu_gate_remark(answer, false);
        mirror_gate_remark(answer);
    }
    answer_send(answer);
    return true;
}

bool verb_land(answer_t *answer)
{
    set_reference(0.0F);
    answer_begin(answer);
    answer_send(answer);
    return true;
}
