/* One octet of wire data.
 *
 * A C28x cell has 16 bits, so an octet may live in a wider cell: every store of an octet goes through
 * octet_of(), which drops what is above bit 7 (an SCI FIFO word carries flag bits there). Arithmetic on
 * octets is done in uint16_t or uint32_t, never by wrapping. */
#ifndef DRIVERS_OCTET_H
#define DRIVERS_OCTET_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint_least8_t octet_t;

static inline octet_t octet_of(uint16_t cell)
{
    return (octet_t)(cell & 0xFFU);
}

#ifdef __cplusplus
}
#endif

#endif
