/* What stands between a take-off and an IMU that speaks another convention than the parameters say. Context:
 * Task, TaskReceiveComm only. */
#ifndef FIRMWARE_IMU_GATE_H
#define FIRMWARE_IMU_GATE_H

#include <stdbool.h>

#include "firmware/answer.h"

/* On the ground with angles that must not be flown by: sends `ERR NAME IMU ROLL against gravity, see #IMU`,
 * or `ERR NAME IMU axes set but not proved, see #IMU`, and returns true. */
bool imu_gate_refuses(answer_t *answer);

/* Appends ` (IMU UNIT wrong, see #IMU)` (or DOWN) where that is so; else, when assumed_too is true, ` (IMU
 * axes assumed, see #IMU)` where nobody has proved them by tilting. */
void imu_gate_remark(answer_t *answer, bool assumed_too);

#endif
