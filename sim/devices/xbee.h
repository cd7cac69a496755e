/* Model of a pair of XBee modules in transparent mode at 9600 between the operator's terminal and the
 * firmware: octets gather into radio packets (RO = 3 character times of silence, or 100 octets), fly, and
 * leave the other side's UART at its rate. */
#ifndef SIM_DEVICES_XBEE_H
#define SIM_DEVICES_XBEE_H

#include <stddef.h>

#include <stdbool.h>

#include "sim/devices/serial.h"

typedef struct xbee xbee_t;

/* to_firmware: UART of the module on the vehicle. to_operator: octets for the terminal (bit_ns of the ground
 * module). */
xbee_t *xbee_create(serial_sink_t to_firmware, void *firmware_context, serial_sink_t to_operator,
                    void *operator_context);
void xbee_destroy(xbee_t *xbee);
/* Out of reach, packets on air are lost in both directions. In reach at first. */
void xbee_reach(xbee_t *xbee, bool in_reach);
void xbee_from_firmware(xbee_t *xbee, unsigned octet, double bit_ns);
/* The operator's terminal writes; octets enter the ground module at 9600. */
void xbee_from_operator(xbee_t *xbee, const void *octets, size_t count);
/* Time from xbee_from_operator(count octets) on an idle link until the last stop bit at the firmware's pin.
 */
sim_time_t xbee_latency(size_t count);

#endif
