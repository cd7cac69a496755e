/* Accelerometer or height show the lift-off. What breaks: a lift-off that is seen too early gives too small a
 * hover thrust, and the vehicle drops; one that is seen too late gives too large a one, and it jumps. */
#include "control/est/lift_off.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/est/credit.h"
#include "control/touchdown.h"

#define RAMP_START 0.68F                   /* below the lightest vehicle, 0.8 of GRAV */
#define RAMP_N_PER_S 4.0F                  /* chosen: leaves the ground in 0.6 s */
#define RAMP_MOST 1.35F                    /* above the heaviest vehicle, 1.2 of GRAV */
#define LIFT_OFF_M (5.0F * HEIGHT_SIGMA_M) /* one scan of three million by chance */
#define LIFT_FILTER_S 0.08F                /* chosen: three frames */
#define LIFT_FILTER_SHARE 0.43F            /* what is left of a frame's noise behind it */
#define LIFT_OFF_SIGMAS 3.0F               /* usual: of the measured noise, */
#define LIFT_OFF_MPS2 (5.0F * LIFT_FILTER_SHARE * CREDIT_NOISE_MPS2) /* and five of a Razor's */
#define LIFT_TIME_S 1.0F /* as STANDING_TIME_S in accelerometer.c */

void lift_off_reset(lift_off_t *lift, float gravity_n, float ground_m)
{
    lift->ramping = false;
    lift->ground_m = ground_m;
    lift->ramp_n = RAMP_START * gravity_n;
}

/* The speed is summed up from rest; it decays within LIFT_TIME_S, so that an error of the bias does not
 * add up while the vehicle stands. */
void lift_off_watch(lift_off_t *lift, float felt_mps2, float delivered_n, float dt_s)
{
    const float share = at_most(dt_s / LIFT_FILTER_S, 1.0F);

    lift->up_mps2 += share * (felt_mps2 - lift->up_mps2);
    lift->thrust_n += share * (delivered_n - lift->thrust_n);
    lift->up_mps = lift->ramping ? lift->up_mps * (1.0F - dt_s / LIFT_TIME_S) + felt_mps2 * dt_s : 0.0F;
}

static float threshold_mps2(float noise_mps2)
{
    return at_least(LIFT_OFF_SIGMAS * LIFT_FILTER_SHARE * noise_mps2, LIFT_OFF_MPS2);
}

bool lift_off_is_seen(const lift_off_t *lift, const lift_off_signs_t *signs)
{
    const float risen_m = signs->height_m - lift->ground_m;
    const float up_mps2 = fminf(lift->up_mps2, signs->most_mps2);

    return risen_m > LIFT_OFF_M || up_mps2 > threshold_mps2(signs->noise_mps2);
}

void lift_off_ramp(lift_off_t *lift, float known_n, float step_s)
{
    lift->ramping = true;
    lift->ramp_n = at_most(lift->ramp_n + RAMP_N_PER_S * step_s, RAMP_MOST * known_n);
}

void lift_off_give_up(lift_off_t *lift, float step_s)
{
    lift->ramp_n = at_least(lift->ramp_n - LANDED_FADE_N_PER_S * step_s, 0.0F);
}

bool lift_off_stands(const lift_off_t *lift, float noise_mps2)
{
    return lift->ramping && lift->up_mps2 < threshold_mps2(noise_mps2);
}

/* The thrust ramps by r newtons a second, so after t seconds the vehicle has risen by a r t^3 / 6 (a:
 * authority). The height gives t. Height, speed and the thrust at lift-off follow from t. */
lifted_t lift_off_by_height(const lift_off_t *lift, const lift_off_signs_t *signs, float late_s,
                            float authority_mps2_per_n)
{
    const float jerk_mps3 = RAMP_N_PER_S * authority_mps2_per_n;
    const float risen_m = at_least(signs->height_m - lift->ground_m, 0.0F);
    const float since_s = cbrtf(6.0F * risen_m / jerk_mps3) + late_s;

    return (lifted_t){
        .height_m = lift->ground_m + jerk_mps3 * since_s * since_s * since_s / 6.0F,
        .speed_mps = 0.5F * jerk_mps3 * since_s * since_s,
        .thrust_n = signs->delivered_n - RAMP_N_PER_S * since_s,
    };
}
