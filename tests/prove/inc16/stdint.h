/* The widths of a C28x for CBMC --LP32 (int 16 bits, long and pointers 32); its own header would make
 * uint32_t 16 bits wide. An octet's cell has 16 bits, so what stands above bit 7 is tried too. */
#ifndef PROVE_STDINT_H
#define PROVE_STDINT_H
typedef unsigned short uint16_t;
typedef short int16_t;
typedef unsigned long uint32_t;
typedef long int32_t;
typedef unsigned long long uint64_t;
typedef long long int64_t;
typedef uint16_t uint_least8_t;
typedef int16_t int_least8_t;
typedef uint16_t uint_least16_t;
typedef int16_t int_least16_t;
typedef uint32_t uint_least32_t;
typedef int32_t int_least32_t;
typedef uint16_t uint_fast16_t;
typedef int16_t int_fast16_t;
typedef uint32_t uint_fast32_t;
typedef unsigned long uintptr_t;
#define UINT16_MAX 0xFFFFU
#define INT16_MAX 32767
#define INT16_MIN (-32767 - 1)
#define UINT32_MAX 0xFFFFFFFFUL
#define INT32_MAX 2147483647L
#define INT32_MIN (-2147483647L - 1L)
#define UINT32_C(value) value##UL
#define INT32_C(value) value##L
#define UINT64_C(value) value##ULL
#endif
