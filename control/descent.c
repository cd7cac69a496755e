#include "control/descent.h"

#include <math.h>
#include <stdbool.h>

#include "control/between.h"

/* At terminal speed v, damping D: thrust deficit / hover thrust = D v / g. */
#define SINK_SHARE 0.073F
#define FLARE_RATE_MM_S 150.0F
#define FLARE_SLOPE_PER_S 0.25F
#define SINK_SLEW_MM_S2 300.0F
#define RATE_GAIN_N_PER_MM_S 0.0020F
#define BRAKE_GAIN_N_PER_MM_S 0.0040F
#define BRAKE_BEYOND_MM_S 1000.0F
#define RATE_ACTION_LEAST_N (-5.0F)
#define RATE_ACTION_MOST_N 2.0F
#define TRIM_GAIN_N_PER_MM 0.0010F
#define CLIMB_TRIM_GAIN_N_PER_MM 0.0030F
#define TRIM_MAX_N 2.0F
#define LEAST_SHARE 0.25F
#define FADE_N_PER_S2 0.004F
#define LOW_MM 40.0F
#define LOW_NO_MORE_MM 100.0F
#define LOW_ABOVE_HOVER_N 0.5F
#define LOW_FADE_N_PER_S 2.0F

static float flare_mm_s(float height_mm)
{
    return fminf(FLARE_RATE_MM_S + FLARE_SLOPE_PER_S * fmaxf(height_mm, 0.0F), DESCENT_RATE_MM_S);
}

void descent_start(descent_t *descent, float rate_mm_s)
{
    descent->sink_mm_s = between(0.0F, -rate_mm_s, DESCENT_RATE_MM_S);
    descent->trim_n = 0.0F;
    descent->low_s = 0.0F;
}

static float rate_action_n(float error_mm_s)
{
    const float climb_mm_s = fminf(error_mm_s + BRAKE_BEYOND_MM_S, 0.0F);
    const float action_n = RATE_GAIN_N_PER_MM_S * error_mm_s + BRAKE_GAIN_N_PER_MM_S * climb_mm_s;
    return between(RATE_ACTION_LEAST_N, action_n, RATE_ACTION_MOST_N);
}

/* At the ground: hover_n as it was learned, and less and less. */
static float thrust_limit_n(descent_t *descent, float hover_n, float height_mm, float dt_s)
{
    const bool low = height_mm < LOW_MM || (descent->low_s > 0.0F && height_mm < LOW_NO_MORE_MM);

    descent->low_s = low ? descent->low_s + dt_s : 0.0F;
    return (descent->low_s > 0.0F) ? fmaxf(hover_n + LOW_ABOVE_HOVER_N - LOW_FADE_N_PER_S * descent->low_s, 0.0F) : INFINITY;
}

float descent_step(descent_t *descent, float hover_n, float height_mm, float rate_mm_s, float dt_s)
{
    descent->sink_mm_s = fminf(descent->sink_mm_s + SINK_SLEW_MM_S2 * dt_s, flare_mm_s(height_mm));
    const float error_mm_s = -descent->sink_mm_s - rate_mm_s;
    const float sink_n = SINK_SHARE * hover_n * descent->sink_mm_s / DESCENT_RATE_MM_S;

    const float trim_gain = (rate_mm_s > 0.0F) ? CLIMB_TRIM_GAIN_N_PER_MM : TRIM_GAIN_N_PER_MM;

    descent->trim_n = between(-TRIM_MAX_N, descent->trim_n + trim_gain * error_mm_s * dt_s, TRIM_MAX_N);
    const float setpoint_n =
        fmaxf(hover_n - sink_n + descent->trim_n + rate_action_n(error_mm_s), LEAST_SHARE * hover_n);
    return fminf(setpoint_n, thrust_limit_n(descent, hover_n + descent->trim_n, height_mm, dt_s));
}

float descent_blind(float hover_n, float elapsed_s)
{
    return fmaxf(hover_n * (1.0F - SINK_SHARE) - FADE_N_PER_S2 * elapsed_s * elapsed_s, 0.0F);
}
