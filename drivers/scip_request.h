/* Builds SCIP requests. A request also holds what the parser must know about the reply: echo and expected
 * lengths. Requests of SCIP2.0 (Hokuyo C-42-03320B), and stop and switch of SCIP1.1. Pure; the caller owns
 * the request. */
#ifndef DRIVERS_SCIP_REQUEST_H
#define DRIVERS_SCIP_REQUEST_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/octet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Longest request: LF, TM2, LF, symbol, parameters, LF (MS and MD: 16 + 5). User strings are not sent. */
#define SCIP_REQUEST_MAX 21U
#define SCIP_STEP_MAX 1080U        /* steps of UTM-30LX and UST-10LX are numbered 0..1080 */
#define SCIP_STEP_MAX_URG04LX 768U /* of the URG-04LX 0..768: it refuses others */
#define SCIP_POINTS_MAX 1081U
#define SCIP_LINE_FEED 0x0AU /* ends every line of a reply */
#define SCIP_BLOCK 64U       /* data characters in every block but the last */

typedef enum {
    SCIP_LASER_OFF_1, /* "L0", SCIP1.1 stop */
    SCIP_SWITCH,      /* "SCIP2.0" */
    SCIP_BIT_RATE,    /* "SSbbbbbb"; the reply is sent at the old rate */
    SCIP_STOP,        /* "QT" */
    SCIP_LASER_ON,    /* "BM" */
    SCIP_RESET,       /* "RS"; after the reply the sensor returns to its first rate */
    SCIP_TIME_ENTER,
    SCIP_TIME_READ,
    SCIP_TIME_LEAVE, /* "TM0" "TM1" "TM2" */
    SCIP_VERSION,
    SCIP_PARAMETERS,
    SCIP_STATE, /* "VV" "PP" "II": text lines */
    SCIP_STREAM_2,
    SCIP_STREAM_3, /* "MS" "MD": 2 or 3 characters a point */
    SCIP_SINGLE_2,
    SCIP_SINGLE_3, /* "GS" "GD" */
    SCIP_KIND_COUNT
} scip_kind_t;

/* Part of the revolution to report, and how often. */
typedef struct {
    uint16_t first_step; /* 0..1080 */
    uint16_t last_step;  /* first_step..1080 */
    uint16_t cluster;    /* steps per point, 1..99 */
    uint16_t interval;   /* scans skipped between two reports, 0..9; streams only */
    uint16_t scans;      /* 1..99, 0 = endless; streams only */
} scip_range_t;

typedef struct {
    scip_kind_t kind;
    octet_t text[SCIP_REQUEST_MAX]; /* octets to send, with LF */
    uint16_t text_length;
    uint16_t echo_length; /* the echo, the reply's first line, is the last echo_length octets before the final
                             LF of text */
    uint16_t reply_octets; /* length of the reply when accepted, echo to final LF; 0 = not known (text) */
    uint16_t scan_octets;  /* streams: length of each following scan; else 0 */
    uint16_t characters;   /* per point: 2 or 3; 0 = no points */
    uint16_t points;       /* number of points expected in one scan */
    scip_range_t range;    /* the requested range; zero when the request has none */
    uint32_t bit_rate;     /* SCIP_BIT_RATE only */
} scip_request_t;

/* Bit rates of the sensor, in bits per second, lowest first. */
#define SCIP_BIT_RATES 6U
extern const uint32_t scip_bit_rates[SCIP_BIT_RATES];

/* Length of one scan in octets, from echo to final LF. For n points of k characters: 27 + k n + 2 ceil(k n /
 * 64) with MS and MD, 24 + ... with GS and GD. points: 0..1081. Returns 0 for a kind without points. */
uint16_t scip_scan_octets(scip_kind_t kind, uint16_t points);

/* Builds a request without parameters. Returns false, and does not write *request, when this kind needs some.
 */
bool scip_request(scip_request_t *request, scip_kind_t kind);

/* Builds SS. bit_rate: 19200, 57600, 115200, 250000, 500000 or 750000. Returns false, and does not write
 * *request, for any other rate. */
bool scip_request_bit_rate(scip_request_t *request, uint32_t bit_rate);

/* Builds MS, MD, GS or GD. Returns false, and does not write *request, for another kind, or when a field of
 * *range is outside its limits above. */
bool scip_request_scan(scip_request_t *request, scip_kind_t kind, const scip_range_t *range);

/* Puts a LF in front of the text. The LF ends an incomplete line that the sensor may hold (an interrupted
 * command, noise, octets at another rate). So the sensor does not read the two as one command. The reply does
 * not change. A second call changes nothing. */
void scip_request_end_line_first(scip_request_t *request);

/* Puts LF, TM2 and LF in front of the text: a sensor in time mode leaves it first, and any other refuses TM2
 * and obeys the request. Its own answer, one revolution earlier, is not the awaited one. */
void scip_request_leave_time_first(scip_request_t *request);

/* Pointer to the echo's first octet, within request->text. */
static inline const octet_t *scip_request_echo(const scip_request_t *request)
{
    return &request->text[request->text_length - 1U - request->echo_length];
}

#ifdef __cplusplus
}
#endif

#endif
