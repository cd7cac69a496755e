/* The whole driver of one URG-04LX in one object: parser, link, scans and what is counted. Five calls:
 *
 *   urg_init()          the sensor's order, and memory for two scans
 *   urg_feed()          what came from the UART, in any portions
 *   urg_step()          every 150 ms, whatever came
 *   urg_next_to_send()  after each step: what the UART has to do now
 *   urg_take_scan()     after a feed that returned true: the scan
 *
 * A sixth, urg_line_broken(), is for UARTs that tell errors. There is no clock, port, task or heap in it.
 *
 * Calling context: one at a time. When an interrupt feeds, keep it out during the other calls; none waits or
 * loops for long. The fields are private: read them by urg_report(). */
#ifndef DRIVERS_URG_H
#define DRIVERS_URG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "drivers/scip_parser.h"
#include "drivers/urg_link.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    /* private */
    scip_parser_t parser;
    urg_link_t link;
    urg_seen_t seen;
    urg_action_t action;
    scip_scan_t scans[2]; /* the parser fills one while the other, complete, may be taken */
    uint16_t filling;
    bool fresh; /* a complete scan was not taken yet */
} urg_t;

/* What the UART has to do, in this order. */
typedef struct {
    bool cycle_power; /* switch the sensor off and on, where the board can */
    bool set_rate;    /* reopen the UART at `rate` */
    uint32_t rate;
    uint16_t count; /* octets to be sent, 0..SCIP_REQUEST_MAX */
    octet_t octets[SCIP_REQUEST_MAX];
} urg_output_t;

typedef struct {
    urg_status_t status;
    uint32_t rate;     /* of the own UART */
    uint32_t restarts; /* times the stream was lost */
    uint32_t timeouts; /* commands without an answer */
    urg_seen_t seen;
    scip_counters_t scip;
    scip_damage_t last_damage;
} urg_report_t;

/* distance_mm: memory for two scans, 2 n values for n points, used until the next urg_init(). False, and
 * nothing is done, when it is too small or the configuration is one that urg_link_init() refuses. Open the
 * UART at first_rate. */
bool urg_init(urg_t *urg, const urg_config_t *config, uint16_t *distance_mm, uint16_t values,
              uint32_t now_us);

/* True when a scan has become complete. */
bool urg_feed(urg_t *urg, const octet_t *octets, size_t count);

/* The UART lost or mangled octets. framing_errors: how many of its errors were framing errors; they tell a
 * wrong rate. */
void urg_line_broken(urg_t *urg, uint32_t framing_errors);

/* now_us: microseconds, wrapping at 2^32. */
void urg_step(urg_t *urg, uint32_t now_us);

/* False when there is nothing to do; *output is written whole. Each step's output comes once. */
bool urg_next_to_send(urg_t *urg, urg_output_t *output);

/* The latest complete scan, once; false when there is none. Its points stay until the next scan is complete.
 */
bool urg_take_scan(urg_t *urg, scip_scan_t *scan);

/* Octets still to come until the reply or scan under way is complete; see scip_parser_expected(). */
uint16_t urg_expected(const urg_t *urg);

void urg_report(const urg_t *urg, urg_report_t *report);

#ifdef __cplusplus
}
#endif

#endif
