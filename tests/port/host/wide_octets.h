/* -include this on a PC: octets in cells of 16 bits. Code that counts on an octet to wrap at 256, or to drop
 * what does not fit into 8 bits, fails its tests. */
#ifndef PORT_HOST_WIDE_OCTETS_H
#define PORT_HOST_WIDE_OCTETS_H

#include <inttypes.h>
#include <stdint.h>

#define uint8_t uint16_t
#define int8_t int16_t
#define uint_least8_t uint_least16_t
#define int_least8_t int_least16_t

#endif
