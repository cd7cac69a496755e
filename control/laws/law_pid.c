/* Laws PD and PID: the seed's, with the parameters of the set. */
#include "control/laws/laws.h"

float law_pid_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float *value = now->parameters->value;
    const pid_gains_t gains = {
        .kp_n_per_mm = value[PARAMETER_KP],
        .kd_n_per_mm = value[PARAMETER_KD],
        .ki_n_per_mm = (now->law == LAW_PID) ? value[PARAMETER_KI] : 0.0F,
        .gravity_n = value[PARAMETER_GRAV],
        .ascension_n = value[PARAMETER_USAT],
        .descension_n = value[PARAMETER_DSAT],
    };
    const bool every_release = parameters_choice(now->parameters, PARAMETER_RELEASE) == RELEASE_FREE;

    (void)est;
    if (!every_release && !height->is_new && laws->pid.primed) {
        return laws->setpoint_n;
    }
    laws->integral = gains.ki_n_per_mm > 0.0F;
    return pid_step(&laws->pid, &gains, now->where->supervisor.reference_m * 1000.0F - height->height_mm);
}
