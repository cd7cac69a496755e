/* Finds the axes and the unit of an IMU. The operator holds the vehicle level, then raises its right side,
 * then its nose. Pure; the caller owns the parameters. */
#ifndef CONTROL_IMU_FINDING_H
#define CONTROL_IMU_FINDING_H

#include <stdbool.h>

#include "control/imu_mapping.h"

/* Vehicle level and at rest. Finds which way down is, and the unit of the accelerometer: 256, 1, 9.80665
 * or 1000 counts per g, within 15 %. Returns false and sets nothing when there are no accelerations, or
 * when they fit none of these units. */
bool imu_find_level(parameters_t *parameters, const imu_raw_t *raw);

/* One side of the vehicle was raised since `level` was taken. id: PARAMETER_IROLL or PARAMETER_IPITCH,
 * which is set to the IMU's angle that has turned by 8 to 60 degrees. The other angle must have turned by
 * less than half of that. Returns false and sets nothing when this is not so. */
bool imu_find_axis(parameters_t *parameters, parameter_id_t id, const imu_raw_t *level, const imu_raw_t *raw);

#endif
