/* UART of the scanner. The receive Hwi feeds the SCIP parser. Laser_SWI passes complete scans to
 * TaskReceiveLaser. Replies to commands do not wake a task: TaskSendLaser reads the statistics at its next
 * period. */
#ifndef FIRMWARE_LASER_PORT_H
#define FIRMWARE_LASER_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "drivers/urg_link.h"

typedef struct {
    scip_scan_t scan; /* its points are in distance_mm */
    uint16_t distance_mm[SCIP_LAYOUT_POINTS_MAX];
    uint32_t arrival_us; /* arrival of the last octet of that scan */
    uint32_t bit_rate;   /* bits per second at which it was received */
} laser_message_t;

/* Statistics since power-up. */
typedef struct {
    urg_seen_t seen;
    scip_counters_t scip;
    scip_damage_t last_damage;
    uint32_t overruns; /* how often the UART lost octets */
} laser_statistics_t;

/* Creates the port. bit_rate in bits per second. main() only. */
void laser_port_create(uint32_t bit_rate);

/* Blocks until a scan is complete, then copies the latest scan to *message. TaskReceiveLaser only. */
void laser_port_wait(laser_message_t *message);

/* Copies the present statistics. Any task. */
void laser_port_statistics(laser_statistics_t *statistics);

/* TaskSendLaser only. Sets the bit rate of the board's UART; awaits the reply to a request from now on;
 * sends a request. The request is copied. */
void laser_port_set_rate(uint32_t bit_rate);
void laser_port_expect(const scip_request_t *request);
void laser_port_send(const scip_request_t *request);

#endif
