/* One octet of wire data.
 *
 * A cell of the C28x has 16 bits, so an octet may be stored in a wider cell. Use octet_of() for every store:
 * it clears the bits above bit 7, where a word of the SCI FIFO has flags. Calculate with octets in uint16_t
 * or uint32_t; never rely on wrapping at 8 bits. */
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
