/* When the rays of a scan were taken, on the vehicle's clock, from the sensor's own time stamps: a stamp names step 0 of
 * its revolution and does not shake, the arrival of the reply does. The earliest arrivals tie the two clocks together;
 * the sensor's may run up to 0.3 % fast or slow and may start anew. Pure; the caller owns the state. */
#ifndef CONTROL_RAY_CLOCK_H
#define CONTROL_RAY_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    bool started;
    uint32_t stamp_ms;
    uint32_t earliest_us;   /* arrival of the latest reply, had it not been hindered */
} ray_clock_t;

void ray_clock_init(ray_clock_t *ray_clock);

/* One scan: its 24-bit stamp, its arrival on a wrapping 32-bit clock, and how long an unhindered scan of its kind arrives
 * after its rays. Returns the instant of its rays. */
uint32_t ray_clock_step(ray_clock_t *ray_clock, uint32_t stamp_ms, uint32_t arrival_us, uint32_t age_us);

#endif
