#include "sim/devices/serial.h"

#include <math.h>
#include <string.h>

static void octet_left(void *context);

/* While an octet is on the line, line_free is where it began: its own length gives its bit time, whatever the
 * rate is set to meanwhile. */
static void start_next(serial_t *serial)
{
    if (serial->busy || serial->count == 0) {
        return;
    }
    serial->busy = true;
    serial->line_free = timeline_now() > serial->held ? timeline_now() : serial->held;
    serial->event = timeline_at(serial->line_free + llround(1e10 / serial->rate), octet_left, serial);
}

static void octet_left(void *context)
{
    serial_t *serial = context;
    unsigned octet = serial->queue[serial->head];
    double bit_ns = (double)(timeline_now() - serial->line_free) / 10.0;

    serial->head = (serial->head + 1) % SERIAL_QUEUE;
    serial->count--;
    serial->busy = false;
    serial->event = 0;
    serial->line_free = timeline_now();
    start_next(serial);
    serial->sink(serial->context, octet, bit_ns);
}

void serial_init(serial_t *serial, double rate, serial_sink_t sink, void *context)
{
    memset(serial, 0, sizeof *serial);
    serial->rate = rate;
    serial->sink = sink;
    serial->context = context;
}

void serial_set_rate(serial_t *serial, double rate)
{
    serial->rate = rate;
}

void serial_send(serial_t *serial, const void *octets, size_t count)
{
    const unsigned char *octet = octets;
    size_t room = SERIAL_QUEUE - serial->count;
    size_t taken = count < room ? count : room;

    for (size_t i = 0; i < taken; i++) {
        serial->queue[(serial->head + serial->count) % SERIAL_QUEUE] = octet[i];
        serial->count++;
    }
    serial->dropped += count - taken;
    start_next(serial);
}

void serial_hold(serial_t *serial, sim_time_t until)
{
    serial->held = until;
}

bool serial_idle(const serial_t *serial)
{
    return serial->count == 0;
}

void serial_flush(serial_t *serial)
{
    if (serial->busy) {
        timeline_cancel(serial->event);
        serial->line_free = timeline_now();
    }
    serial->event = 0;
    serial->busy = false;
    serial->held = 0;
    serial->head = 0;
    serial->count = 0;
}
