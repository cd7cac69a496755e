/* End of a landing. When the vehicle has come within 40 mm of the ground, the upper limit of the thrust
 * falls: it starts a little above the hover thrust and falls by 2 N/s. So neither a gust nor a wrong hover
 * thrust can lift the vehicle again. A blocked beam can show the ground in the air: while the tilt sways as
 * it does in flight, the limit falls slowly, and the vehicle sinks instead of falling. Law EST and the
 * descents without an estimate use the same limit. Pure. */
#ifndef CONTROL_TOUCHDOWN_H
#define CONTROL_TOUCHDOWN_H

#include <math.h>
#include <stdbool.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/where/hover_thrust.h"

/* Without heights: at the hover thrust after the time over which that was learned */
#define SINK_FADE_N_PER_S (NEAR_HOVER_N / HOVER_TIME_S)
#define LANDED_FADE_N_PER_S 2.0F /* chosen: no thrust 4 s later */
/* 0.94 N below the hover thrust, more than the ground carries: by Cheeseman and Bennett, 1 / (1 - (R / 4
 * z)^2), 11 % of 8.4 N, the heaviest vehicle's hover thrust, by rotors of R 0.127 m at z 0.1 m. */
#define LANDED_ROCKS_S 0.72F
#define LANDED_ROCKS_SHARE (SINK_FADE_N_PER_S / LANDED_FADE_N_PER_S) /* as without heights */

/* New time near the ground, from the time before (time_s) and one step of dt_s. Below HEIGHT_NO_NOISE_M it
 * starts; above LOW_M it is 0 again. From LANDED_ROCKS_S on it runs slowly while the tilt sways as
 * in flight (sway_rocks()). */
static inline float touchdown_time_s(float time_s, float height_m, bool rocks, float dt_s)
{
    const bool low = height_m < HEIGHT_NO_NOISE_M || (time_s > 0.0F && height_m < LOW_M);
    const bool slow = rocks && time_s > LANDED_ROCKS_S;
    return low ? time_s + (slow ? LANDED_ROCKS_SHARE : 1.0F) * dt_s : 0.0F;
}

/* Upper limit of the thrust after time_s near the ground, newtons per motor. No limit (INFINITY) while
 * time_s is 0. */
static inline float touchdown_limit_n(float time_s, float hover_n)
{
    return (time_s > 0.0F) ? at_least(hover_n + NEAR_HOVER_N - LANDED_FADE_N_PER_S * time_s, 0.0F) : INFINITY;
}

#endif
