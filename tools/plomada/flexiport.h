/* Logs of the library flexiport, as hokuyoaist writes them (.logr: what a sensor sent). A log is a row of
 * chunks, each a head and its octets. Two forms of head are in use: seconds, microseconds and size of 32 bits
 * each, most significant octet first; and of 64 bits each, least significant first, by older versions. */
#ifndef TOOLS_PLOMADA_FLEXIPORT_H
#define TOOLS_PLOMADA_FLEXIPORT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    /* private */
    size_t width; /* of a number in a head, 0: no log */
    unsigned char head[24];
    size_t head_length;
    unsigned long long left; /* octets of the present chunk */
    bool broken;
} flexiport_t;

typedef void (*flexiport_take_t)(void *context, const unsigned char *octets, size_t count);

/* Looks at the first octets of a file. True when they are those of a log. */
bool flexiport_begin(flexiport_t *log, const unsigned char *octets, size_t count);

/* Hands the chunks' octets over, without the heads. False when the log is broken there. */
bool flexiport_feed(flexiport_t *log, const unsigned char *octets, size_t count, flexiport_take_t take,
                    void *context);

#endif
