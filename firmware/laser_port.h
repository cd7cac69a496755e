/* The scanner's UART: the receive Hwi feeds the SCIP parser, Laser_SWI hands what is complete to TaskReceiveLaser. */
#ifndef FIRMWARE_LASER_PORT_H
#define FIRMWARE_LASER_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "scip_layout.h"
#include "scip_parser.h"
#include "urg_link.h"

typedef struct {
    bool has_scan;              /* a scan has come since the previous message */
    scip_scan_t scan;           /* its points are in distance_mm below */
    uint16_t distance_mm[SCIP_LAYOUT_POINTS_MAX];
    uint32_t arrival_us;        /* last octet of that scan */
    urg_seen_t seen;
} laser_message_t;

/* Creates the port at `bit_rate`. main() only. */
void laser_port_create(uint32_t bit_rate);

/* Blocks TaskReceiveLaser until something is complete; copies it out. */
void laser_port_wait(laser_message_t *message);

/* TaskSendLaser: the own UART's rate; and a request, whose reply is awaited from now on. */
void laser_port_set_rate(uint32_t bit_rate);
void laser_port_send(const scip_request_t *request);

#endif
