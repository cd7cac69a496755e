/* Refuses a take-off when the IMU's axes or units are not as the parameters describe them
 * (control/imu_axes.h). Context: Task, TaskReceiveComm only. */
#ifndef FIRMWARE_IMU_GATE_H
#define FIRMWARE_IMU_GATE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* Returns true on the ground when imu_axes_forbid() is true. Then it has sent `ERR NAME IMU ROLL against
 * gravity, see #IMU`, the same with `the mirrors, see #MIRRORS`, or `ERR NAME IMU axes set but not proved,
 * see #IMU`. Otherwise sends nothing. */
bool imu_gate_refuses(answer_t *answer);

/* Appends ` (IMU UNIT wrong, see #IMU)`, or the same with DOWN, when that fault was found; or ` (IMU OFFSET
 * or a slope, see #MIRRORS)`. Otherwise, when assumed_too is true and the axes are not proved, appends ` (IMU
 * axes assumed, see #IMU)`. */
void imu_gate_remark(answer_t *answer, bool assumed_too);

#endif
