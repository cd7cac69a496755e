/* Descents without an estimate: by the heights, or without them. */
#include "control/between.h"
#include "control/credible.h"
#include "control/laws/laws.h"
#include "control/seconds.h"

float law_descent_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float gap_s = height->is_new ? seconds_at_most(height->gap_us, HEIGHT_FRESH_S) : 0.0F;
    const bool started = now->mode != now->mode_before;

    (void)est;
    laws->descent.rocks = now->rocks;
    return (height->is_new || started) ? descent_step(&laws->descent, now->where->hover.thrust_n,
                                                      height->height_mm, height->rate_mm_s, gap_s)
                                       : laws->setpoint_n;
}

float law_blind_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const float state_s = seconds_at_most(now->where->supervisor.state_us, DESCENT_BLIND_MAX_S);

    (void)laws;
    (void)est;
    return descent_blind(now->where->hover.thrust_n, state_s);
}
