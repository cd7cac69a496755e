/* Checks on the ground whether the axes and units of the IMU are as the parameters describe them. The
 * measured gravity must have the size g, and its direction must agree with the angles. The check needs a
 * vehicle that is a degree or two off level, or one that is tilted by hand.
 *
 * Three cases cannot be found in this way: an IMU that is exactly level, an IMU without accelerations, and an
 * IMU that is mounted the wrong way round (its angles and accelerations agree). For these the operator tilts
 * the vehicle by hand (`#IMU RIGHT`, `#IMU NOSE`), and the parameter IAXES stores that it was done. In the
 * air the accelerometer does not measure gravity alone, so nothing is checked there. Pure; the caller owns
 * the state. */
#ifndef CONTROL_IMU_AXES_H
#define CONTROL_IMU_AXES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/credible.h"
#include "control/imu_sample.h"
#include "control/parameters.h"

typedef enum {
    IMU_SOUND,   /* no fault found */
    IMU_UNIT,    /* |a| is more than 15 % off g */
    IMU_DOWN,    /* gravity is measured upwards */
    IMU_OFFSET,  /* angles off by more than a degree, or a slope; found by the mirrors alone, sense/plane.h */
    IMU_ROLL,    /* roll has the wrong sign */
    IMU_PITCH,   /* pitch has the wrong sign */
    IMU_BOTH,    /* both have the wrong sign */
    IMU_SWAPPED, /* roll and pitch are exchanged */
    IMU_RADIANS, /* the angles are far too small: radians instead of degrees */
    IMU_OTHER,   /* angles and gravity disagree in another way */
    IMU_FAULT_COUNT
} imu_fault_t;

typedef struct {
    uint32_t sequence, time_us;
    float seen_s; /* time without a gap, at most IMU_AXES_SEEN_S */
    float forward_mps2, right_mps2, down_mps2, roll_rad, pitch_rad; /* slow means */
    imu_fault_t suspected;
    float suspected_s;
    imu_fault_t fault; /* result of the latest time on the ground */
} imu_axes_t;

#define IMU_UNIT_SHARE \
    (BIAS_MAX_MPS2 / IMU_GRAVITY_MPS2) /* an accelerometer's errors; a wrong unit's are more */
#define IMU_AXES_SEEN_S (REST_TIME_S + REST_HELD_S)
#define IMU_OFFSET_RAD 0.0175F   /* 1 degree: 4 mm of height by the front mirror's arm. Less is not told */
#define IMU_STEEP_RAD 1.0471976F /* chosen: 60 degrees */

void imu_axes_init(imu_axes_t *axes);

/* Call once in each cycle. frames: oldest first, borrowed for the call; frames that were processed before
 * change nothing. grounded: the vehicle has no thrust, on the ground or in the hand. noise_mps2: rms noise of
 * the accelerometer; the higher it is, the larger a disagreement must be. */
void imu_axes_step(imu_axes_t *axes, const imu_sample_t *frames, uint16_t count, bool grounded,
                   float noise_mps2);

/* "UNIT", "DOWN", "ROLL" ...; IMU_SOUND: "-". */
const char *imu_fault_name(imu_fault_t fault);

/* What gravity and the mirrors have found, together: first of all what forbids to take off. */
imu_fault_t imu_axes_worse(imu_fault_t by_gravity, imu_fault_t by_mirrors);

/* True when the vehicle must not take off, because nobody has proved the axes by tilting (IAXES ASSUMED), and
 * either a fault of the angles was found, or IROLL or IPITCH is not the default. */
bool imu_axes_forbid(imu_fault_t fault, const parameters_t *parameters);

#endif
