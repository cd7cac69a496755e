/* Finds the axes and the unit of an IMU from how the vehicle is held: level, its right side raised, its nose raised. Pure. */
#ifndef CONTROL_IMU_FINDING_H
#define CONTROL_IMU_FINDING_H

#include <stdbool.h>

#include "control/imu_mapping.h"

/* Level and at rest: the unit of the accelerometer (256, 1, 9.80665 or 1000 counts per g, within 15 %) and which way down is.
 * False: no accelerations, or they are none of these; nothing is set. */
bool imu_find_level(parameters_t *parameters, const imu_raw_t *raw);

/* One side of the vehicle raised since it was level: sets PARAMETER_IROLL or PARAMETER_IPITCH to the angle of the IMU that turned by 8 to
 * 60 degrees, the other one by less than half of it. False: it did not; nothing is set. */
bool imu_find_axis(parameters_t *parameters, parameter_id_t id, const imu_raw_t *level, const imu_raw_t *raw);

#endif
