/* The end of a landing: once the vehicle has been within 40 mm of the ground, the most thrust that a landing may give falls
 * from a little above the hover thrust by 2 N/s, so that neither a gust nor a wrong hover thrust lifts the vehicle again.
 * Law EST and descents without an estimate end alike. Pure. */
#ifndef CONTROL_TOUCHDOWN_H
#define CONTROL_TOUCHDOWN_H

#include <math.h>
#include <stdbool.h>

#define LANDED_M 0.04F                  /* chosen: ten times the height's noise */
#define LANDED_NO_MORE_M 0.10F          /* chosen: above any bounce */
#define LANDED_ABOVE_HOVER_N 0.5F       /* chosen: room to brake the last centimetres */
#define LANDED_FADE_N_PER_S 2.0F        /* chosen: no thrust 4 s later */

/* For how long the vehicle has been near the ground. */
static inline float touchdown_time_s(float time_s, float height_m, float dt_s)
{
    const bool low = height_m < LANDED_M || (time_s > 0.0F && height_m < LANDED_NO_MORE_M);
    return low ? time_s + dt_s : 0.0F;
}

/* Most thrust after that time, newtons per motor; without a limit at 0. */
static inline float touchdown_limit_n(float time_s, float hover_n)
{
    return (time_s > 0.0F) ? fmaxf(hover_n + LANDED_ABOVE_HOVER_N - LANDED_FADE_N_PER_S * time_s, 0.0F) : INFINITY;
}

#endif
