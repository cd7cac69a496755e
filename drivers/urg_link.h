/* State machine that brings the URG-04LX from power-up to a stream of scans, and back to it after any loss.
 * It has no clock, port or task. The caller steps it every 150 ms, or when urg_link_pause_us() has passed,
 * with what was received; each step returns an action.
 *
 *   WAIT -> STOP1 (L0) -> SWITCH (SCIP2.0) -> RATE (SS) -> STOP2 (QT) -> STREAM (MS) -> OK
 *
 * Each command has a time-out and is repeated until the sensor confirms it. The board's UART changes to a new
 * rate 90 ms after the sensor's reply or later.
 *
 * The link assumes nothing about the sensor's state. The sensor answers QT in every state: SCIP2.0 "00",
 * streaming "00" after the present frames, time mode "0E", SCIP1.1 "E". So when the sensor is lost, the link
 * sends QT at one rate after the other, without end. When the sensor answers but sends no scans: QT and MS
 * again, then TM2, then RS. For the first 12 s after a stream stops, it listens at the stream's rate, and
 * between the frames it sends SCIP2.0 at the first rate.
 *
 * Pure; the caller owns the state. Context: one at a time. urg_link_scan_at() belongs where scans are
 * received (here the Hwi of the UART), the others to a Task (TaskSendLaser), which keeps that interrupt off
 * meanwhile. Times are in microseconds and wrap; two steps must be less than 35 minutes apart. */
#ifndef DRIVERS_URG_LINK_H
#define DRIVERS_URG_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_parser.h"
#include "drivers/scip_request.h"

#ifdef __cplusplus
extern "C" {
#endif

#define URG_STEP_US 150000U       /* the seed's tick of 150 ms */
#define URG_QUESTIONS 3U          /* VV, PP, II */
#define URG_SEARCH_STEP_US 50000U /* chosen: half a revolution */

/* State of the link, the seed's LASER_STATUS; shown in the telemetry. */
typedef enum {
    URG_WAIT,   /* the sensor's own power-up time */
    URG_STOP1,  /* L0 sent */
    URG_SWITCH, /* SCIP2.0 sent */
    URG_RATE,   /* SS sent */
    URG_STOP2,  /* QT, TM2 or a question sent; the sensor has answered at this rate */
    URG_STREAM, /* MS sent */
    URG_OK,     /* scans arrive */
    URG_LOST,   /* no answer, or no more scans: the link searches the sensor, first at the known rates */
    URG_OLD,    /* the sensor knows SCIP1.1 only (firmware before 3.0); SCIP2.0 is repeated without end */
    URG_STATUS_COUNT
} urg_status_t;

/* Name as in the telemetry: "WAIT", "STOP1" and so on. Zero-terminated, static. */
const char *urg_status_name(urg_status_t status);

/* What was received since power-up. Counters wrap at 2^32. */
typedef struct {
    uint32_t reply_count;   /* number of replies to awaited requests */
    scip_kind_t reply_kind; /* kind of the latest reply */
    scip_reply_t reply;     /* latest reply */
    uint32_t scan_count;
    uint32_t octets_at_scan; /* octet_count when the latest scan was complete */
    uint16_t scan_remaining; /* of the latest scan; used in counted runs only */
    uint32_t legacy_count;   /* number of answers "E" of SCIP1.1 */
    uint32_t notice_count;
    scip_reply_t notice; /* latest hardware notice */
    uint32_t octet_count;
    uint32_t framing_count; /* framing errors of the UART: wrong rate, or a bad cable */
    uint32_t strange_count; /* zero or above 7FH: a wrong rate, also where the UART reports no errors */
    uint32_t stray_count;   /* replies to other than the awaited request, and scans of another one */
    uint32_t foreign_count; /* of them scans of another request; scip_parser.h, `foreign` */
    uint32_t damage_count;  /* damaged replies and scans, all causes */
} urg_seen_t;

typedef struct {
    uint32_t wait_us;     /* time in WAIT: 10 s, or 0 after a watchdog reset. Ends early when octets arrive */
    uint32_t first_rate;  /* rate at which the UART is opened: 115200 */
    uint32_t stream_rate; /* rate of the stream: 250000 */
    uint32_t fastest_rate; /* limit of the board's UART and line driver; 0: no limit */
    scip_kind_t stream;    /* SCIP_STREAM_2 or SCIP_STREAM_3 */
    scip_range_t range;    /* scans > 0: a counted run, requested again when it ends */
    uint16_t last_step;    /* of the sensor; 0: SCIP_STEP_MAX_URG04LX */
    bool first_rate_known; /* this sensor powers up at first_rate: it was seen to. Else the link learns it */
} urg_config_t;

/* Why an order is impossible. */
typedef enum {
    URG_ACCEPTED,
    URG_STREAM_KIND, /* `stream` is neither SCIP_STREAM_2 nor SCIP_STREAM_3 */
    URG_FIRST_RATE,  /* `first_rate` is not one of scip_bit_rates */
    URG_STREAM_RATE, /* nor `stream_rate` */
    URG_TOO_FAST,    /* one of them is above `fastest_rate` */
    URG_LAST_STEP,   /* the range ends beyond the sensor's `last_step` */
    URG_RANGE,       /* a field of `range` is outside its limits */
    URG_MEMORY,      /* the memory is too small for two scans; urg_refusal() only */
    URG_REFUSAL_COUNT
} urg_refusal_t;

typedef struct {
    bool set_rate;    /* reopen the board's UART at `rate` before sending */
    uint32_t rate;    /* rate of the board's UART from now on */
    bool expect;      /* first give `request` to the parser */
    bool send;        /* then send it */
    bool cycle_power; /* switch the sensor off and on, if the board can */
    scip_request_t request;
} urg_action_t;

typedef struct {
    urg_config_t config;
    urg_status_t status;
    uint32_t since_us;     /* when the present status was entered */
    uint32_t sent_us;      /* when the latest command was sent */
    uint32_t timeout_us;   /* time-out of the latest command; in OK: of the next scan */
    uint32_t rate;         /* present rate of the board's UART */
    uint16_t attempt;      /* number of times the present command was sent */
    uint16_t asks_left;    /* of VV, PP and II, the present one included */
    uint32_t restarts;     /* how often the stream was lost */
    uint32_t timeouts;     /* commands without an answer */
    uint16_t failures;     /* how often in a row scans did not start or stopped; limited */
    uint16_t told;         /* how many of the latest VV, PP and II were answered */
    uint32_t scan_us;      /* time of the latest scan, power cycle or end of WAIT */
    scip_kind_t command;   /* latest command */
    bool waiting;          /* the link waits for the reply to a command */
    bool rate_refused;     /* the sensor refused stream_rate: keep the present rate */
    bool line_unknown;     /* the sensor may hold an incomplete line: send LF before the next command */
    bool timed;            /* the caller tells the times of the scans */
    uint16_t scan_octets;  /* length of one frame of the stream */
    uint32_t sent_octets;  /* counter of octets when the latest command was sent */
    uint32_t sent_signs;   /* counter of signs of a wrong rate at that time */
    uint32_t sent_framing; /* of framing errors alone */
    uint32_t sent_strays;  /* counter of stray replies at that time */
    uint32_t sent_foreign; /* counter of another request's scans at that time */
    uint32_t good_rate;    /* rate at which scans were received; 0: none yet */
    uint32_t frame_us;     /* time of the latest scan, as told */
    uint32_t answered_us;  /* time of the latest answer */
    bool answered;         /* it came at one of the configured rates */
    bool to_ask;           /* VV, PP and II are wanted */
    bool to_order;         /* the range has changed since the stream was requested */
    uint16_t sweep;        /* of a first search through all rates */
    bool knocking;         /* the present command is part of the search for a sensor that has streamed */
    bool listening;        /* it is at the stream's rate, and no command was sent */
    bool asking;           /* the present turn of that search is for a sensor that powers up */
    bool acknowledged;     /* the sensor has accepted the present request for the stream */
    uint16_t asked;        /* position of the latest other rate in the search */
    uint32_t asked_rate;   /* of the latest such turn */
    uint32_t asked_us;     /* when it began */
    scip_kind_t asked_kind;
    uint32_t acknowledged_octets; /* counter of octets at that time */
    uint32_t requested_us;        /* when the search sent that request last */
    uint32_t request_us;          /* least time to the next one; 0: none was sent yet */
    bool heard;                   /* the search has just heard octets at the stream's rate that are no scan */
    uint32_t octets_us;           /* the step that has seen octets last */
    uint32_t stepped_us;          /* when the latest step was */
    urg_seen_t seen;              /* what was received up to the previous step */
} urg_link_t;

/* The first cause, in the order above, for which urg_link_init() refuses the configuration. */
urg_refusal_t urg_link_refusal(const urg_config_t *config);

/* Starts in WAIT. Returns false, and does nothing, when urg_link_refusal() names a cause. */
bool urg_link_init(urg_link_t *link, const urg_config_t *config, uint32_t now_us);

/* Note in *seen what the parser has received, for callers that do not use urg.h (which does both):
 * urg_seen_octets() before each step, urg_seen_event() for each event. */
void urg_seen_octets(urg_seen_t *seen, const scip_parser_t *parser);
void urg_seen_event(urg_seen_t *seen, const scip_parser_t *parser, scip_event_t event);

/* One step. seen: everything received up to now_us, with the present counters of octets and framing errors.
 * Always writes *action. */
void urg_link_step(urg_link_t *link, const urg_seen_t *seen, uint32_t now_us, urg_action_t *action);

/* Asks VV, PP and II, once: before the first stream, or in a stream that runs, which is stopped for it and
 * then ordered again. A lost stream is found first. Where one is not answered, after a second try, the rest
 * is left out. urg_link_told(): how many were answered, 0..URG_QUESTIONS. */
void urg_link_ask(urg_link_t *link);
uint16_t urg_link_told(const urg_link_t *link);

/* Orders another range, with the `scans` of it as well: a stream that runs is stopped for some revolutions,
 * and requested anew. Nothing happens when it is the present range. The range is one that
 * urg_link_refusal() accepts. */
void urg_link_order(urg_link_t *link, const scip_range_t *range);

/* The latest scan was complete at this time. Not needed, but scans come at equal distances: who tells it
 * makes the link listen at the right moments while it searches. Call it for every scan or for none. */
void urg_link_scan_at(urg_link_t *link, uint32_t now_us);

/* How long the caller may wait until the next step: URG_STEP_US; while a sensor that has streamed is
 * searched, 40 to 80 ms. Who always waits URG_STEP_US loses a few tenths of a second there, and nothing else.
 */
uint32_t urg_link_pause_us(const urg_link_t *link, const urg_seen_t *seen);

#ifdef __cplusplus
}
#endif

#endif
