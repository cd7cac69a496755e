#include "control/laws/descent.h"

#include "control/between.h"
#include "control/thrust.h"
#include "control/touchdown.h"

/* At terminal speed v, damping D: thrust deficit / hover thrust = D v / g. */
#define SINK_SHARE 0.073F          /* at 0.3 m/s: damping 2.4 1/s * 0.3 m/s / 9.81 m/s2 */
#define BRAKE_SHARE 2.0F           /* and so thrice in all */
#define BRAKE_BEYOND_MM_S 1000.0F  /* so much above the wanted rate, a climb is too fast */
#define TRIM_GAIN_N_PER_MM 0.0010F /* chosen: 0.3 N/s at the whole rate */
#define QUICK_TRIM_GAIN_N_PER_MM \
    (3.0F * TRIM_GAIN_N_PER_MM) /* chosen: three times, so a climb ends soon, in a descent or a hold */
#define SINK_SLEW_MM_S2 DESCENT_RATE_MM_S /* the whole rate after 1 s */
#define FADE_N_PER_S2 0.004F              /* chosen: 7 N are gone after 40 s */
#define TRIM_MAX_N 2.0F                   /* a hover thrust wrong by a fifth, and gusts */

static float flare_mm_s(float height_mm)
{
    return at_most(1000.0F * LAND_MPS + LAND_PER_S * at_least(height_mm, 0.0F), DESCENT_RATE_MM_S);
}

void descent_start(descent_t *descent, float rate_mm_s)
{
    *descent = (descent_t){.sink_mm_s = between(0.0F, -rate_mm_s, DESCENT_RATE_MM_S)};
}

/* By the model of the vehicle each mm/s of error needs as much thrust as each mm/s of the descent does. */
static float rate_action_n(float error_mm_s, float hover_n)
{
    const float climb_mm_s = at_most(error_mm_s + BRAKE_BEYOND_MM_S, 0.0F);
    const float action_n = SINK_SHARE * hover_n / DESCENT_RATE_MM_S * (error_mm_s + BRAKE_SHARE * climb_mm_s);
    return at_most(action_n, TRIM_MAX_N);
}

float descent_step(descent_t *descent, float hover_n, float height_mm, float rate_mm_s, float dt_s)
{
    const float faster_mm_s = at_most(descent->sink_mm_s + SINK_SLEW_MM_S2 * dt_s, flare_mm_s(height_mm));

    descent->sink_mm_s = descent->holds ? 0.0F : faster_mm_s;
    const float error_mm_s = -descent->sink_mm_s - rate_mm_s;
    const float sink_n = SINK_SHARE * hover_n * descent->sink_mm_s / DESCENT_RATE_MM_S;
    /* a hold has one gain: with two of them, a vehicle that sways about its height lowers the thrust */
    const bool quick = rate_mm_s > 0.0F || descent->holds;
    const float trim_gain = quick ? QUICK_TRIM_GAIN_N_PER_MM : TRIM_GAIN_N_PER_MM;

    descent->trim_n = between(-TRIM_MAX_N, descent->trim_n + trim_gain * error_mm_s * dt_s, TRIM_MAX_N);
    const float setpoint_n = at_least(hover_n - sink_n + descent->trim_n + rate_action_n(error_mm_s, hover_n),
                                      THRUST_LEAST_SHARE * hover_n);
    descent->near_ground_s = touchdown_time_s(descent->near_ground_s, height_mm * 0.001F, descent->rocks,
                                              dt_s);
    return at_most(setpoint_n, touchdown_limit_n(descent->near_ground_s, hover_n + descent->trim_n));
}

float descent_blind(float hover_n, float elapsed_s)
{
    return at_least(hover_n * (1.0F - SINK_SHARE) - FADE_N_PER_S2 * elapsed_s * elapsed_s, 0.0F);
}
