/* Converts times of the wrapping 32-bit microsecond clock to seconds. Pure. */
#ifndef CONTROL_SECONDS_H
#define CONTROL_SECONDS_H

#include <stdint.h>

#include "control/between.h"

/* Time from one instant to another, in seconds. Negative when to_us is the earlier one. They must be less
 * than 35 minutes apart (half the range of the clock). */
static inline float seconds_between(uint32_t from_us, uint32_t to_us)
{
    return (float)(int32_t)(to_us - from_us) * 1.0e-6F;
}

#define CYCLE_MAX_S \
    0.5F /* chosen: a longer pause of the control task, or of the scans, counts as this long */

/* Converts a duration to seconds, limited to at_most_s. duration_us may have the clock's whole range. */
static inline float seconds_at_most(uint32_t duration_us, float at_most_s)
{
    return at_most((float)duration_us * 1.0e-6F, at_most_s);
}

#endif
