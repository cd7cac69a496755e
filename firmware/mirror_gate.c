#include "firmware/mirror_gate.h"

#include "firmware/servers.h"

static const char *const names[] = {[MIRROR_FRONT] = "FRONT", [MIRROR_FORE] = "FORE", [MIRROR_AFT] = "AFT"};
typedef char every_mirror_has_a_name[(sizeof names / sizeof names[0] == MIRROR_COUNT) ? 1 : -1];

static const char two_wrong[] = "two mirrors show no ground, see #MIRRORS";
static const char none_right[] = "height shows no ground: mirrors blocked, or past an edge";

static bool refuses(answer_t *answer, bool refused, const char *reason)
{
    return refused && !answer_refuse(answer, reason);
}

/* Nothing is refused in the air, as in imu_gate.c. */
bool mirror_gate_refuses_arm(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return flight.state == FLIGHT_GROUND &&
           refuses(answer, flight_mirrors_outvote(&flight.mirrors), two_wrong);
}

bool mirror_gate_refuses_reference(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return flight.state == FLIGHT_GROUND &&
           refuses(answer, flight_mirrors_forbid(&flight),
                   flight_mirrors_outvote(&flight.mirrors) ? two_wrong : none_right);
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
