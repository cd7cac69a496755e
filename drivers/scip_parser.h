/* SCIP push parser. The caller gives it octets, one at a time. It returns replies and scans. It does not
 * block, uses no heap and no clock, and its RAM is known at compile time. It works line by line: it
 * collects octets up to a LF, then checks the line, and decodes the points if there are any. So one octet
 * never costs more than the work on one line.
 *
 * A reply is accepted only when all of it is right: the echo is the awaited one, every line has its exact
 * length, every sum is right, every encoded character is within 30H..6FH, the number of points is exact,
 * and the closing empty line is there. A damaged reply is dropped as a whole and counted by its cause. It
 * does not damage the next reply: after damage, and after any unexpected line, the parser looks for the
 * awaited echo at the end of each line. So it finds the next reply even when a line end was lost, or when
 * other octets come before the echo.
 *
 * Calling context: one context per parser (in the firmware: the receive Hwi). scip_parser_expect() and
 * scip_parser_scan_into() may be called from another context, but only while the first one cannot run. */
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
    SCIP_NOTHING, /* no event yet */
    SCIP_REPLY,   /* parser->reply is complete: the reply to the awaited request, or a refused GS,
                   * GD, MS, MD */
    SCIP_SCAN,    /* a scan is complete, in the memory given by scip_parser_scan_into() */
    SCIP_NOTICE,  /* a stream frame without data: hardware trouble, or its end; see
                   * parser->reply.status */
    SCIP_TEXT,    /* one line of VV PP II: parser->line, parser->text_length, parser->text_proved */
    SCIP_LEGACY,  /* the sensor answered "E" as in SCIP1.1: it is not in SCIP2.0 */
    SCIP_DAMAGED  /* a reply or scan was dropped: parser->last_damage */
} scip_event_t;

typedef enum {
    SCIP_DAMAGE_NONE,
    SCIP_DAMAGE_SUM,       /* a sum does not match */
    SCIP_DAMAGE_LENGTH,    /* a line or the number of points is too short or too long */
    SCIP_DAMAGE_ECHO,      /* a line between two frames is not the stream's echo; or the answer has
                            * another count */
    SCIP_DAMAGE_CHARACTER, /* outside 30H..6FH in status, time stamp or data */
    SCIP_DAMAGE_SEQUENCE,  /* remaining-scan counter or time stamp does not follow the one before; the
                            * scan is dropped */
    SCIP_DAMAGE_COUNT
} scip_damage_t;

typedef struct {
    octet_t status[2];     /* two status characters; SCIP1.1: one, status[1] = 0 */
    bool legacy;           /* SCIP1.1 shape: one status character, no sum */
    uint32_t timestamp_ms; /* TM1 only, 24 bits */
} scip_reply_t;

/* One scan. The caller owns this structure and the memory of its points. The parser writes to it from
 * scip_parser_scan_into() until SCIP_SCAN; during that time its content is not valid. */
typedef struct {
    uint16_t *distance_mm; /* points in the order of their steps. Codes < 20 are error codes, not
                            * distances, and so is 4095 with two characters. Three characters saturate at
                            * 65535 */
    uint16_t capacity;
    uint16_t points;
    uint16_t characters; /* per point: 2 or 3 */
    uint16_t first_step;
    uint16_t cluster;
    uint16_t remaining;    /* scans that follow in a counted run; 0 in the last one and in an endless run */
    uint32_t timestamp_ms; /* sensor clock at step 0, 24 bits as sent */
} scip_scan_t;

/* Counters wrap at 2^32. */
typedef struct {
    uint32_t octets; /* up to the latest line end; see scip_parser_octets() */
    uint32_t
        strange; /* likewise, octets that SCIP does not have, zero and above 7FH: a wrong rate, or damage */
    uint32_t replies;
    uint32_t scans; /* good scans, delivered or not */
    uint32_t notices;
    uint32_t legacy;
    uint32_t damaged[SCIP_DAMAGE_COUNT]; /* by cause; [SCIP_DAMAGE_NONE] unused */
    uint32_t
        stray; /* replies to other than the awaited request: two line ends behind a line that was skipped */
    uint32_t foreign;       /* of them scans of another request, whole and with right sums, behind one like
                             * it: the line is good, and the sensor streams something else */
    uint32_t skipped_lines; /* lines that are not empty, not the awaited echo and not part of its reply */
} scip_counters_t;

/* Data lines have 65 characters; the information lines of some models are longer. As many cells as an octet
 * numbers: the cheapest to count. */
#define SCIP_LINE_MAX 256U

typedef struct {
    scip_reply_t reply;
    scip_damage_t last_damage;
    scip_counters_t counters;
    octet_t line[SCIP_LINE_MAX]; /* SCIP_TEXT: the line, until the next octet */
    uint16_t line_length;        /* SCIP_TEXT: of the whole line, ';' and sum included */
    uint16_t text_length;        /* SCIP_TEXT: characters before ';' and sum; line_length when it has none */
    bool text_proved;       /* SCIP_TEXT: the line has a sum and it is right; some sensors send wrong sums */
    scip_request_t awaited; /* latest given to scip_parser_expect(); its kind is that of SCIP_REPLY */
    /* private */
    bool awaiting;
    uint16_t echo_fixed; /* octets of the awaited echo that never change: all except the counter of
                          * a counted run */
    octet_t echo_first;  /* of the awaited echo */
    uint16_t state;
    octet_t gathered;      /* cell of `line` for the next octet; behind the last one comes the first again */
    bool skipping;         /* the line before was skipped and not empty */
    uint16_t foreign_line; /* of a scan of another request: what must come next */
    bool foreign_before;   /* the frame before was one */
    scip_scan_t *scan;
    uint16_t characters_left;  /* of the scan's data */
    uint32_t partial;          /* first characters of a point that straddles two blocks */
    uint32_t timestamp_ms;     /* of the frame in reception */
    uint16_t remaining;        /* of the frame in reception */
    bool flowing;              /* the answer to the stream request, or a frame of it, was received */
    bool gap;                  /* data were lost since the latest good frame */
    bool doubted;              /* the latest frame was dropped because of its sequence */
    uint16_t latest_remaining; /* of the latest good frame */
    bool in_step;              /* no frame was lost between the latest good frame and the good frame
                                * before it: its counter is lower by one */
    uint16_t stamps;           /* number of last_stamps_ms that count, 0..2 */
    uint32_t last_stamps_ms[2];
} scip_parser_t;

void scip_parser_init(scip_parser_t *parser);

/* Awaits the reply to this request from now on. The request is copied. Replies to earlier requests are
 * skipped. Octets of an incomplete line are kept, because the reply may already be in them. */
void scip_parser_expect(scip_parser_t *parser, const scip_request_t *request);

/* Sets the memory for the next scan. NULL: scans are checked and counted, but not stored and not
 * delivered. A scan with more points than `capacity` counts as damage by length. On SCIP_SCAN the memory
 * may be exchanged, so two memories can alternate without a copy. At any other time the scan under way is
 * dropped. The memory must stay valid while the parser uses it. */
void scip_parser_scan_into(scip_parser_t *parser, scip_scan_t *scan);

/* Call this when the UART lost or damaged octets. The parser drops what it is receiving. The caller counts
 * the cause. */
void scip_parser_line_broken(scip_parser_t *parser);

/* Received octets, and the strange ones among them, the present line included. Of a line longer than its
 * memory only what its memory holds. */
uint32_t scip_parser_octets(const scip_parser_t *parser);
uint32_t scip_parser_strange(const scip_parser_t *parser);

/* Number of octets until the present reply or scan is complete, as far as it is known now; 0: not known.
 * Between two scans of a stream it is that of the next scan. A notice, or the end of the stream, is
 * shorter. */
uint16_t scip_parser_expected(const scip_parser_t *parser);

/* Private part of scip_parser_feed(): a line is complete. */
scip_event_t scip_parser_end_line(scip_parser_t *parser);

/* Processes one octet; bits above bit 7 are ignored. Events other than SCIP_NOTHING come with a LF only.
 * The function is inline because an interrupt calls it for every octet. */
static inline scip_event_t scip_parser_feed(scip_parser_t *parser, octet_t octet)
{
    const octet_t clean = octet_of(octet);
    if (clean == SCIP_LINE_FEED) {
        return scip_parser_end_line(parser);
    }
    const size_t at = parser->gathered;
    parser->gathered = (octet_t)((at + 1U) % SCIP_LINE_MAX);
    parser->line[at] = clean;
    return SCIP_NOTHING;
}

/* As scip_parser_feed(), for octets that come in blocks (FIFO, DMA, read()), at a lower cost. It stops
 * after the octet that makes an event, or at the end. Returns the number of octets it has used; *event is
 * SCIP_NOTHING when there was no event. Call it again with the octets that are left. */
size_t scip_parser_feed_run(scip_parser_t *parser, const octet_t *octets, size_t count, scip_event_t *event);

/* Extends the sensor's 24-bit time stamp to 32 bits: returns the first time at or after unwrapped_ms whose
 * low 24 bits are timestamp_ms. The result wraps at 2^32. For the first call, unwrapped_ms is the first
 * stamp itself. Correct while there are less than 4 h 39 min between two calls. */
uint32_t scip_unwrap_ms(uint32_t unwrapped_ms, uint32_t timestamp_ms);

#ifdef __cplusplus
}
#endif

#endif
