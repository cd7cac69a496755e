#include "control/imu_axes.h"
#include "control/imu_mapping.h"
#include "firmware/mirror_gate.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"

static const char *const fields[] = {
    [MIRROR_FRONT] = " front_mm:", [MIRROR_FORE] = " fore_mm:", [MIRROR_AFT] = " aft_mm:"};
typedef char every_mirror_has_a_field[(sizeof fields / sizeof fields[0] == MIRROR_COUNT) ? 1 : -1];

static void add_rest(answer_t *answer, const flight_mirrors_t *found)
{
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        telemetry_text(&answer->line, fields[m]);
        telemetry_fixed(&answer->line, found->rest_mm[m], 0U);
    }
    telemetry_text(&answer->line, " wrong:");
    mirror_gate_names(answer, found->wrong);
}

static void add_imu(answer_t *answer, const flight_mirrors_t *found)
{
    telemetry_text(&answer->line, " imu_roll_off_deg:");
    telemetry_fixed(&answer->line, imu_degrees(found->off_roll_rad), 1U);
    telemetry_text(&answer->line, " imu_pitch_off_deg:");
    telemetry_fixed(&answer->line, imu_degrees(found->off_pitch_rad), 1U);
    telemetry_text(&answer->line, " imu:");
    telemetry_text(&answer->line, imu_fault_name(found->imu));
}

bool verb_mirrors(answer_t *answer)
{
    static parameters_t parameters;
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    parameter_server_read(&parameters);
    answer_begin(answer);
    if (parameters_choice(&parameters, PARAMETER_LAYOUT) == LAYOUT_THREE) {
        add_rest(answer, &flight.mirrors);
        add_imu(answer, &flight.mirrors);
    } else {
        telemetry_text(&answer->line, " OFF (#LAYOUT THREE)");
    }
    answer_send(answer);
    return true;
}
