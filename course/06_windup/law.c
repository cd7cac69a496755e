/* Laboratory 6: the windup. This PID law winds up; mend it. */
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
    laws->pid.integral_n += KI_N_PER_M_S * error_m *
                            gap_s; /* adds up also while the thrust is at its limit */
    return between(gravity_n - DESCENSION_N,
                   gravity_n + KP_N_PER_M * error_m - KD_N_S_PER_M * climb_mps + laws->pid.integral_n,
                   gravity_n + ASCENSION_N);
}
