/* A recording of what a scanner sent, raw or as a log of flexiport, read with the product's parser: the echo
 * lines in the stream say what was asked for (MS, MD, GS, GD with steps, cluster, width), and the parser is
 * made to await them. Starts anywhere in a stream. What the sensor tells of itself (VV, PP, II) is gathered.
 */
#ifndef TOOLS_PLOMADA_SCIP_READER_H
#define TOOLS_PLOMADA_SCIP_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "drivers/scip_info.h"
#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"

#define SCIP_READER_LINE 256U /* of a longer line only the end is kept, where its echo may be */
#define SCIP_READER_SYMBOLS 24U
#define SCIP_READER_SYMBOL 8U /* "SCIP2.0" and its end */

typedef void (*scip_reader_take_t)(void *context, const scip_scan_t *scan);

typedef struct {
    unsigned long scans;   /* taken */
    unsigned long answers; /* to MS, MD, GS, GD, refusals included */
    unsigned long notices; /* hardware trouble and its all-clear */
    unsigned long skipped; /* packets that are no reply to MS, MD, GS, GD */
    bool unfinished;       /* the input ended within a reply */
} scip_reader_totals_t;

/* Packets that were skipped, by the command that they answer. */
typedef struct {
    char symbol[SCIP_READER_SYMBOL];
    unsigned long count;
} scip_reader_skipped_t;

typedef struct {
    scip_reader_take_t take;
    void *context;
    scip_reader_totals_t totals;
    scip_reader_skipped_t
        skipped[SCIP_READER_SYMBOLS]; /* a count of 0 ends them; the last takes all others */
    scip_info_t info;                 /* of the sensor, as far as it is in the recording */
    scip_parser_t parser;             /* its counters hold the damage by cause */
    scip_scan_t scan;
    uint16_t distance_mm[SCIP_POINTS_MAX];
    /* private */
    octet_t line[SCIP_READER_LINE];
    size_t length;
    octet_t echo[SCIP_READER_LINE]; /* a line that ends like an echo, held until its status line tells more */
    size_t echo_length;
    bool holding;
    bool within;        /* a reply has begun */
    bool awaiting;      /* the parser goes on awaiting the present stream */
    unsigned remaining; /* of a counted run: its counter in the latest echo */
    bool skipping;      /* within a packet that is no such reply */
    scip_parser_t text; /* of VV, PP and II */
    bool in_rest;       /* within what is left of a damaged reply */
} scip_reader_t;

/* The reader must stay where it is. `take` gets each good scan, valid during the call. */
void scip_reader_init(scip_reader_t *reader, scip_reader_take_t take, void *context);
void scip_reader_feed(scip_reader_t *reader, const unsigned char *octets, size_t count);
void scip_reader_end(scip_reader_t *reader);

/* Feeds the whole file, raw or a log of flexiport; "-" is stdin. NULL when fine, else what failed. */
const char *scip_reader_file(scip_reader_t *reader, const char *path);

/* Replies and scans, of every cause. */
unsigned long scip_reader_damaged(const scip_reader_t *reader);

/* Scans, damage by cause, which sensor, what was skipped and why; a few lines. */
void scip_reader_print(const scip_reader_t *reader, FILE *out);

#endif
