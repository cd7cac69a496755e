/* Exchange between TaskIMU and TaskReceiveComm: the mounting of the IMU, and its latest frame. */
#ifndef FIRMWARE_IMU_EXCHANGE_H
#define FIRMWARE_IMU_EXCHANGE_H

#include <stdint.h>

#include "control/imu_mapping.h"
#include "drivers/razor.h"

typedef struct {
    razor_text_t text;
    razor_status_t status;
    imu_raw_t raw;      /* latest frame with status OK */
    uint32_t frames;    /* frames with status OK so far */
    uint32_t period_us; /* time between the latest two of them */
} imu_view_t;

/* Sets the mounting from the parameters; valid from the next frame on. TaskReceiveComm or main(). */
void imu_exchange_mount(const parameters_t *parameters);
/* Copies the present mounting. TaskIMU. */
void imu_exchange_mounted(imu_mapping_t *mapping);

/* Call for each frame. raw is read only when status is RAZOR_OK. arrival_us: arrival of its last octet.
 * TaskIMU. */
void imu_exchange_show(const razor_text_t *text, razor_status_t status, const imu_raw_t *raw,
                       uint32_t arrival_us);
/* Copies the latest frame and the counters. TaskReceiveComm. */
void imu_exchange_look(imu_view_t *view);

#endif
