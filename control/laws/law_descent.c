/* Descents without an estimate: by the heights, or without them. */
#include "control/between.h"
#include "control/credible.h"
#include "control/laws/laws.h"
#include "control/seconds.h"

#define CALM_TIMES 2.0F /* tried 2 and 3: a calm vehicle that flies touches at 0.8 and 0.95 m/s */

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

/* While the tilt is calm, the vehicle probably stands, and nothing else tells it: time runs faster. */
float law_blind_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const bool calm = now->evidence->calm && est_law_has_imu(est);
    const float step_s = calm ? where_step_s(now->where) : 0.0F;
    const bool started = now->mode != now->mode_before;
    const float state_s = seconds_at_most(now->where->supervisor.state_us, DESCENT_BLIND_MAX_S);

    laws->blind_ahead_s = started ? 0.0F : laws->blind_ahead_s + CALM_TIMES * step_s;
    return descent_blind(now->where->hover.thrust_n,
                         at_most(state_s + laws->blind_ahead_s, DESCENT_BLIND_MAX_S));
}
