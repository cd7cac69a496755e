/* Laboratory 4, for all numbers. */
#include "control/between.h"
#include "control/laws/laws.h"

#define KP_N_PER_M 6.0F
#define KD_N_S_PER_M 2.6F /* half of it overshoots, three times shake the motors */
#define WINDOW_N 3.0F

float law_mine_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float error_m = now->where->supervisor.reference_m - height->height_mm * 0.001F;
    const float climb_mps = height->rate_mm_s * 0.001F;
    const float gravity_n = now->parameters->value[PARAMETER_GRAV];

    (void)est;
    if (!height->is_new) {
        return laws->setpoint_n;
    }
    return between(gravity_n - WINDOW_N, gravity_n + KP_N_PER_M * error_m - KD_N_S_PER_M * climb_mps,
                   gravity_n + WINDOW_N);
}
