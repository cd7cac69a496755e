/* Laboratory 3, for the numbers of 0. */
#include "control/between.h"
#include "control/laws/laws.h"

#define KP_N_PER_M 6.0F /* 0.4 N / 90 mm is 4.4; more, because the tilt costs thrust too */
#define WINDOW_N 3.0F

const float foreseen_error_mm = 66.7F; /* 0.4 N / 6 N/m */

float law_mine_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float error_m = now->where->supervisor.reference_m - height->height_mm * 0.001F;
    const float gravity_n = now->parameters->value[PARAMETER_GRAV];

    (void)est;
    if (!height->is_new) {
        return laws->setpoint_n;
    }
    return between(gravity_n - WINDOW_N, gravity_n + KP_N_PER_M * error_m, gravity_n + WINDOW_N);
}
