/* For a debugger's watch window: the servers' values as they stand, without their gates, so possibly half written while
 * the processor runs. No task reads these. */
#ifndef FIRMWARE_WATCH_H
#define FIRMWARE_WATCH_H

#include "firmware/servers.h"

extern const altitude_sample_t *const watch_altitude;
extern const imu_sample_t *const watch_imu; /* newest */
extern const laser_sample_t *const watch_laser;
extern const reference_sample_t *const watch_reference;
extern const parameters_t *const watch_parameters;
extern const flight_outputs_t *const watch_flight;

#endif
