/* -include this with avr-gcc, for sources that went through cells.py: a machine with CHAR_BIT 16, as the C28x
 * is. A cell has 16 bits; char and the 8-bit names are one cell; sizeof, and the sizes given to the functions
 * of the library, count cells. Pointers and size_t stay one cell (C28x: two), bool takes one. */
#ifndef PORT_AVR_CELLS_H
#define PORT_AVR_CELLS_H

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cell_library.h"

#define CELLS_OF(bytes) (((bytes) + 1U) / 2U)

#undef bool
typedef _Bool bool __attribute__((aligned(2)));

#undef CHAR_BIT
#define CHAR_BIT 16
#undef SCHAR_MIN
#define SCHAR_MIN INT_MIN
#undef SCHAR_MAX
#define SCHAR_MAX INT_MAX
#undef CHAR_MIN
#define CHAR_MIN INT_MIN
#undef CHAR_MAX
#define CHAR_MAX INT_MAX
#undef UCHAR_MAX
#define UCHAR_MAX UINT_MAX

#define uint8_t uint16_t
#define int8_t int16_t
#define uint_least8_t uint_least16_t
#define int_least8_t int_least16_t
#define char int

#define memcpy cell_memcpy
#define memmove cell_memmove
#define memset cell_memset
#define memcmp cell_memcmp
#define memchr cell_memchr
#define strlen cell_strlen
#define strcpy cell_strcpy
#define strcmp cell_strcmp
#define strncmp cell_strncmp
#define strchr cell_strchr
#define strstr cell_strstr
#define strtoul cell_strtoul
#define atol cell_atol
#define atoi cell_atoi
#define snprintf cell_snprintf
#define printf cell_printf
#define fopen cell_fopen
#define fgets cell_fgets
#define qsort cell_qsort

/* Of these there is none for cells; the machine's own would count octets. */
#pragma GCC poison strcat strncat strncpy strrchr strspn strcspn strpbrk strtok strtol strtod sprintf vsprintf
#pragma GCC poison sscanf fprintf fputs fputc fread fwrite

#endif
