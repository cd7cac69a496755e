/* What a misspelt word probably meant. */
#ifndef TOOLS_PLOMADA_NEAREST_H
#define TOOLS_PLOMADA_NEAREST_H

#include <stddef.h>

/* The word of words[0..count-1] with the fewest letters to change, add or leave out, case aside; NULL when
 * none is nearer than half of its letters. Words of more than 63 letters are never near. */
const char *nearest(const char *typed, const char *const words[], size_t count);

#endif
