/* Faults on the way from a device to the host: an octet filter between the device's transmitter and the wire.
 * Every octet of the device has a position, counted from 0 since creation, whatever happens to it here. The
 * same specifications and seed strike the same octets. */
#ifndef SIM_DEVICES_LINE_FAULT_H
#define SIM_DEVICES_LINE_FAULT_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/devices/serial.h"

typedef enum {
    LINE_FAULT_DROP,      /* the octet is lost */
    LINE_FAULT_FLIP,      /* one of its bits, drawn from the seed, is wrong */
    LINE_FAULT_DUPLICATE, /* it comes twice */
    LINE_FAULT_STRAY,     /* a foreign octet, drawn from the seed, comes before it */
    LINE_FAULT_DELAY,     /* it and what follows is held back for some ms, then leaves at line speed */
    LINE_FAULT_MUTE,      /* it and what follows for some ms is lost */
    LINE_FAULT_RESTART,   /* the device loses its power for a moment, instead of sending it */
    LINE_FAULT_STATUS,    /* the device has trouble that it reports by a status code */
    LINE_FAULT_KIND_COUNT
} line_fault_kind_t;

extern const char *const line_fault_names[]; /* LINE_FAULT_KIND_COUNT */

typedef struct {
    line_fault_kind_t kind;
    bool by_probability; /* of each octet; else once, at a position */
    uint64_t position;
    double probability; /* 0..1 */
    unsigned argument;  /* DELAY, MUTE: ms, 1..600000; STATUS: 21..98 */
} line_fault_spec_t;

/* KIND@POSITION or KIND:PROBABILITY; delay, mute and status followed by :MS or :CODE. NULL when fine, else
 * what is wrong. */
const char *line_fault_parse(line_fault_spec_t *spec, const char *text);
/* The grammar above with an example of each, for --help. */
extern const char line_fault_help[];

/* Where things go. restart and status may be NULL: then these faults do nothing else but be counted. */
typedef struct {
    serial_sink_t sink;
    void *sink_context;
    void (*restart)(void *context);
    void (*status)(void *context, unsigned code);
    void *device_context;
} line_fault_ends_t;

typedef struct fault line_fault_t;

/* Copies the specifications. */
line_fault_t *line_fault_create(const line_fault_spec_t *specs, int count, unsigned long seed,
                                const line_fault_ends_t *ends);
void line_fault_destroy(line_fault_t *fault);
/* Strikes the next octet, whatever its position; a kind with a probability strikes from now on. */
void line_fault_add(line_fault_t *fault, const line_fault_spec_t *spec);

/* serial_sink_t shape; context is a line_fault_t: an octet of the device at its stop bit. */
void line_fault_octet(void *fault, unsigned octet, double bit_ns);

/* How often this kind has struck, and how many octets have come. */
unsigned line_fault_strikes(const line_fault_t *fault, line_fault_kind_t kind);
uint64_t line_fault_octets(const line_fault_t *fault);

#endif
