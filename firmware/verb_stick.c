#include <math.h>

#include "control/where/flight_state.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"

static const char *why(const flight_outputs_t *flight, const parameters_t *parameters)
{
    if (parameters_choice(parameters, PARAMETER_STICK) == STICK_NONE) {
        return "OFF (#STICK PIN)";
    }
    if (parameters_choice(parameters, PARAMETER_SEL) == SEL_NONE) {
        return "OFF (#SEL PIN)";
    }
    if (isnan(flight->stick_us)) {
        return "SILENT (no pulses, or noise)";
    }
    return ((flight->flags & FLIGHT_FLAG_STICK) != 0U) ? "WAITS (for the middle)" : "COUNTS";
}

bool verb_rc(answer_t *answer)
{
    static parameters_t parameters;
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    parameter_server_read(&parameters);
    answer_begin(answer);
    telemetry_text(&answer->line, " pulse:");
    telemetry_fixed(&answer->line, flight.stick_us, 0U);
    telemetry_text(&answer->line, " stick:");
    telemetry_text(&answer->line, why(&flight, &parameters));
    answer_send(answer);
    return true;
}
