/* From the IMU's own axes and unit to the vehicle's: the one place for it, by parameters that the operator finds with `#IMU
 * LEVEL`, `RIGHT` and `NOSE`. A Razor with its own firmware, mounted as docs/hardware.md says, needs the delivered ones: it
 * counts roll positive with the right wing down, the vehicle with the mirror's side, which is the right, up. Pure. */
#ifndef CONTROL_IMU_MAPPING_H
#define CONTROL_IMU_MAPPING_H

#include <stdbool.h>
#include <stdint.h>

#include "control/attitude.h"
#include "control/parameters.h"

/* A frame as the IMU means it: x to its nose, y to its right, z down; gravity is felt along +z when it lies level. */
typedef struct {
    float yaw_rad, pitch_rad, roll_rad;
    bool has_acceleration;
    float x_counts, y_counts, z_counts;
} imu_raw_t;

typedef struct {
    uint16_t roll, pitch;   /* control_axis_t: which of the IMU's angles it is */
    float counts_per_g;     /* of the accelerometer; below 0: it tells the opposite */
} imu_mapping_t;

imu_mapping_t imu_mapping_of(const parameters_t *parameters);

/* Angles of the IMU, less their offset or not, to those of the vehicle: roll > 0 raises the mirror's side, pitch > 0 the
 * nose. */
attitude_t imu_map_angles(const imu_mapping_t *mapping, const attitude_t *imu);
/* What a scale would feel along the axes that belong to those angles: at rest and level 0, 0, +9.81. */
void imu_map_acceleration(const imu_mapping_t *mapping, const imu_raw_t *raw, float *forward_mps2, float *right_mps2,
                          float *down_mps2);

/* As the IMU writes angles. */
float imu_degrees(float rad);

#endif
