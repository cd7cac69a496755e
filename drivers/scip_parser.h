/* SCIP push parser: octets in, one at a time, replies and scans out. No blocking call, no heap, no clock; RAM known at
 * compile time. Line oriented: octets are gathered up to a LF, then the line is checked and, when it holds points,
 * decoded. No octet costs more than the work on one line.
 *
 * A reply is believed only whole: echo equal to the awaited one, every line of its exact length, every sum right, every
 * encoded character within 30H..6FH, the number of points exact, the closing empty line there. A damaged reply yields
 * nothing, costs only itself and is counted by cause. After damage, and whenever a line is not what was to come, the
 * awaited echo is looked for at the end of that line and of every later one, so the next reply is found even when the
 * line ends before it were lost or other octets stand in front of it.
 *
 * Calling context: one context per parser (the firmware: its receive Hwi); scip_parser_expect() and
 * scip_parser_scan_into() from another context only while that one is excluded. */
#ifndef DRIVERS_SCIP_PARSER_H
#define DRIVERS_SCIP_PARSER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "drivers/scip_request.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    SCIP_NOTHING,       /* go on feeding */
    SCIP_REPLY,         /* the awaited request's reply is complete: parser->reply. Also a refused GS, GD, MS, MD */
    SCIP_SCAN,          /* a scan is complete in the scan given by scip_parser_scan_into() */
    SCIP_NOTICE,        /* a stream frame without data: hardware trouble or its all-clear, parser->reply.status */
    SCIP_TEXT,          /* one line of VV PP II: parser->line, parser->text_length, parser->text_proved */
    SCIP_LEGACY,        /* a SCIP1.1 sensor answered "E": it is not (or no longer) in SCIP2.0 */
    SCIP_DAMAGED        /* a reply or scan was lost just now: parser->last_damage */
} scip_event_t;

typedef enum {
    SCIP_DAMAGE_NONE,
    SCIP_DAMAGE_SUM,        /* a sum does not match */
    SCIP_DAMAGE_LENGTH,     /* a line or the number of points is too short or too long */
    SCIP_DAMAGE_ECHO,       /* between two frames: a line that is not the stream's echo; an answer with another count */
    SCIP_DAMAGE_CHARACTER,  /* outside 30H..6FH in status, time stamp or data */
    SCIP_DAMAGE_SEQUENCE,   /* remaining-scan counter or time stamp did not follow; the scan itself is dropped */
    SCIP_DAMAGE_COUNT
} scip_damage_t;

typedef struct {
    octet_t status[2];      /* two status characters; SCIP1.1: one, status[1] = 0 */
    bool legacy;            /* SCIP1.1 shape: one status character, no sum */
    uint32_t timestamp_ms;  /* TM1 only, 24 bits */
} scip_reply_t;

/* One scan. The owner gives the memory of the points. From scip_parser_scan_into() to SCIP_SCAN the parser writes to it
 * and its content means nothing. */
typedef struct {
    uint16_t *distance_mm;  /* points in the order of their steps; codes < 20 are no distances, nor is 4095 with two
                               characters; three characters saturate at 65535 */
    uint16_t capacity;
    uint16_t points;
    uint16_t characters;    /* per point: 2 or 3 */
    uint16_t first_step;
    uint16_t cluster;
    uint16_t remaining;     /* scans still to come of a counted run; 0 also for endless */
    uint32_t timestamp_ms;  /* sensor clock at step 0, 24 bits as sent */
} scip_scan_t;

/* Counters wrap at 2^32. */
typedef struct {
    uint32_t replies;
    uint32_t scans;         /* good ones, delivered or not */
    uint32_t notices;
    uint32_t legacy;
    uint32_t damaged[SCIP_DAMAGE_COUNT]; /* by cause; [SCIP_DAMAGE_NONE] unused */
    uint32_t skipped_lines; /* not empty, and neither the awaited echo nor part of its reply */
    uint32_t octets;        /* counted at line ends */
} scip_counters_t;

/* private: how far a scan's points are decoded */
typedef struct {
    uint16_t points;
    uint16_t partial_characters;
    uint32_t partial;           /* first characters of a point that straddles two blocks */
} scip_progress_t;

/* Data lines have 65 characters; the information lines of some models are longer. */
#define SCIP_LINE_MAX 80U

typedef struct {
    scip_reply_t reply;
    scip_damage_t last_damage;
    scip_counters_t counters;
    octet_t line[SCIP_LINE_MAX];/* SCIP_TEXT: the line, until the next octet */
    uint16_t line_length;       /* SCIP_TEXT: of the whole line, ';' and sum included */
    uint16_t text_length;       /* SCIP_TEXT: characters before ';' and sum; line_length when it has none */
    bool text_proved;           /* SCIP_TEXT: the line has a sum and it is right; some firmware sends wrong ones */
    scip_request_t awaited;     /* latest given to scip_parser_expect(); its kind is that of SCIP_REPLY */
    /* private */
    bool awaiting;
    uint16_t echo_fixed;        /* octets of the awaited echo that never change: all but a counted run's counter */
    uint16_t state;
    uint16_t gathered;          /* octets of the line in reception */
    bool line_cut;              /* more came than fits: only the line's last octets are kept */
    bool skipping;              /* the line before was skipped and not empty */
    scip_scan_t *scan;
    uint16_t characters_left;   /* of the scan's data */
    scip_progress_t progress;
    uint32_t timestamp_ms;      /* of the frame in reception */
    uint16_t remaining;         /* of the frame in reception */
    bool flowing;               /* the stream's answer or a frame has come */
    bool gap;                   /* something was lost since the last good frame */
    bool doubted;               /* the last frame was dropped for its sequence */
    uint16_t latest_remaining;  /* of the latest good frame */
    bool in_step;               /* the latest good frame followed its predecessor: no loss between, counter one lower */
    uint16_t stamps;            /* number of last_stamps_ms that count, 0..2 */
    uint32_t last_stamps_ms[2];
} scip_parser_t;

void scip_parser_init(scip_parser_t *parser);

/* From now on the reply to this request is awaited (copied). A reply to an earlier request is skipped. Partial input is
 * kept: the reply may already be in the line. */
void scip_parser_expect(scip_parser_t *parser, const scip_request_t *request);

/* Where the next scan goes; NULL: scans are checked and counted but not stored and not delivered. A scan with more
 * points than capacity is damage by length. May be changed on SCIP_SCAN, so that two memories can take turns without
 * copying; at another time the scan in reception is given up. The scan must outlive its use here. */
void scip_parser_scan_into(scip_parser_t *parser, scip_scan_t *scan);

/* The UART lost or mangled octets: what is being received is given up (the caller counts the cause). */
void scip_parser_line_broken(scip_parser_t *parser);

/* Octets still to come until the reply or scan under way is complete, as far as that is known by now; 0 when it is not.
 * Between the scans of a stream: of the next one. A notice or the stream's end is shorter. */
uint16_t scip_parser_expected(const scip_parser_t *parser);

/* Private halves of scip_parser_feed(): a line is complete; a line is full and only its last octets are kept. */
scip_event_t scip_parser_end_line(scip_parser_t *parser);
void scip_parser_cut_line(scip_parser_t *parser);

/* One octet; what is above its bit 7 is ignored. Events other than SCIP_NOTHING come at a LF. Inline, because an
 * interrupt calls it for every octet. */
static inline scip_event_t scip_parser_feed(scip_parser_t *parser, octet_t octet)
{
    const octet_t clean = octet_of(octet);
    if (clean == SCIP_LINE_FEED) {
        return scip_parser_end_line(parser);
    }
    parser->line[parser->gathered] = clean;
    parser->gathered++;
    if (parser->gathered == SCIP_LINE_MAX) {
        scip_parser_cut_line(parser);
    }
    return SCIP_NOTHING;
}

/* The same for octets that come in bursts (FIFO, DMA, read()), at less cost: takes them up to and including the one that
 * makes an event, or all. Returns how many were taken; *event is SCIP_NOTHING when no event came. Call again
 * with the rest. */
size_t scip_parser_feed_run(scip_parser_t *parser, const octet_t *octets, size_t count, scip_event_t *event);

/* Sensor time without the wrap of 24 bits: the first time at or after unwrapped_ms (wrapping at 2^32) whose low 24 bits
 * are timestamp_ms. Start with the first stamp itself; right as long as less than 4 h 39 min lie between two calls. */
uint32_t scip_unwrap_ms(uint32_t unwrapped_ms, uint32_t timestamp_ms);

#ifdef __cplusplus
}
#endif

#endif
