/* The whole driver of one URG-04LX in one object: parser, link, scans and what is counted. Five calls:
 *
 *   urg_init()          sets the configuration, and the memory for two scans
 *   urg_feed()          processes received octets, any number at a time
 *   urg_pause_us()      ask it again and again: it becomes shorter with what is fed
 *   urg_step()          call it when that time has passed since the step before
 *   urg_next_to_send()  call it after each step: actions for the UART
 *   urg_take_scan()     call it when urg_feed() returned true: the scan
 *
 * More calls are for some callers: urg_line_broken() where the UART reports errors; urg_scan_at() for the
 * shortest search after an outage; urg_ask() for what the sensor tells of itself; urg_order() for another
 * range of steps. The driver uses no clock, port, task or heap.
 *
 * Calling context: one call at a time. When an interrupt calls urg_feed(), disable it during the other calls.
 * No call waits or loops for long. The fields of urg_driver_t are private: use urg_report(). */
#ifndef DRIVERS_URG_H
#define DRIVERS_URG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "drivers/scip_info.h"
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
    scip_scan_t scans[2]; /* the parser fills one; the other one is complete and can be taken */
    uint16_t filling;
    bool fresh; /* a complete scan has not been taken yet */
    scip_info_t *info;
} urg_driver_t;

/* Actions for the board, to be done in this order. */
typedef struct {
    bool cycle_power; /* switch the sensor off and on, where the board can */
    bool set_rate;    /* reopen the UART at `rate` */
    uint32_t rate;
    uint16_t count; /* number of octets to send, 0..SCIP_REQUEST_MAX */
    octet_t octets[SCIP_REQUEST_MAX];
} urg_output_t;

typedef struct {
    urg_status_t status;
    uint32_t rate;         /* of the board's UART, bits per second */
    uint32_t first_rate;   /* at which the sensor powers up, as far as is known */
    bool first_rate_known; /* it was seen to: to be stored for the next urg_config_t */
    uint32_t restarts;     /* how often the stream was lost */
    uint32_t timeouts;     /* commands without an answer */
    uint32_t pause_us;     /* until the next step, as urg_pause_us() */
    urg_seen_t seen;
    scip_counters_t scip;
    scip_damage_t last_damage;
} urg_report_t;

/* Starts the driver. distance_mm: memory for two scans of n points, 2 n values; the driver uses it until the
 * next urg_init(). The caller then opens the UART at first_rate. now_us: as in urg_step(). Returns false, and
 * does nothing, when urg_refusal() names a cause. */
bool urg_init(urg_driver_t *urg, const urg_config_t *config, uint16_t *distance_mm, uint16_t values,
              uint32_t now_us);

/* The first cause for which urg_init() refuses this configuration with memory for so many values; and its
 * words, zero-terminated, static: "stream_rate is not a rate of SCIP". */
urg_refusal_t urg_refusal(const urg_config_t *config, uint16_t values);
const char *urg_refusal_text(urg_refusal_t refusal);

/* Private parts of urg_feed(). */
bool urg_feed_all(urg_driver_t *urg, const octet_t *octets, size_t count);
bool urg_take_event(urg_driver_t *urg, scip_event_t event);

/* Processes received octets. Returns true when at least one scan has become complete. Inline, because an
 * interrupt may call it for every octet. */
static inline bool urg_feed(urg_driver_t *urg, const octet_t *octets, size_t count)
{
    if (count != 1U) {
        return urg_feed_all(urg, octets, count);
    }
    const scip_event_t event = scip_parser_feed(&urg->parser, octets[0]);
    return event != SCIP_NOTHING && urg_take_event(urg, event);
}

/* Call this when the UART lost or damaged octets. framing_errors: how many of the errors were framing errors,
 * which are a sign of a wrong bit rate. */
void urg_line_broken(urg_driver_t *urg, uint32_t framing_errors);

/* One step of the link, at least every 150 ms. now_us: time in microseconds, wraps at 2^32. */
void urg_step(urg_driver_t *urg, uint32_t now_us);

/* As urg_link_scan_at(), urg_link_pause_us(). The pause changes with what is fed. */
void urg_scan_at(urg_driver_t *urg, uint32_t now_us);
uint32_t urg_pause_us(const urg_driver_t *urg);

/* Gets the actions of the latest step, once. Always writes *output. Returns false when there is nothing to
 * do.
 */
bool urg_next_to_send(urg_driver_t *urg, urg_output_t *output);

/* Gets the latest complete scan, once. Returns false when there is none. The points are valid until the next
 * scan is complete. */
bool urg_take_scan(urg_driver_t *urg, scip_scan_t *scan);

/* Orders another range from the sensor: a stream that runs stops for some revolutions. Nothing happens when
 * it is the present range. Returns false, and does nothing, when urg_refusal() would name a cause. */
bool urg_order(urg_driver_t *urg, const scip_range_t *range);

/* Asks the sensor for its version, limits and state (VV, PP, II), once; *info is cleared, then written while
 * urg_feed() reads the answers. Before the first stream it costs three answers' time; a stream that runs
 * stops for some revolutions. Call it again to ask again. *info must stay until urg_told() or the next
 * urg_init(). */
void urg_ask(urg_driver_t *urg, scip_info_t *info);

/* All three were answered since urg_ask(). A question without an answer is left out: it stays false, and
 * scans come. */
bool urg_told(const urg_driver_t *urg);

/* Number of octets until the present reply or scan is complete; see scip_parser_expected(). */
uint16_t urg_expected(const urg_driver_t *urg);

/* Copies status and counters to *report. */
void urg_report(const urg_driver_t *urg, urg_report_t *report);

#ifdef __cplusplus
}
#endif

#endif
