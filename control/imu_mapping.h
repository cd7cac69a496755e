/* Converts the IMU's axes and unit to the vehicle's. This is the only place where that happens. Parameters
 * describe the mounting; the operator finds them with `#IMU LEVEL`, `RIGHT` and `NOSE`. The default
 * parameters fit a Razor with its own firmware, mounted as in docs/hardware.md. That IMU counts roll
 * positive with the right wing down. The vehicle counts roll positive with the mirror's side up, which is
 * the right side. Pure. */
#ifndef CONTROL_IMU_MAPPING_H
#define CONTROL_IMU_MAPPING_H

#include <stdbool.h>
#include <stdint.h>

#include "control/attitude.h"
#include "control/parameters.h"

/* One frame in the IMU's own axes: x to its nose, y to its right, z down. When it lies level, gravity is
 * measured along +z. Angles in radians. */
typedef struct {
    float yaw_rad, pitch_rad, roll_rad;
    bool has_acceleration;
    float x_counts, y_counts, z_counts;
} imu_raw_t;

typedef struct {
    uint16_t roll, pitch; /* control_axis_t: the IMU's angle that is the vehicle's roll or pitch */
    float counts_per_g;   /* of the accelerometer; < 0: it measures with the opposite sign */
} imu_mapping_t;

imu_mapping_t imu_mapping_of(const parameters_t *parameters);

/* Converts angles of the IMU to angles of the vehicle, radians. Works with the offset removed or not.
 * Vehicle: roll > 0 raises the mirror's side, pitch > 0 raises the nose. */
attitude_t imu_map_angles(const imu_mapping_t *mapping, const attitude_t *imu);
/* Converts an acceleration to the vehicle's axes, m/s2. The sign is that of the force that carries the
 * vehicle's weight as a scale shows it: at rest and level 0, 0, +9.81. */
void imu_map_acceleration(const imu_mapping_t *mapping, const imu_raw_t *raw, float *forward_mps2,
                          float *right_mps2, float *down_mps2);

/* Radians to degrees, the IMU's unit on the wire. */
float imu_degrees(float rad);

#endif
