/* Does the IMU repeat one frame? An IMU whose attitude hangs goes on sending, and all that it says stays what
 * it was. That is silence, and not a vehicle that stands still: a living one never tells the same digits for
 * long.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_IMU_REPEAT_H
#define CONTROL_IMU_REPEAT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/imu_mapping.h"

typedef struct {
    imu_raw_t latest;
    uint16_t times; /* that it came again, in a row; counted to a most */
} imu_repeat_t;

/* One frame. True when it repeats the ones before and must not be used: it says nothing new. */
bool imu_repeats(imu_repeat_t *repeat, const imu_raw_t *frame);

#endif
