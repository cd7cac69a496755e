/* What the scanner's driver uses of <string.h>, for a compiler without a C library. */
#ifndef FREESTANDING_STRING_H
#define FREESTANDING_STRING_H

#include <stddef.h>

int memcmp(const void *one, const void *other, size_t count);

#endif
