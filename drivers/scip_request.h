/* SCIP requests, and what is known of the reply before it comes: the descriptor of the last command sent
 * (type, echo, expected lengths). SCIP1.1 stop and switch, SCIP2.0 (Hokuyo C-42-03320B). Pure; the caller
 * owns the request. */
#ifndef DRIVERS_SCIP_REQUEST_H
#define DRIVERS_SCIP_REQUEST_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/octet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A request is at most LF + symbol + parameters + LF (MS/MD: 16 + 1); no user string is ever sent. */
#define SCIP_REQUEST_MAX 17U
#define SCIP_STEP_MAX 768U /* steps are numbered 0..768 */
#define SCIP_POINTS_MAX 769U
#define SCIP_LINE_FEED 0x0AU /* ends every line of a reply */
#define SCIP_BLOCK 64U       /* data characters in every block but the last */

typedef enum {
    SCIP_LASER_OFF_1, /* "L0", SCIP1.1 stop */
    SCIP_SWITCH,      /* "SCIP2.0" */
    SCIP_BIT_RATE,    /* "SSbbbbbb"; the reply comes at the old rate */
    SCIP_STOP,        /* "QT" */
    SCIP_LASER_ON,    /* "BM" */
    SCIP_RESET,       /* "RS"; the rate falls back after the reply */
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

/* What part of the circle to report, and how. */
typedef struct {
    uint16_t first_step; /* 0..768 */
    uint16_t last_step;  /* first_step..768 */
    uint16_t cluster;    /* 1..99 neighbouring steps per point */
    uint16_t interval;   /* 0..9 scans left out between two reports; streams only */
    uint16_t scans;      /* 1..99, 0 = endless; streams only */
} scip_range_t;

typedef struct {
    scip_kind_t kind;
    octet_t text[SCIP_REQUEST_MAX]; /* what goes on the wire, LF included */
    uint16_t text_length;
    uint16_t echo_length;  /* the reply's first line: the last echo_length octets before text's final LF */
    uint16_t reply_octets; /* whole reply when accepted, echo to final LF; 0 = not known (text replies) */
    uint16_t scan_octets;  /* streams: each following scan; else 0 */
    uint16_t characters;   /* per point: 2, 3; 0 = no points */
    uint16_t points;       /* expected in one scan */
    scip_range_t range;    /* as asked; zero when the request has none */
    uint32_t bit_rate;     /* SCIP_BIT_RATE only */
} scip_request_t;

/* What a sensor can be set to, slowest first. */
#define SCIP_BIT_RATES 6U
extern const uint32_t scip_bit_rates[SCIP_BIT_RATES];

/* Octets of one scan of n points, from echo to final LF: 27 + k n + 2 ceil(k n / 64) for MS/MD, 24 + ... for
 * GS/GD. points: 0..769. 0 for a kind without points. */
uint16_t scip_scan_octets(scip_kind_t kind, uint16_t points);

/* Requests without parameters. False (request untouched) when kind needs some. */
bool scip_request(scip_request_t *request, scip_kind_t kind);

/* "SS": rates 19200, 57600, 115200, 250000, 500000, 750000; false (request untouched) for any other. */
bool scip_request_bit_rate(scip_request_t *request, uint32_t bit_rate);

/* MS MD GS GD. False (request untouched) for another kind or when a field is outside its range above. */
bool scip_request_scan(scip_request_t *request, scip_kind_t kind, const scip_range_t *range);

/* Puts a LF in front of the text: ends what the sensor may have half received (a host's cut command, noise,
 * octets at another rate), so that it is not read as part of this one. The reply stays the same. Idempotent.
 */
void scip_request_end_line_first(scip_request_t *request);

/* The echo's first octet, within request->text. */
static inline const octet_t *scip_request_echo(const scip_request_t *request)
{
    return &request->text[request->text_length - 1U - request->echo_length];
}

#ifdef __cplusplus
}
#endif

#endif
