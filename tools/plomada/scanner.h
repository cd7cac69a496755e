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

/* NULL when the port is open (then scanner_close()), else what failed. SIGINT and SIGTERM end every wait
 * below. */
const char *scanner_open(const scanner_config_t *config);
void scanner_close(void);

/* True when scans arrive within so many seconds. */
bool scanner_start(double patience_s);
/* The stream goes on for so many seconds, recovering what is lost. False when interrupted. */
bool scanner_run(double seconds);
/* Ends the stream. True when the sensor has confirmed it. */
bool scanner_stop(void);
/* VV or PP of a stopped sensor: its lines, without sums, each ended by LF. False when there was no whole
 * reply. */
bool scanner_ask(scip_kind_t kind, char *text, size_t size);

unsigned long scanner_scans(void);
unsigned long scanner_damaged(void);
unsigned long scanner_rate(void); /* that the stream has come at */

#endif
