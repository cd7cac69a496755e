/* Spans of a 32-bit clock in microseconds, which wraps, in seconds. Pure. */
#ifndef CONTROL_SECONDS_H
#define CONTROL_SECONDS_H

#include <stdint.h>

#include "control/between.h"

/* From one instant to another, less than 35 minutes apart (half the range of the clock). Negative when `to`
 * is the earlier one. */
static inline float seconds_between(uint32_t from_us, uint32_t to_us)
{
    return (float)(int32_t)(to_us - from_us) * 1.0e-6F;
}

/* A duration, limited: a step or a gap may be as long as the clock's whole range. */
static inline float seconds_at_most(uint32_t duration_us, float at_most_s)
{
    return at_most((float)duration_us * 1.0e-6F, at_most_s);
}

#endif
