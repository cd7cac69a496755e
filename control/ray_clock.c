#include "control/ray_clock.h"

#define STAMP_MASK UINT32_C(0xFFFFFF)                         /* 24 bits, SCIP2.0 */
#define GAP_MAX_MS ((uint32_t)APART_MAX_US / DRIFT_US_PER_MS) /* longer ones may drift by that */
/* The sensor's oscillator is not known. The worst usual one, a ceramic resonator, is off by 0.5 % (Murata,
 * CERALOCK CSTCE). */
#define DRIFT_US_PER_MS UINT32_C(5)
#define APART_MAX_US INT32_C(50000) /* half a revolution: more tells nothing, the sensor has restarted */

void ray_clock_init(ray_clock_t *ray_clock)
{
    *ray_clock = (ray_clock_t){.started = false};
}

uint32_t ray_clock_step(ray_clock_t *ray_clock, uint32_t stamp_ms, uint32_t arrival_us, uint32_t age_us)
{
    const uint32_t gap_ms = (stamp_ms - ray_clock->stamp_ms) & STAMP_MASK;
    const uint32_t latest_us = ray_clock->earliest_us + gap_ms * (UINT32_C(1000) + DRIFT_US_PER_MS);
    const int32_t ahead_us = (int32_t)(latest_us - arrival_us);
    const bool follows = ray_clock->started && gap_ms <= GAP_MAX_MS && ahead_us > -APART_MAX_US &&
                         ahead_us < APART_MAX_US;

    ray_clock->earliest_us = (follows && ahead_us < 0) ? latest_us : arrival_us;
    ray_clock->stamp_ms = stamp_ms & STAMP_MASK;
    ray_clock->started = true;
    return ray_clock->earliest_us - age_us;
}
