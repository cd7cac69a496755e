/* A device's transmitter: octets leave one after the other at its bit rate and reach the far end of the wire
 * at the end of their stop bits. */
#ifndef SIM_DEVICES_SERIAL_H
#define SIM_DEVICES_SERIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/timeline.h"

typedef void (*serial_sink_t)(void *context, unsigned octet, double bit_ns);

#define SERIAL_QUEUE 8192

typedef struct {
    double rate; /* bits per second; 10 bits per octet */
    serial_sink_t sink;
    void *context;
    unsigned char queue[SERIAL_QUEUE];
    size_t head, count;
    bool busy;
    sim_time_t line_free; /* end of the last stop bit */
    sim_time_t held;      /* no octet begins before */
    size_t dropped;       /* octets that found the queue full */
    timeline_id_t event;
} serial_t;

void serial_init(serial_t *serial, double rate, serial_sink_t sink, void *context);
void serial_set_rate(serial_t *serial, double rate); /* from the next octet on */
void serial_send(serial_t *serial, const void *octets, size_t count);
void serial_hold(serial_t *serial, sim_time_t until); /* no further octet begins before */
bool serial_idle(const serial_t *serial);
void serial_flush(serial_t *serial); /* drops what has not left yet (power loss) */

#endif
