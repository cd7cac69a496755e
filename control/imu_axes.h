/* Does the IMU speak the convention that the parameters describe? On the ground gravity tells: its direction
 * in the accelerometer and the angles must agree, and its size must be g. A vehicle that stands a degree or
 * two off level is enough, or one that is tilted in the hand.
 *
 * An IMU that lies exactly level, one without accelerations, and one that is mounted the wrong way round
 * (its angles and accelerations then agree) cannot be judged so. Tilting by hand tells: `#IMU RIGHT`, `#IMU
 * NOSE`, and the parameter IAXES remembers that it did. In the air gravity is not felt: nothing is judged.
 * Pure; the caller owns the state. */
#ifndef CONTROL_IMU_AXES_H
#define CONTROL_IMU_AXES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/imu_sample.h"
#include "control/parameters.h"

typedef enum {
    IMU_SOUND,   /* nothing is known against it */
    IMU_UNIT,    /* |a| is more than 15 % off g */
    IMU_DOWN,    /* gravity points up */
    IMU_ROLL,    /* roll has the other sign than gravity */
    IMU_PITCH,   /* pitch has */
    IMU_BOTH,    /* both have */
    IMU_SWAPPED, /* roll and pitch stand in each other's place */
    IMU_RADIANS, /* the angles are far too small */
    IMU_OTHER,   /* angles and gravity disagree in none of these ways */
    IMU_FAULT_COUNT
} imu_fault_t;

typedef struct {
    uint32_t sequence, time_us;
    float seen_s; /* for how long without a gap, at most IMU_AXES_SEEN_S */
    float forward_mps2, right_mps2, down_mps2, roll_rad, pitch_rad; /* slow means */
    imu_fault_t suspected;
    float suspected_s;
    imu_fault_t fault; /* of the latest stay on the ground */
} imu_axes_t;

#define IMU_AXES_SEEN_S 3.0F /* chosen: 120 frames */

void imu_axes_init(imu_axes_t *axes);

/* Frames of one cycle, oldest first; those that were seen before change nothing. grounded: it stands or is
 * held in the hand, without thrust. noise_mps2: of the accelerometer, rms; the more, the more must disagree.
 */
void imu_axes_step(imu_axes_t *axes, const imu_sample_t *frames, uint16_t count, bool grounded,
                   float noise_mps2);

/* "UNIT", "DOWN", "ROLL" ...; IMU_SOUND: "-". */
const char *imu_fault_name(imu_fault_t fault);

/* The angles are wrong, and tilting by hand has not said otherwise; or their axes were set by hand and
 * nobody has tilted it since. The vehicle must not take off so. */
bool imu_axes_forbid(imu_fault_t fault, const parameters_t *parameters);

#endif
