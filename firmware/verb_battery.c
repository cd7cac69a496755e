#include "control/battery.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"

bool verb_volts(answer_t *answer)
{
    static parameters_t parameters;
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    parameter_server_read(&parameters);
    const float cells = (float)(parameters_choice(&parameters, PARAMETER_CELLS) + CELLS_FEWEST);
    answer_begin(answer);
    telemetry_text(&answer->line, " volts:");
    telemetry_fixed(&answer->line, flight.battery_v, 2U);
    telemetry_text(&answer->line, " cell:");
    telemetry_fixed(&answer->line, flight.battery_v / cells, 2U);
    telemetry_text(&answer->line, " battery:");
    telemetry_text(&answer->line, battery_name(flight.battery));
    telemetry_text(&answer->line, (flight.battery == (uint16_t)BATTERY_OFF) ? " (#BAT PIN)" : "");
    answer_send(answer);
    return true;
}
