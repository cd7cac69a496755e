/* The IMU's UART: the receive Hwi gathers a frame, IMU_SWI hands its text to TaskIMU. */
#ifndef FIRMWARE_IMU_PORT_H
#define FIRMWARE_IMU_PORT_H

#include <stdint.h>

#include "drivers/razor.h"

typedef struct {
    razor_text_t text;
    uint32_t arrival_us;    /* last octet */
} imu_message_t;

/* main() only. Also asks the sensor to stream, should it have been told not to. */
void imu_port_create(void);

/* Blocks TaskIMU until a frame is complete; copies it out. */
void imu_port_wait(imu_message_t *message);

#endif
