#include "firmware/mirror_gate.h"

#include "firmware/servers.h"

static const char *const names[] = {[MIRROR_FRONT] = "FRONT", [MIRROR_FORE] = "FORE", [MIRROR_AFT] = "AFT"};
typedef char every_mirror_has_a_name[(sizeof names / sizeof names[0] == MIRROR_COUNT) ? 1 : -1];

/* Nothing is refused in the air, as in imu_gate.c. */
bool mirror_gate_refuses(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    if (flight.state != FLIGHT_GROUND || !flight_mirrors_forbid(&flight.mirrors)) {
        return false;
    }
    (void)answer_refuse(answer, "two mirrors show no ground, see #MIRRORS");
    return true;
}

void mirror_gate_names(answer_t *answer, uint16_t mirrors)
{
    const char *between = "";

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if ((mirrors & (1U << m)) != 0U) {
            telemetry_text(&answer->line, between);
            telemetry_text(&answer->line, names[m]);
            between = "+";
        }
    }
    telemetry_text(&answer->line, (mirrors == 0U) ? "-" : "");
}

void mirror_gate_remark(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    if (flight.state == FLIGHT_GROUND && flight.mirrors.wrong != 0U) {
        telemetry_text(&answer->line, " (mirror ");
        mirror_gate_names(answer, flight.mirrors.wrong);
        telemetry_text(&answer->line, " shows no ground, see #MIRRORS)");
    }
}
