/* Between TaskIMU and TaskReceiveComm: how the IMU is mounted, and what came from it last. */
#ifndef FIRMWARE_IMU_EXCHANGE_H
#define FIRMWARE_IMU_EXCHANGE_H

#include <stdint.h>

#include "control/imu_mapping.h"
#include "drivers/razor.h"

typedef struct {
    razor_text_t text;
    razor_status_t status;
    imu_raw_t raw;          /* of the latest frame that was OK */
    uint32_t frames;        /* OK so far */
    uint32_t period_us;     /* between the latest two of them */
} imu_view_t;

/* TaskReceiveComm, main(): from the next frame on. */
void imu_exchange_mount(const parameters_t *parameters);
/* TaskIMU. */
void imu_exchange_mounted(imu_mapping_t *mapping);

/* TaskIMU, each frame: raw is looked at when the status is OK. */
void imu_exchange_show(const razor_text_t *text, razor_status_t status, const imu_raw_t *raw, uint32_t arrival_us);
/* TaskReceiveComm. */
void imu_exchange_look(imu_view_t *view);

#endif
