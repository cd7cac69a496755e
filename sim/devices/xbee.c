#include "sim/devices/xbee.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define RATE 9600.0
#define CHARACTER ((sim_time_t)1041667) /* 10 bits at 9600 */
#define SILENCE (3 * CHARACTER)         /* RO */
#define PACKET_OCTETS 100U
#define DI_OCTETS 202U
#define RATE_TOLERANCE 0.045

/* On air: 250 kbit/s, and 2 ms for preamble, header, back-off and acknowledge. */
#define AIR_FIXED (2 * SIM_MS)
#define AIR_OCTET (32 * SIM_US)

/* One direction: the sending module's DI buffer, the packet on air, the receiving module's transmitter. */
typedef struct {
    unsigned char di[DI_OCTETS];
    size_t gathered;
    bool silent; /* since RO: what is gathered may leave */
    timeline_id_t silence;
    unsigned char packet[PACKET_OCTETS];
    size_t on_air;
    timeline_id_t landing;
    serial_t uart;
    size_t overflowed, mismatched;
    bool out_of_reach;
} leg_t;

struct xbee {
    serial_t terminal;
    leg_t up, down; /* to the vehicle, to the operator */
};

static sim_time_t air_time(size_t count)
{
    return AIR_FIXED + (sim_time_t)count * AIR_OCTET;
}

static void landed(void *context);

static void fly_when_ripe(leg_t *leg)
{
    const bool ripe = leg->gathered >= PACKET_OCTETS || (leg->silent && leg->gathered > 0);
    if (!ripe || leg->on_air > 0) {
        return;
    }
    leg->on_air = leg->gathered < PACKET_OCTETS ? leg->gathered : PACKET_OCTETS;
    leg->gathered -= leg->on_air;
    memcpy(leg->packet, leg->di, leg->on_air);
    memmove(leg->di, leg->di + leg->on_air, leg->gathered);
    leg->landing = timeline_after(air_time(leg->on_air), landed, leg);
}

static void landed(void *context)
{
    leg_t *leg = context;
    if (!leg->out_of_reach) {
        serial_send(&leg->uart, leg->packet, leg->on_air);
    }
    leg->on_air = 0;
    leg->landing = 0;
    fly_when_ripe(leg);
}

static void fell_silent(void *context)
{
    leg_t *leg = context;
    leg->silence = 0;
    leg->silent = true;
    fly_when_ripe(leg);
}

static void enter(void *context, unsigned octet, double bit_ns)
{
    leg_t *leg = context;
    if (fabs(bit_ns * RATE / 1e9 - 1.0) > RATE_TOLERANCE) {
        leg->mismatched++;
        return;
    }
    timeline_cancel(leg->silence);
    leg->silence = timeline_after(SILENCE, fell_silent, leg);
    leg->silent = false;
    if (leg->gathered == DI_OCTETS) {
        leg->overflowed++;
        return;
    }
    leg->di[leg->gathered++] = (unsigned char)octet;
    fly_when_ripe(leg);
}

static void ground(leg_t *leg)
{
    timeline_cancel(leg->silence);
    timeline_cancel(leg->landing);
    serial_flush(&leg->uart);
}

xbee_t *xbee_create(serial_sink_t to_firmware, void *firmware_context, serial_sink_t to_operator,
                    void *operator_context)
{
    xbee_t *xbee = calloc(1, sizeof *xbee);
    if (xbee == NULL) {
        abort();
    }
    serial_init(&xbee->terminal, RATE, enter, &xbee->up);
    serial_init(&xbee->up.uart, RATE, to_firmware, firmware_context);
    serial_init(&xbee->down.uart, RATE, to_operator, operator_context);
    return xbee;
}

void xbee_destroy(xbee_t *xbee)
{
    serial_flush(&xbee->terminal);
    ground(&xbee->up);
    ground(&xbee->down);
    free(xbee);
}

void xbee_reach(xbee_t *xbee, bool in_reach)
{
    xbee->up.out_of_reach = xbee->down.out_of_reach = !in_reach;
}

void xbee_from_firmware(xbee_t *xbee, unsigned octet, double bit_ns)
{
    enter(&xbee->down, octet, bit_ns);
}

void xbee_from_operator(xbee_t *xbee, const void *octets, size_t count)
{
    serial_send(&xbee->terminal, octets, count);
}

sim_time_t xbee_latency(size_t count)
{
    sim_time_t entered = 0, line_free = 0;
    while (count > 0) {
        const size_t packet = count < PACKET_OCTETS ? count : PACKET_OCTETS;
        entered += (sim_time_t)packet * CHARACTER;
        const sim_time_t landing = entered + (packet < PACKET_OCTETS ? SILENCE : 0) + air_time(packet);
        line_free = (landing > line_free ? landing : line_free) + (sim_time_t)packet * CHARACTER;
        count -= packet;
    }
    return line_free;
}
