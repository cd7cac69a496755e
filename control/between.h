/* Limits of a value. Pure. */
#ifndef CONTROL_BETWEEN_H
#define CONTROL_BETWEEN_H

#include <math.h>

/* The value within lowest .. highest; lowest when it is no number. highest < lowest: highest. */
static inline float between(float lowest, float value, float highest)
{
    return fminf(fmaxf(value, lowest), highest);
}

#endif
