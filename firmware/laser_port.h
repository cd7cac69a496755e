/* The scanner's UART: the receive Hwi feeds the SCIP parser, Laser_SWI hands complete scans to TaskReceiveLaser. Replies
 * to commands need no task of their own: TaskSendLaser looks at the statistics at its next tick. */
#ifndef FIRMWARE_LASER_PORT_H
#define FIRMWARE_LASER_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "drivers/urg_link.h"

typedef struct {
    scip_scan_t scan;           /* its points are in distance_mm below */
    uint16_t distance_mm[SCIP_LAYOUT_POINTS_MAX];
    uint32_t arrival_us;        /* last octet of that scan */
    uint32_t bit_rate;          /* that it came at */
} laser_message_t;

/* What has gone well and wrong since power-up. */
typedef struct {
    urg_seen_t seen;
    scip_counters_t scip;
    scip_damage_t last_damage;
    uint32_t overruns;          /* times that the UART lost octets */
} laser_statistics_t;

/* Creates the port at `bit_rate`. main() only. */
void laser_port_create(uint32_t bit_rate);

/* Blocks TaskReceiveLaser until a scan is complete; copies the latest out. */
void laser_port_wait(laser_message_t *message);

/* What the receiving side has seen up to now. Task. */
void laser_port_statistics(laser_statistics_t *statistics);

/* TaskSendLaser: the own UART's rate; a request whose reply is awaited from now on; and the request itself. */
void laser_port_set_rate(uint32_t bit_rate);
void laser_port_expect(const scip_request_t *request);
void laser_port_send(const scip_request_t *request);

#endif
