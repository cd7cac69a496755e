/* UART of the IMU. The receive Hwi collects the characters of a frame. IMU_SWI passes the text to TaskIMU. */
#ifndef FIRMWARE_IMU_PORT_H
#define FIRMWARE_IMU_PORT_H

#include <stdint.h>

#include "drivers/razor.h"

typedef struct {
    razor_text_t text;
    uint32_t arrival_us; /* arrival of the last octet */
} imu_message_t;

/* Creates the port. It also asks the sensor to stream, in case streaming was switched off. main() only. */
void imu_port_create(void);

/* Blocks until a frame is complete, then copies it to *message. TaskIMU only. */
void imu_port_wait(imu_message_t *message);

#endif
