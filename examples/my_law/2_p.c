/* Step 2: more thrust below the reference, less above it. */
#include "control/laws/laws.h"

#define KP_N_PER_M 6.0F /* law PIDT's, as delivered */

float law_mine_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float error_m = now->where->supervisor.reference_m - height->height_mm * 0.001F;

    (void)est;
    if (!height->is_new) {
        return laws->setpoint_n; /* what was asked before, until there is a new height */
    }
    return now->parameters->value[PARAMETER_GRAV] + KP_N_PER_M * error_m;
}
