/* The sensor's side of the wire, written apart from the product: frames as the specification has them, and
 * faults of one octet each. */
#ifndef TESTS_FAULTS_WIRE_H
#define TESTS_FAULTS_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WIRE_POINTS_MAX 271
#define WIRE_OCTETS_MAX 1200

typedef struct {
    char symbol[3]; /* MS MD GS GD */
    int first, last, cluster, count;
} wire_order_t;

typedef struct {
    uint8_t octets[WIRE_OCTETS_MAX];
    size_t length;
} wire_t;

typedef enum {
    FAULT_FLIP,       /* one bit */
    FAULT_DROP,       /* one octet */
    FAULT_INSERT,     /* any octet, in front */
    FAULT_DUPLICATE,  /* one octet */
    FAULT_TRUNCATION, /* this octet and all that follow */
    FAULT_COUNT
} fault_t;
extern const char *const fault_names[FAULT_COUNT];

int wire_points(const wire_order_t *order);
int wire_width(const wire_order_t *order);
bool wire_is_stream(const wire_order_t *order);

/* A frame with data. remaining: of a counted run. */
void wire_frame(wire_t *wire, const wire_order_t *order, int remaining, uint32_t stamp_ms,
                const uint16_t *distance_mm);

/* Where in the frame the time stamp begins; echo and status stand before it. */
size_t wire_time_begins(const wire_order_t *order);

/* Puts one octet of a frame as the line delivers it under a fault; random chooses the bit or the octet. False
 * when nothing of the frame follows. */
bool wire_put_faulty(wire_t *wire, unsigned octet, fault_t fault, uint32_t random);

void wire_put(wire_t *wire, const uint8_t *octets, size_t count);

/* xorshift64*, seeded by anything but 0. */
typedef struct {
    uint64_t state;
} dice_t;
uint32_t dice_roll(dice_t *dice);
uint32_t dice_below(dice_t *dice, uint32_t limit);

#endif
