/* A scanner on a serial port of the PC, brought from any state to a stream of scans by the product's own
 * link, parser and requests. Paced by the wall clock; one per process. */
#ifndef TOOLS_PLOMADA_SCANNER_H
#define TOOLS_PLOMADA_SCANNER_H

#include <stdbool.h>
#include <stddef.h>

#include "drivers/scip_request.h"

/* Everything that passes on the wire, when it is read or written; t_us since scanner_open(). */
typedef void (*scanner_tap_t)(void *context, bool from_sensor, long long t_us, const unsigned char *octets,
                              size_t count);

typedef struct {
    const char *device;
    unsigned long rate; /* of the stream */
    unsigned first_step, last_step;
    scanner_tap_t tap;
    void *context;
} scanner_config_t;

/* NULL when the port is open (then scanner_close()), else what failed: also a rate that the port cannot do.
 * SIGINT, SIGTERM and the loss of the port end every wait below. */
const char *scanner_open(const scanner_config_t *config);
void scanner_close(void);

/* True when scans arrive within so many seconds. */
bool scanner_start(double patience_s);
/* The stream goes on for so many seconds, recovering what is lost. False when interrupted. */
bool scanner_run(double seconds);
/* The port has gone away. */
bool scanner_is_gone(void);
/* Ends the stream. True when the sensor has confirmed it. */
bool scanner_stop(void);
/* VV or PP of a stopped sensor: its lines, without sums, each ended by LF. False when there was no whole
 * reply. */
bool scanner_ask(scip_kind_t kind, char *text, size_t size);

unsigned long scanner_rate(void); /* that the latest scan has come at, as the port's driver says; 0: none */
double scanner_scans_per_s(
    void); /* of the latest stream without a gap, by the sensor's clock; 0: not known */

#endif
