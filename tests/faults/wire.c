#include "wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/scip_frames.h"

const char *const fault_names[FAULT_COUNT] = {"flip", "drop", "insert", "duplicate", "truncation"};

int wire_width(const wire_order_t *order)
{
    return order->symbol[1] == 'S' ? 2 : 3;
}

bool wire_is_stream(const wire_order_t *order)
{
    return order->symbol[0] == 'M';
}

int wire_points(const wire_order_t *order)
{
    const int steps = order->last - order->first + 1;
    return (steps + order->cluster - 1) / order->cluster;
}

static void put(wire_t *wire, unsigned octet)
{
    if (wire->length == WIRE_OCTETS_MAX) {
        abort();
    }
    wire->octets[wire->length++] = (uint8_t)octet;
}

static void write_echo(char *text, size_t size, const wire_order_t *order, int remaining)
{
    const int used = snprintf(text, size, "%s%04d%04d%02d", order->symbol, order->first, order->last,
                              order->cluster);

    if (wire_is_stream(order)) {
        snprintf(text + used, size - (size_t)used, "0%02d", remaining);
    }
}

size_t wire_time_begins(const wire_order_t *order)
{
    return wire_is_stream(order) ? 20 : 17;
}

void wire_frame(wire_t *wire, const wire_order_t *order, int remaining, uint32_t stamp_ms,
                const uint16_t *distance_mm)
{
    const int width = wire_width(order), points = wire_points(order);
    char echo[40], data[3 * WIRE_POINTS_MAX], text[WIRE_OCTETS_MAX + 1];

    for (int i = 0; i < points; i++) {
        scip_frames_encode(data + i * width, distance_mm[i], (unsigned)width);
    }
    write_echo(echo, sizeof echo, order, remaining);
    wire->length = scip_frames_frame(text, echo, stamp_ms, data, (size_t)(width * points));
    memcpy(wire->octets, text, wire->length);
}

void wire_put(wire_t *wire, const uint8_t *octets, size_t count)
{
    if (count > WIRE_OCTETS_MAX - wire->length) {
        abort();
    }
    memcpy(wire->octets + wire->length, octets, count);
    wire->length += count;
}

bool wire_put_faulty(wire_t *wire, unsigned octet, fault_t fault, uint32_t random)
{
    switch (fault) {
    case FAULT_FLIP:
        put(wire, octet ^ (1U << (random % 8)));
        break;
    case FAULT_INSERT:
        put(wire, random % 256);
        put(wire, octet);
        break;
    case FAULT_DUPLICATE:
        put(wire, octet);
        put(wire, octet);
        break;
    default:
        break;
    }
    return fault != FAULT_TRUNCATION;
}

uint32_t dice_roll(dice_t *dice)
{
    dice->state ^= dice->state >> 12;
    dice->state ^= dice->state << 25;
    dice->state ^= dice->state >> 27;
    return (uint32_t)((dice->state * 0x2545F4914F6CDD1DULL) >> 32);
}

uint32_t dice_below(dice_t *dice, uint32_t limit)
{
    return (uint32_t)(((uint64_t)dice_roll(dice) * limit) >> 32);
}
