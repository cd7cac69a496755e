/* Cascade of three proportional loops, as in PX4, ArduPilot and Crazyflie: height error to speed, speed error
 * to acceleration, acceleration to thrust. There is no integral action: the estimated hover thrust (hover.c)
 * takes its place. A lead compensates the lag of the motors: the command changes more than the thrust has to.
 * What breaks: with a VELK too high for delay and lag the thrust oscillates. Constants marked
 * "fitted": docs/control.md; make tune LAW=EST ARGS="--constants est" searches them again. */
#include "control/est/cascade.h"

#include <math.h>

#include "control/between.h"
#include "control/thrust.h"

#define FAR_M 0.20F         /* fitted: from here on the speed per metre grows no more */
#define FAR_SHARE 0.30F     /* fitted */
#define RISE_MAX_MPS2 3.96F /* fitted: 0.4 g */
#define LEAD 1.3F           /* fitted: overdrives the motors' lag */
#define UPRIGHT_MIN 0.8F    /* 37 degrees; more tilt is not compensated further */

float cascade_speed_to(const cascade_gains_t *gains, const cascade_state_t *state, float reference_m)
{
    const float off_m = reference_m - state->height_m;
    const float distance = at_most(fabsf(off_m) / FAR_M, 1.0F);
    const float wanted_mps = gains->height_per_s * (1.0F + FAR_SHARE * distance) * off_m + state->terrain_mps;
    return between(-gains->down_mps, wanted_mps, gains->up_mps);
}

float cascade_thrust_n(const cascade_gains_t *gains, const cascade_vehicle_t *vehicle,
                       const cascade_state_t *state, float speed_mps)
{
    const float acceleration_mps2 = between(
        -EST_FALL_MPS2, gains->speed_per_s * (speed_mps - state->speed_mps), RISE_MAX_MPS2);
    /* beyond the speed of a climb the drag helps to brake, also a fall */
    const float drag_mps2 = vehicle->damping_per_s * between(-gains->up_mps, state->speed_mps, gains->up_mps);
    const float force_n = (acceleration_mps2 + drag_mps2) / vehicle->authority_mps2_per_n;
    const float steady_n = (vehicle->need_n + force_n) / at_least(vehicle->upright, UPRIGHT_MIN);
    const float led_n = state->thrust_n + LEAD * (steady_n - state->thrust_n);

    /* the lead may not fall faster than EST_FALL_MPS2 either: heights may be wrong */
    const float least_n = at_least(vehicle->hover_n - EST_FALL_MPS2 / vehicle->authority_mps2_per_n,
                                   THRUST_LEAST_SHARE * vehicle->hover_n);

    return between(least_n, led_n, THRUST_MAX_N);
}
