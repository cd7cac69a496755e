/* Laboratory 6, for all numbers: at a limit the integral may only come back from it. */
#include "control/between.h"
#include "control/laws/laws.h"

#define KP_N_PER_M 6.0F   /* given: law PIDT's, as delivered */
#define KD_N_S_PER_M 2.6F /* given, likewise */
#define KI_N_PER_M_S 3.0F /* given: large, so that the windup shows */
#define ASCENSION_N 1.0F  /* the limit above GRAV, that of the thesis */
#define DESCENSION_N 1.0F /* and below */

float law_mine_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float error_m = now->where->supervisor.reference_m - height->height_mm * 0.001F;
    const float climb_mps = height->rate_mm_s * 0.001F;
    const float gravity_n = now->parameters->value[PARAMETER_GRAV];
    const float gap_s = (float)height->gap_us * 1e-6F; /* since the height before */

    (void)est;
    if (!height->is_new) {
        return laws->setpoint_n;
    }
    const float others_n = gravity_n + KP_N_PER_M * error_m - KD_N_S_PER_M * climb_mps;
    const float wanted_n = others_n + laws->pid.integral_n;
    const float added_n = KI_N_PER_M_S * error_m * gap_s;
    const bool full_up = wanted_n > gravity_n + ASCENSION_N && added_n > 0.0F;
    const bool full_down = wanted_n < gravity_n - DESCENSION_N && added_n < 0.0F;

    if (!full_up && !full_down) {
        laws->pid.integral_n += added_n;
    }
    return between(gravity_n - DESCENSION_N, others_n + laws->pid.integral_n, gravity_n + ASCENSION_N);
}
