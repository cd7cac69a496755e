/* Detects a reference that the vehicle does not reach. With a weak battery, a heavy load or narrow limits
 * it stays away for ever, and nothing else would report it. Pure; the caller owns the state, all zero at
 * first. */
#ifndef CONTROL_REACH_H
#define CONTROL_REACH_H

#include <stdbool.h>
#include <stdint.h>

#define REACH_RISES_US UINT32_C(3000000) /* chosen: every law rises within 2.8 s */

typedef struct {
    float nearest_mm; /* smallest distance so far, on the present side */
    bool above;
    bool on;           /* a reference is watched */
    uint32_t stuck_us; /* time since it last came nearer, at most one minute */
} reach_t;

/* Restarts. Call it when there is no reference, and when the reference changes. */
void reach_reset(reach_t *reach);

/* One control cycle, step_us after the previous one. off_mm: height minus reference, > 0 is above. Returns
 * true when the vehicle has been more than 0.1 m off on one side for 3 s and has not come 50 mm nearer. */
bool reach_step(reach_t *reach, float off_mm, uint32_t step_us);

#endif
