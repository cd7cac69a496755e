/* The URG-04LX from power-up to a stream of scans, and back to it after any loss: a state machine without
 * clock, port or task. It is stepped every 150 ms with what the parser has seen and answers with what to do.
 *
 *   WAIT -> STOP1 (L0) -> SWITCH (SCIP2.0) -> RATE (SS) -> STOP2 (QT) -> STREAM (MS) -> OK
 *
 * Each command is repeated, after its own time-out, until confirmed; the own UART follows a new rate one step
 * after the sensor's reply. Nothing is assumed of the sensor's state. QT is what every state answers (SCIP2.0
 * "00", streaming "00" after the frames under way, time mode "0E", SCIP1.1 "E"), so QT is asked at one rate
 * after the other, for ever, when the sensor is not where it should be. Found there, but without scans: QT
 * and MS again, then TM2, then RS. A stream that stops is looked for with MS at its own rate and with SCIP2.0
 * at the first rate, every step.
 *
 * Pure; Task context (TaskSendLaser). Times in microseconds, wrapping; steps must be less than 35 minutes
 * apart. */
#ifndef DRIVERS_URG_LINK_H
#define DRIVERS_URG_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_parser.h"
#include "drivers/scip_request.h"

#ifdef __cplusplus
extern "C" {
#endif

/* LASER_STATUS of the seed: guides the start-up and is shown in the telemetry. */
typedef enum {
    URG_WAIT,   /* the sensor's own power-up time */
    URG_STOP1,  /* L0 sent */
    URG_SWITCH, /* SCIP2.0 sent */
    URG_RATE,   /* SS sent */
    URG_STOP2,  /* QT sent, or TM2: the sensor has answered at this rate */
    URG_STREAM, /* MS sent */
    URG_OK,     /* scans arrive */
    URG_LOST,   /* no answer, or scans have stopped: looking for the sensor, first at the known rates */
    URG_OLD, /* the sensor speaks SCIP1.1 only: its firmware is older than 3.0. It is asked again for ever */
    URG_STATUS_COUNT
} urg_status_t;

/* "WAIT" "STOP1" "SWITCH" "RATE" "STOP2" "STREAM" "OK" "LOST" "OLD". */
const char *urg_status_name(urg_status_t status);

/* What the receiving side has seen since power-up; counters only rise (and wrap). */
typedef struct {
    uint32_t reply_count;   /* replies to awaited requests */
    scip_kind_t reply_kind; /* of the latest */
    scip_reply_t reply;     /* the latest */
    uint32_t scan_count;
    uint16_t scan_remaining; /* of the latest scan; only looked at in counted runs */
    uint32_t legacy_count;   /* SCIP1.1 "E" answers */
    uint32_t notice_count;
    scip_reply_t notice; /* latest hardware notice */
    uint32_t octet_count;
    uint32_t framing_count; /* UART framing errors: wrong rate, or cable */
    uint32_t
        strange_count; /* octets above 7F, which no sensor sends: the same, where the UART tells no errors */
    uint32_t damage_count; /* all causes */
} urg_seen_t;

typedef struct {
    uint32_t wait_us;      /* 10 s; 0 after a watchdog reset. Ends early when the sensor is heard */
    uint32_t first_rate;   /* the UART is opened at this rate: 115200 */
    uint32_t stream_rate;  /* 250000 */
    uint32_t fastest_rate; /* of the own UART and its line driver: no faster one is tried. 0: any */
    scip_kind_t stream;    /* SCIP_STREAM_2 or SCIP_STREAM_3 */
    scip_range_t range;    /* scans > 0: a counted run, ordered again when it ends */
} urg_config_t;

typedef struct {
    bool set_rate;    /* reopen the own UART at `rate` before sending */
    uint32_t rate;    /* own UART from now on, changed or not */
    bool expect;      /* hand `request` to the parser ... */
    bool send;        /* ... then to the wire */
    bool cycle_power; /* boards with a power pin for the sensor: off and on. Others do nothing */
    scip_request_t request;
} urg_action_t;

typedef struct {
    urg_config_t config;
    urg_status_t status;
    uint32_t since_us;    /* status entered */
    uint32_t sent_us;     /* latest command */
    uint32_t timeout_us;  /* of the latest command; in OK: of the next scan */
    uint32_t rate;        /* own UART now */
    uint16_t attempt;     /* of the present command, 1.. */
    uint32_t restarts;    /* times the stream was lost */
    uint32_t timeouts;    /* commands without an answer */
    uint16_t failures;    /* times in a row that scans did not come or stopped, up to the ladder's top */
    uint32_t scan_us;     /* latest scan, power cycle or end of WAIT */
    scip_kind_t command;  /* the latest */
    bool waiting;         /* a command is out */
    bool rate_refused;    /* the sensor does not know stream_rate: stay at this one */
    bool is_idle;         /* the sensor was in SCIP1.1 when it was switched to SCIP2.0 */
    bool line_unknown;    /* the sensor may hold part of a line: end it before the next command */
    uint16_t scan_octets; /* one frame of the stream */
    uint32_t sent_octets; /* octets and signs of a wrong rate when the latest command was sent */
    uint32_t sent_signs;
    uint32_t good_rate; /* scans have come at this rate; 0: none yet */
    bool knocking;      /* the present command is one of those */
    uint16_t knocks;    /* commands of the search at the known rates, since the latest scan */
    urg_seen_t seen;    /* at the previous step */
} urg_link_t;

/* False, and nothing is done, when the sensor or the own UART cannot do what the configuration says: another
 * rate than SCIP's, one above fastest_rate, a range that scip_request_scan() refuses, or another kind than a
 * stream. */
bool urg_link_init(urg_link_t *link, const urg_config_t *config, uint32_t now_us);

/* The bookkeeping of a receiving side that has parser and link apart: what came from the UART, before it is
 * fed; and each event of the parser. urg.h does both. */
void urg_seen_octets(urg_seen_t *seen, const octet_t *octets, size_t count);
void urg_seen_event(urg_seen_t *seen, const scip_parser_t *parser, scip_event_t event);

/* `seen` is what was received up to now; its octet and framing counts too are those of this moment, whether
 * or not anything was complete since the last step. *action is written whole. */
void urg_link_step(urg_link_t *link, const urg_seen_t *seen, uint32_t now_us, urg_action_t *action);

#ifdef __cplusplus
}
#endif

#endif
