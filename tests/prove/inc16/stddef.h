/* As stdint.h: the PC's own header would make size_t 16 bits wide, where a C28x has 32. */
#ifndef PROVE_STDDEF_H
#define PROVE_STDDEF_H
typedef unsigned long size_t;
typedef long ptrdiff_t;
#define NULL ((void *)0)
#endif
