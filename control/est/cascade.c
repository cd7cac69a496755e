#include "control/est/cascade.h"

#include <math.h>

#include "control/between.h"
#include "control/thrust.h"

#define TERRAIN_SHARE 1.0F
#define FAR_M 0.20F
#define FAR_SHARE 0.30F
#define RISE_MAX_MPS2 3.96F
#define DRAG_SPEED_MPS 0.8F /* beyond it the drag helps to brake */
#define LEAD 1.3F
#define ABOVE_HOVER_N 3.5F
#define LEAST_SHARE 0.25F
#define UPRIGHT_MIN 0.8F
#define SLEW_N_PER_S 60.0F
#define ACTIVITY_MAX_N 1.5F
#define ACTIVITY_TIME_S 1.0F
#define CALM_MIN 0.4F

void cascade_init(cascade_t *cascade, float thrust_n)
{
    *cascade = (cascade_t){.thrust_n = thrust_n, .slow_n = thrust_n};
}

float cascade_speed_to(const cascade_gains_t *gains, const cascade_state_t *state, float reference_m)
{
    const float off_m = reference_m - state->height_m;
    const float distance = fminf(fabsf(off_m) / FAR_M, 1.0F);
    const float wanted_mps =
        gains->height_per_s * (1.0F + FAR_SHARE * distance) * off_m + TERRAIN_SHARE * state->terrain_mps;
    return between(-gains->down_mps, wanted_mps, gains->up_mps);
}

/* Below 1 while the command shakes more than ACTIVITY_MAX_N: noise, or a loop that swings. */
static float calm(cascade_t *cascade, float dt_s)
{
    const float share = fminf(dt_s / ACTIVITY_TIME_S, 1.0F);
    const float off_n = cascade->thrust_n - cascade->slow_n;

    cascade->slow_n += share * off_n;
    cascade->quick_n += share * (off_n * off_n - cascade->quick_n);
    return between(CALM_MIN, ACTIVITY_MAX_N / sqrtf(fmaxf(cascade->quick_n, 0.01F)), 1.0F);
}

float cascade_step(cascade_t *cascade, const cascade_gains_t *gains, const cascade_vehicle_t *vehicle,
                   const cascade_state_t *state, float speed_mps, float dt_s)
{
    const float gain_per_s = gains->speed_per_s * calm(cascade, dt_s);
    const float acceleration_mps2 =
        between(-gains->fall_mps2, gain_per_s * (speed_mps - state->speed_mps), RISE_MAX_MPS2);
    const float drag_mps2 = vehicle->damping_per_s * between(-DRAG_SPEED_MPS, state->speed_mps, DRAG_SPEED_MPS);
    const float force_n = (acceleration_mps2 + drag_mps2) / vehicle->authority_mps2_per_n;
    const float steady_n = (vehicle->need_n + force_n) / fmaxf(vehicle->upright, UPRIGHT_MIN);
    const float least_n = fmaxf(vehicle->hover_n - gains->below_hover_n, LEAST_SHARE * vehicle->hover_n);
    const float led_n =
        between(least_n, state->thrust_n + LEAD * (steady_n - state->thrust_n), vehicle->hover_n + ABOVE_HOVER_N);
    const float slew_n = SLEW_N_PER_S * dt_s;

    cascade->thrust_n = between(cascade->thrust_n - slew_n, led_n, cascade->thrust_n + slew_n);
    cascade->thrust_n = between(0.0F, cascade->thrust_n, THRUST_MAX_N);
    return cascade->thrust_n;
}
