/* Limits of a value. Pure. */
#ifndef CONTROL_BETWEEN_H
#define CONTROL_BETWEEN_H

#include <math.h>

/* Limits value to lowest .. highest. NaN gives lowest. If highest < lowest, the result is highest. */
static inline float between(float lowest, float value, float highest)
{
    return fminf(fmaxf(value, lowest), highest);
}

#endif
