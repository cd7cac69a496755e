/* -include this with a compiler for a machine of 32 bits, for sources that went through
 * tests/port/avr/cells.py: what lives in one cell of a C28x (char, an octet, bool) takes 16 bits here too, so
 * that half the bytes of a variable or of a stack frame are its cells. */
#ifndef TOOLS_SIZE_CELLS_H
#define TOOLS_SIZE_CELLS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define CELLS_OF(bytes) (((bytes) + 1U) / 2U)

#undef bool
typedef _Bool bool __attribute__((aligned(2)));

#define uint_least8_t uint_least16_t
#define int_least8_t int_least16_t
#define char __WCHAR_TYPE__

#endif
