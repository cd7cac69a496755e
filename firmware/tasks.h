/* The six tasks. Each function xxx_create() creates a task and its releases (semaphore, event or clock).
 * main() only. */
#ifndef FIRMWARE_TASKS_H
#define FIRMWARE_TASKS_H

#include "drivers/urg_link.h"

void task_imu_create(void);
void task_receive_laser_create(const urg_config_t *config);
void task_control_create(void);
void task_send_laser_create(void);
void task_send_comm_create(void);
void task_receive_comm_create(void);

/* Release TaskControl: a new altitude has arrived; a new IMU frame has arrived; the vehicle turns over, which
 * no law waits with. Any task. */
void task_control_altitude_arrived(void);
void task_control_imu_arrived(void);
void task_control_rolls(void);

#endif
