/* Cascade of three proportional loops, as in PX4, ArduPilot and Crazyflie: height error to speed, speed error
 * to acceleration, acceleration to thrust. There is no integral action: the estimated hover thrust (hover.c)
 * takes its place. A lead compensates the lag of the motors: the command changes more than the thrust has to.
 * What breaks: with a VELK too high for delay and lag the thrust oscillates. The calm factor then lowers the
 * gain, which hides the cause. Constants marked "fitted": docs/control.md;
 * make tune LAW=EST ARGS="--constants est" searches them again. */
#include "control/est/cascade.h"

#include <math.h>

#include "control/between.h"
#include "control/thrust.h"

#define FAR_M 0.20F          /* fitted: from here on the speed per metre grows no more */
#define FAR_SHARE 0.30F      /* fitted */
#define RISE_MAX_MPS2 3.96F  /* fitted: 0.4 g */
#define DRAG_SPEED_MPS 0.8F  /* chosen: beyond it the drag helps to brake */
#define LEAD 1.3F            /* fitted: overdrives the motors' lag */
#define ABOVE_HOVER_N 3.5F   /* chosen: half of the hover thrust */
#define UPRIGHT_MIN 0.8F     /* 37 degrees; more tilt is not compensated further */
#define SLEW_N_PER_S 60.0F   /* chosen: 1.5 N per IMU frame */
#define ACTIVITY_MAX_N 1.5F  /* chosen: three times the usual activity */
#define ACTIVITY_TIME_S 1.0F /* chosen: ten scans */

void cascade_init(cascade_t *cascade, float thrust_n)
{
    *cascade = (cascade_t){.thrust_n = thrust_n, .slow_n = thrust_n};
}

float cascade_speed_to(const cascade_gains_t *gains, const cascade_state_t *state, float reference_m)
{
    const float off_m = reference_m - state->height_m;
    const float distance = at_most(fabsf(off_m) / FAR_M, 1.0F);
    const float wanted_mps = gains->height_per_s * (1.0F + FAR_SHARE * distance) * off_m + state->terrain_mps;
    return between(-gains->down_mps, wanted_mps, gains->up_mps);
}

/* Below 1 while the command shakes more than ACTIVITY_MAX_N: noise, or a loop that swings. */
static float calm(cascade_t *cascade, float dt_s)
{
    const float share = at_most(dt_s / ACTIVITY_TIME_S, 1.0F);
    const float off_n = cascade->thrust_n - cascade->slow_n;

    cascade->slow_n += share * off_n;
    cascade->quick_n += share * (off_n * off_n - cascade->quick_n);
    return between(CASCADE_CALM_MIN, ACTIVITY_MAX_N / sqrtf(at_least(cascade->quick_n, 0.01F)), 1.0F);
}

float cascade_step(cascade_t *cascade, const cascade_gains_t *gains, const cascade_vehicle_t *vehicle,
                   const cascade_state_t *state, float speed_mps, float dt_s)
{
    const float gain_per_s = gains->speed_per_s * calm(cascade, dt_s);
    const float acceleration_mps2 = between(-gains->fall_mps2, gain_per_s * (speed_mps - state->speed_mps),
                                            RISE_MAX_MPS2);
    const float drag_mps2 = vehicle->damping_per_s *
                            between(-DRAG_SPEED_MPS, state->speed_mps, DRAG_SPEED_MPS);
    const float force_n = (acceleration_mps2 + drag_mps2) / vehicle->authority_mps2_per_n;
    const float steady_n = (vehicle->need_n + force_n) / at_least(vehicle->upright, UPRIGHT_MIN);
    const float least_n = at_least(vehicle->hover_n - gains->below_hover_n,
                                   THRUST_LEAST_SHARE * vehicle->hover_n);
    const float led_n = between(least_n, state->thrust_n + LEAD * (steady_n - state->thrust_n),
                                vehicle->hover_n + ABOVE_HOVER_N);
    const float slew_n = SLEW_N_PER_S * dt_s;

    cascade->thrust_n = between(cascade->thrust_n - slew_n, led_n, cascade->thrust_n + slew_n);
    cascade->thrust_n = between(0.0F, cascade->thrust_n, THRUST_MAX_N);
    return cascade->thrust_n;
}
