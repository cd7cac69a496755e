/* Descent at a limited speed, with heights or without. The given hover thrust may be wrong by a fifth.
 * Used when law EST's estimate is not fresh, and by stuck_pin.c. Newtons per motor; speeds in mm/s, positive
 * upwards, except the sink rate. Pure; the caller owns the state. */
#ifndef CONTROL_DESCENT_H
#define CONTROL_DESCENT_H

#define DESCENT_BLIND_MAX_S \
    60.0F /* above DESCENT_TIMEOUT_US in supervisor.c; longer ones count as this long */
#define DESCENT_RATE_MM_S 300.0F /* above 0.6 m; below it falls to 0.15 m/s at the ground */

#define LAND_MPS 0.15F /* chosen: touches at 0.15 m/s, a drop from 1 mm */
#define LAND_MAX_MPS (0.001F * DESCENT_RATE_MM_S)
#define LAND_PER_S ((LAND_MAX_MPS - LAND_MPS) / 0.6F) /* slower within the last 0.6 m */

#include <stdbool.h>

typedef struct {
    float sink_mm_s;     /* present wanted sink rate, > 0 is downwards */
    float trim_n;        /* correction to hover_n, learned from the vertical speed; stuck_pin.c sets it */
    float near_ground_s; /* time within 40 mm of the ground */
    bool rocks;          /* set before each step: the tilt sways as in flight */
    bool holds;          /* set before each step: do not sink, hold the height */
} descent_t;

/* Call before the first step of a descent. rate_mm_s: present vertical speed, > 0 is up. The wanted sink
 * rate starts from it. */
void descent_start(descent_t *descent, float rate_mm_s);

/* One step with a new height, dt_s after the previous one. rate_mm_s: vertical speed, > 0 is up. What
 * climbs 1 m/s too fast is braked harder. Within 40 mm of the ground the upper limit of the thrust falls by 2
 * N/s, so that nothing lifts the vehicle again. Returns newtons per motor. The minimum is a quarter of
 * hover_n, except within 40 mm of the ground. There is no upper limit to the actuator's range here. */
float descent_step(descent_t *descent, float hover_n, float height_mm, float rate_mm_s, float dt_s);

/* Thrust without heights, elapsed_s after the heights were given up. Sinks at 0.3 m/s where the vertical
 * damping is 2.4 1/s, then slowly faster. Falls to 0 within 45 s, without a jump. Returns newtons per
 * motor, >= 0. */
float descent_blind(float hover_n, float elapsed_s);

#endif
