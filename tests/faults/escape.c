#include "escape.h"

#include <string.h>

/* The receiver's memory: how many octets of the frame it has accepted, the sum of the line so far (mod 64),
 * and whether what it accepted differs from what was sent. Probabilities of all these states, octet after
 * octet of what was sent. */
enum { SAME, OTHER_STAMP, OTHER_DISTANCE, DIFFERENCES };

typedef enum { LITERAL, CODE, SUM } place_t;

typedef struct {
    const wire_t *whole;
    place_t place[WIRE_OCTETS_MAX];
    size_t echo_length, data_begins;
    double passed[DIFFERENCES];
} receiver_t;

typedef struct {
    size_t accepted;
    unsigned sum, difference;
} state_t;

/* Faults shift what is received by a few octets against what was sent; further ones are too rare to count. */
#define SHIFT_MAX 8
#define SLOTS (2 * SHIFT_MAX + 1)
typedef double layer_t[SLOTS][64][DIFFERENCES];

static void mark(receiver_t *receiver, const wire_order_t *order)
{
    const wire_t *whole = receiver->whole;
    size_t i = wire_time_begins(order);

    receiver->echo_length = i - 5;
    receiver->data_begins = i + 6;
    memset(receiver->place, 0, sizeof receiver->place);
    for (; i < whole->length; i++) {
        if (whole->octets[i] != '\n') {
            receiver->place[i] = whole->octets[i + 1] == '\n' ? SUM : CODE;
        }
    }
}

/* Takes one octet. False when the frame is lost; what comes before the echo on its line does not matter. */
static bool accept(const receiver_t *receiver, state_t *state, unsigned octet)
{
    const unsigned expected = receiver->whole->octets[state->accepted];

    switch (receiver->place[state->accepted]) {
    case CODE:
        if (octet < 0x30 || octet > 0x6F) {
            return false;
        }
        state->sum = (state->sum + octet) % 64;
        if (octet != expected) {
            state->difference = state->accepted >= receiver->data_begins ? OTHER_DISTANCE
                                : state->difference == SAME              ? OTHER_STAMP
                                                                         : state->difference;
        }
        break;
    case SUM:
        if (octet != state->sum + 0x30) {
            return false;
        }
        state->sum = 0;
        break;
    default:
        if (octet == expected) {
            break;
        }
        if (state->accepted > receiver->echo_length) {
            return false;
        }
        state->accepted = octet == receiver->whole->octets[0] ? 1 : 0;
        return true;
    }
    state->accepted++;
    return true;
}

typedef struct {
    receiver_t *receiver;
    layer_t *next;
    size_t sent; /* octets of the frame sent, this one included */
} step_t;

static void arrive(const step_t *step, state_t state, double probability)
{
    const long slot = (long)state.accepted - (long)step->sent + SHIFT_MAX;

    if (slot >= 0 && slot < SLOTS) {
        (*step->next)[slot][state.sum][state.difference] += probability;
    }
}

/* Feeds up to two octets and notes where that leads. */
static void feed(const step_t *step, state_t state, double probability, const unsigned *octets, int count)
{
    for (int i = 0; i < count; i++) {
        if (!accept(step->receiver, &state, octets[i])) {
            return;
        }
        if (state.accepted == step->receiver->whole->length) {
            step->receiver->passed[state.difference] += probability;
            return;
        }
    }
    arrive(step, state, probability);
}

static void spread(const step_t *step, state_t state, double mass, double p)
{
    const unsigned octet = step->receiver->whole->octets[step->sent - 1];
    const double each = mass * p / FAULT_COUNT;

    feed(step, state, mass * (1.0 - p), &octet, 1);
    for (unsigned bit = 0; bit < 8; bit++) {
        feed(step, state, each / 8.0, &(unsigned){octet ^ (1U << bit)}, 1);
    }
    feed(step, state, each, NULL, 0);
    for (unsigned inserted = 0; inserted < 256; inserted++) {
        feed(step, state, each / 256.0, (unsigned[]){inserted, octet}, 2);
    }
    feed(step, state, each, (unsigned[]){octet, octet}, 2);
    /* truncation: nothing more comes of this frame */
}

static void spread_layer(const step_t *step, layer_t *layer, double p)
{
    for (int slot = 0; slot < SLOTS; slot++) {
        const long accepted = (long)step->sent - 1 + slot - SHIFT_MAX;
        for (unsigned sum = 0; sum < 64; sum++) {
            for (unsigned difference = 0; difference < DIFFERENCES; difference++) {
                const double mass = (*layer)[slot][sum][difference];
                if (mass > 1e-18) {
                    spread(step, (state_t){(size_t)accepted, sum, difference}, mass, p);
                }
            }
        }
    }
}

escape_t escape_of(const wire_t *whole, const wire_order_t *order, double p)
{
    static receiver_t receiver;
    static layer_t layers[2];

    memset(layers, 0, sizeof layers);
    receiver = (receiver_t){.whole = whole};
    mark(&receiver, order);
    layers[0][SHIFT_MAX][0][SAME] = 1.0;
    for (size_t i = 0; i < whole->length; i++) {
        layer_t *layer = &layers[i % 2], *next = &layers[(i + 1) % 2];
        memset(next, 0, sizeof *next);
        spread_layer(&(step_t){&receiver, next, i + 1}, layer, p);
    }
    return (escape_t){receiver.passed[OTHER_STAMP] + receiver.passed[OTHER_DISTANCE],
                      receiver.passed[OTHER_STAMP], receiver.passed[SAME]};
}
