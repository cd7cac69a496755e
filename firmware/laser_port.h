/* The scanner's driver on its UART: drivers/urg.h, one object. The receive Hwi feeds it, TaskSendLaser steps
 * it, Laser_SWI passes complete scans to TaskReceiveLaser. Replies to commands do not wake a task: they
 * shorten the pause to the next step. */
#ifndef FIRMWARE_LASER_PORT_H
#define FIRMWARE_LASER_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_layout.h"
#include "drivers/urg.h"

typedef struct {
    scip_scan_t scan; /* its points are in distance_mm */
    uint16_t distance_mm[SCIP_LAYOUT_POINTS_MAX];
    uint32_t arrival_us; /* arrival of the last octet of that scan */
    uint32_t bit_rate;   /* bits per second at which it was received */
} laser_message_t;

/* Since power-up. */
typedef struct {
    urg_report_t urg;
    uint32_t overruns; /* how often the UART lost octets */
} laser_statistics_t;

/* Creates the port. main() only. */
void laser_port_create(const urg_config_t *config);

/* Blocks until a scan is complete, then copies the latest scan to *message. TaskReceiveLaser only. */
void laser_port_wait(laser_message_t *message);

/* Copies the latest scan to *message when it is another one than *message holds. Returns false, and copies
 * nothing, when it is that one or when there is none yet. Zero *message before the first call. Any task. */
bool laser_port_newer(laser_message_t *message);

/* Orders these rays from the sensor from the next step on; nothing happens when they are ordered already.
 * TaskSendLaser only. */
void laser_port_order(const scip_range_t *range);

/* One step of the driver: sets the rate of the board's UART and sends what the sensor is to be told. Copies
 * the statistics as they are then. TaskSendLaser only. */
void laser_port_step(laser_statistics_t *statistics);

/* Time from the latest step to the next one, as the driver wants it now. Any task, Swi or Clock function. */
uint32_t laser_port_pause_us(void);

/* Copies the present statistics. Any task. */
void laser_port_statistics(laser_statistics_t *statistics);

#endif
