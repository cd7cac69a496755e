/* Law PIDT, with the parameters of the set; also in FLOATING, and in place of law EST without an estimate. */
#include "control/between.h"
#include "control/credible.h"
#include "control/laws/laws.h"
#include "control/seconds.h"
#include "control/thrust.h"

#define WINDOW_N \
    (EST_FALL_MPS2 * 7.0F / IMU_GRAVITY_MPS2) /* what a vehicle that hovers at 7 N accelerates by */
#define HEIGHT_LATE_US UINT32_C(170000)       /* a scan of 0.1 s is missing */

float law_pidt_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const height_track_t *height = &now->where->supervisor.height;
    const float *value = now->parameters->value;
    const float hover_n = now->where->hover.thrust_n;
    const pidt_gains_t gains = {
        .kp_n_per_m = value[PARAMETER_PKP],
        .ki_n_per_m_s = value[PARAMETER_PKI],
        .kd_n_s_per_m = value[PARAMETER_PKD],
        .gravity_n = value[PARAMETER_GRAV],
        .most_n = at_most(value[PARAMETER_GRAV] + WINDOW_N, THRUST_MAX_N),
        .least_n = at_least(value[PARAMETER_GRAV] - WINDOW_N, 0.0F),
    };

    if (height->is_new || !laws->pidt.primed) {
        const float gap_s = seconds_at_most(est->rays_us - laws->pidt_rays_us, CYCLE_MAX_S);

        laws->pidt_rays_us = est->rays_us;
        return pidt_step(&laws->pidt, &gains, now->aim_m, height->height_mm * 0.001F, gap_s);
    }
    if (height->age_us > HEIGHT_LATE_US && now->where->contact.airborne) { /* do not hold a push for long */
        return between(hover_n - NEAR_HOVER_N, laws->setpoint_n, hover_n + NEAR_HOVER_N);
    }
    return laws->setpoint_n;
}
