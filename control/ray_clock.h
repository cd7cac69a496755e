/* Converts the sensor's time stamps to the vehicle's clock, to find when the rays of a scan were taken. A
 * stamp belongs to step 0 of its revolution and has no jitter; the arrival of the reply has jitter. The
 * earliest arrivals relate the two clocks. The sensor's clock may be up to 0.3 % fast or slow, and it may
 * restart. Pure; the caller owns the state. */
#ifndef CONTROL_RAY_CLOCK_H
#define CONTROL_RAY_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    bool started;
    uint32_t stamp_ms;
    uint32_t earliest_us; /* arrival that the latest reply would have had without delay */
} ray_clock_t;

void ray_clock_init(ray_clock_t *ray_clock);

/* One scan. stamp_ms: its 24-bit time stamp. arrival_us: its arrival, on a wrapping 32-bit clock. age_us:
 * time from its rays to its arrival, when nothing delays it. Returns when its rays were taken, on the
 * clock of arrival_us. */
uint32_t ray_clock_step(ray_clock_t *ray_clock, uint32_t stamp_ms, uint32_t arrival_us, uint32_t age_us);

#endif
