#include "firmware/servers.h"

#include <stddef.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <xdc/std.h>

#include "firmware/geometry.h"
#include "firmware/imu_exchange.h"
#include "firmware/monitor.h"
#include "firmware/probe.h"

static GateMutexPri_Handle altitude_gate;
static GateMutexPri_Handle imu_gate;
static GateMutexPri_Handle laser_gate;
static GateMutexPri_Handle reference_gate;
static GateMutexPri_Handle parameter_gate;
static GateMutexPri_Handle flight_gate;

static altitude_sample_t altitude;
static imu_sample_t imu;
static imu_sample_t imu_history[IMU_HISTORY];
static uint16_t imu_next;
static laser_sample_t laser;
static reference_sample_t reference;
static parameters_t parameters;
static flight_outputs_t flight = FLIGHT_OUTPUTS_INITIAL;

const altitude_sample_t *const probe_altitude = &altitude;
const imu_sample_t *const probe_imu = &imu;
const laser_sample_t *const probe_laser = &laser;
const reference_sample_t *const probe_reference = &reference;
const parameters_t *const probe_parameters = &parameters;
const flight_outputs_t *const probe_flight = &flight;

static GateMutexPri_Handle gate_create(const char *name)
{
    GateMutexPri_Params params;

    GateMutexPri_Params_init(&params);
    params.instance->name = name;
    return GateMutexPri_create(&params, NULL);
}

void servers_create(void)
{
    altitude_gate = gate_create("Altitude_server");
    imu_gate = gate_create("IMU_server");
    laser_gate = gate_create("LaserStatus_server");
    reference_gate = gate_create("Reference_server");
    parameter_gate = gate_create("Parameter_server");
    flight_gate = gate_create("FlightStatus_server");
    /* What depends on the parameters is made here and at each change, not at each use: TaskIMU and
     * TaskReceiveLaser read it without a gate. */
    parameters_init(&parameters);
    imu_exchange_mount(&parameters);
    geometry_mount(&parameters);
    flight.state = FLIGHT_GROUND;
    flight.flags = FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_ATTITUDE;
}

/* GateMutexPri lets the holder inherit the priority of who waits. Without that a task in between could
 * delay TaskControl for as long as it likes. */
static IArg enter(GateMutexPri_Handle gate, monitor_server_t server)
{
    monitor_access_t access;
    IArg key;

    monitor_asking(server, &access);
    key = GateMutexPri_enter(gate);
    monitor_entered(server, &access);
    return key;
}

static void leave(GateMutexPri_Handle gate, monitor_server_t server, IArg key)
{
    /* The measurement is taken out inside the gate, and compared behind it: it must not lengthen what
     * it measures. */
    const monitor_access_t access = monitor_leaving(server);

    GateMutexPri_leave(gate, key);
    monitor_left(server, &access);
}

void altitude_server_write(const altitude_sample_t *sample)
{
    IArg key = enter(altitude_gate, MONITOR_ALTITUDE);

    altitude = *sample;
    leave(altitude_gate, MONITOR_ALTITUDE, key);
}

void altitude_server_read(altitude_sample_t *sample)
{
    IArg key = enter(altitude_gate, MONITOR_ALTITUDE);

    *sample = altitude;
    leave(altitude_gate, MONITOR_ALTITUDE, key);
}

void imu_server_write(const imu_sample_t *sample)
{
    IArg key = enter(imu_gate, MONITOR_IMU_SAMPLE);

    /* A frame that could not be read changes its counter only. The history is of frames that can be
     * used. */
    if (sample->sequence != imu.sequence) {
        imu_history[imu_next] = *sample;
        imu_next = (uint16_t)((imu_next + 1U) % IMU_HISTORY);
    }
    imu = *sample;
    leave(imu_gate, MONITOR_IMU_SAMPLE, key);
}

void imu_server_read(imu_sample_t *sample)
{
    IArg key = enter(imu_gate, MONITOR_IMU_SAMPLE);

    *sample = imu;
    leave(imu_gate, MONITOR_IMU_SAMPLE, key);
}

uint16_t imu_server_history(imu_sample_t history[IMU_HISTORY])
{
    IArg key = enter(imu_gate, MONITOR_IMU_SAMPLE);
    uint16_t held = (imu.sequence < IMU_HISTORY) ? (uint16_t)imu.sequence : (uint16_t)IMU_HISTORY;

    for (uint16_t i = 0U; i < held; ++i) {
        history[i] = imu_history[(imu_next + IMU_HISTORY - held + i) % IMU_HISTORY];
    }
    leave(imu_gate, MONITOR_IMU_SAMPLE, key);
    return held;
}

void laser_server_write(const laser_sample_t *sample)
{
    IArg key = enter(laser_gate, MONITOR_LASER_STATUS);

    laser = *sample;
    leave(laser_gate, MONITOR_LASER_STATUS, key);
}

void laser_server_read(laser_sample_t *sample)
{
    IArg key = enter(laser_gate, MONITOR_LASER_STATUS);

    *sample = laser;
    leave(laser_gate, MONITOR_LASER_STATUS, key);
}

void reference_server_write(const reference_sample_t *sample)
{
    IArg key = enter(reference_gate, MONITOR_REFERENCE);

    reference = *sample;
    leave(reference_gate, MONITOR_REFERENCE, key);
}

void reference_server_read(reference_sample_t *sample)
{
    IArg key = enter(reference_gate, MONITOR_REFERENCE);

    *sample = reference;
    leave(reference_gate, MONITOR_REFERENCE, key);
}

void parameter_server_write(const parameters_t *set)
{
    IArg key = enter(parameter_gate, MONITOR_PARAMETERS);

    parameters = *set;
    leave(parameter_gate, MONITOR_PARAMETERS, key);
    imu_exchange_mount(set);
    geometry_mount(set);
}

void parameter_server_read(parameters_t *set)
{
    IArg key = enter(parameter_gate, MONITOR_PARAMETERS);

    *set = parameters;
    leave(parameter_gate, MONITOR_PARAMETERS, key);
}

void flight_status_server_write(const flight_outputs_t *status)
{
    IArg key = enter(flight_gate, MONITOR_FLIGHT_STATUS);

    flight = *status;
    leave(flight_gate, MONITOR_FLIGHT_STATUS, key);
}

void flight_status_server_read(flight_outputs_t *status)
{
    IArg key = enter(flight_gate, MONITOR_FLIGHT_STATUS);

    *status = flight;
    leave(flight_gate, MONITOR_FLIGHT_STATUS, key);
}
