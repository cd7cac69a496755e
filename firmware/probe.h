/* Pointers to the latest values of the servers, for a debugger's watch window. The PC board's log and
 * metrics read them too, between two events of the simulated processor. They are read without the gates,
 * so on the chip a value may be half written while the processor runs. No task reads them. */
#ifndef FIRMWARE_PROBE_H
#define FIRMWARE_PROBE_H

#include "firmware/servers.h"

extern const altitude_sample_t *const probe_altitude;
extern const imu_sample_t *const probe_imu; /* newest */
extern const laser_sample_t *const probe_laser;
extern const reference_sample_t *const probe_reference;
extern const parameters_t *const probe_parameters;
extern const flight_outputs_t *const probe_flight;

#endif
