/* A recording of what a scanner sent, read with the product's parser: the echo lines in the stream say what
 * was asked for (MS, MD, GS, GD with steps, cluster, width), and the parser is made to await them. Starts
 * anywhere in a stream. */
#ifndef TOOLS_PLOMADA_SCIP_READER_H
#define TOOLS_PLOMADA_SCIP_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"

#define SCIP_READER_LINE 256U /* of a longer line only the end is kept, where its echo may be */

typedef void (*scip_reader_take_t)(void *context, const scip_scan_t *scan);

typedef struct {
    unsigned long scans;   /* taken */
    unsigned long answers; /* to MS, MD, GS, GD, refusals included */
    unsigned long notices; /* hardware trouble and its all-clear */
    unsigned long skipped; /* packets that are no reply to MS, MD, GS, GD */
    bool unfinished;       /* the input ended within a reply */
} scip_reader_totals_t;

typedef struct {
    scip_reader_take_t take;
    void *context;
    scip_reader_totals_t totals;
    scip_parser_t parser; /* its counters hold the damage by cause */
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
    bool in_rest;       /* within what is left of a damaged reply */
} scip_reader_t;

/* The reader must stay where it is. `take` gets each good scan, valid during the call. */
void scip_reader_init(scip_reader_t *reader, scip_reader_take_t take, void *context);
void scip_reader_feed(scip_reader_t *reader, const unsigned char *octets, size_t count);
void scip_reader_end(scip_reader_t *reader);

/* Feeds the whole file, "-" is stdin. NULL when fine, else what failed. */
const char *scip_reader_file(scip_reader_t *reader, const char *path);

/* Scans, damage by cause, what was skipped; a few lines. */
void scip_reader_print(const scip_reader_t *reader, FILE *out);

#endif
