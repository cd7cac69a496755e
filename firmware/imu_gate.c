#include "firmware/imu_gate.h"

#include <stddef.h>

#include "control/imu_axes.h"
#include "firmware/servers.h"

/* Where the angles contradict something. SWAPPED and RADIANS say it themselves. */
static const char *const reasons[][2] = {
    [IMU_ROLL] = {"IMU ROLL against gravity, see #IMU", "IMU ROLL against the mirrors, see #MIRRORS"},
    [IMU_PITCH] = {"IMU PITCH against gravity, see #IMU", "IMU PITCH against the mirrors, see #MIRRORS"},
    [IMU_BOTH] = {"IMU ROLL+PITCH against gravity, see #IMU",
                  "IMU ROLL+PITCH against the mirrors, see #MIRRORS"},
    [IMU_SWAPPED] = {"IMU SWAPPED: roll is pitch, see #IMU", "IMU SWAPPED: roll is pitch, see #MIRRORS"},
    [IMU_RADIANS] = {"IMU RADIANS: angles too small, see #IMU", NULL},
    [IMU_OTHER] = {"IMU ANGLES against gravity, see #IMU", NULL},
};
typedef char every_fault_has_a_reason[(sizeof reasons / sizeof reasons[0] == IMU_FAULT_COUNT) ? 1 : -1];

static const char *reason_of(const flight_outputs_t *flight)
{
    const uint16_t by_mirrors = (flight->imu_fault == flight->mirrors.imu) ? 1U : 0U;

    return (flight->imu_fault >= IMU_ROLL) ? reasons[flight->imu_fault][by_mirrors]
                                           : "IMU axes set but not proved, see #IMU";
}

/* On the ground only. In the air a refused order is a vehicle that nobody commands, which is worse
 * than a wrong axis. */
bool imu_gate_refuses(answer_t *answer)
{
    static parameters_t parameters;
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    parameter_server_read(&parameters);
    if (flight.state != FLIGHT_GROUND || !imu_axes_forbid(flight.imu_fault, &parameters)) {
        return false;
    }
    (void)answer_refuse(answer, reason_of(&flight));
    return true;
}

/* Unit and down concern the accelerations alone, and the laws do without these; an offset may be a slope. The
 * line is obeyed, and says what is wrong. */
void imu_gate_remark(answer_t *answer, bool assumed_too)
{
    static parameters_t parameters;
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    parameter_server_read(&parameters);
    if (flight.imu_fault == IMU_UNIT || flight.imu_fault == IMU_DOWN) {
        telemetry_text(&answer->line, " (IMU ");
        telemetry_text(&answer->line, imu_fault_name(flight.imu_fault));
        telemetry_text(&answer->line, " wrong, see #IMU)");
    } else if (flight.imu_fault == IMU_OFFSET) {
        telemetry_text(&answer->line, " (IMU OFFSET or a slope, see #MIRRORS)");
    } else if (assumed_too && parameters_choice(&parameters, PARAMETER_IAXES) == AXES_ASSUMED) {
        telemetry_text(&answer->line, " (IMU axes assumed, see #IMU)");
    }
}
