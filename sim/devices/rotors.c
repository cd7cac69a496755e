#include "sim/devices/rotors.h"

#include <math.h>

/* Blade element theory at constant pitch: thrust = speed * (speed - share * (climb + inflow) / tip-ish
 * speed), scaled so that hover is 1 at 1. With the disc of four 10 inch rotors (0.127 m) and 1.5 kg of
 * air-borne mass, momentum theory gives an induced speed in hover of sqrt(m g / (2 rho A)) = 5.4 m/s. */
#define INDUCED_HOVER_MPS 5.4
#define INFLOW_SHARE 0.60 /* of the blades' angle of attack that hover's inflow takes away */
#define THRUST_MOST 4.0

void rotors_init(rotors_t *rotors, const rotors_config_t *config)
{
    *rotors = (rotors_t){.config = *config};
}

/* Of a rotor speed in air that flows through it: 1 at hover's speed and hover's inflow. */
static double thrust_in(double speed, double through_mps)
{
    const double loss = INFLOW_SHARE * through_mps / INDUCED_HOVER_MPS;
    return fmin(fmax(speed * (speed - loss) / (1.0 - INFLOW_SHARE), 0.0), THRUST_MOST);
}

double rotors_thrust(const rotors_t *rotors, double climb_mps)
{
    return thrust_in(rotors->speed, rotors->inflow_mps + climb_mps);
}

/* The induced speed that momentum theory asks of a thrust in climb: v (v + climb) = thrust * hover's square.
 * In a descent faster than it holds for (vortex ring), as at hover. */
static double inflow_asked_mps(double thrust, double climb_mps)
{
    const double half_mps = fmax(climb_mps, 0.0) / 2.0;
    return sqrt(half_mps * half_mps + thrust * INDUCED_HOVER_MPS * INDUCED_HOVER_MPS) - half_mps;
}

void rotors_step(rotors_t *rotors, double step_s, double throttle, double climb_mps)
{
    const rotors_config_t *c = &rotors->config;
    /* In steady hovering air the thrust goes with the square of the speed, as the inflow goes with the speed.
     */
    const double wanted = pow(throttle, c->exponent / 2.0);
    const double lag_s = wanted > rotors->speed ? c->spin_up_s : c->slow_down_s;

    rotors->speed += (1.0 - exp(-step_s / lag_s)) * (wanted - rotors->speed);
    rotors->inflow_mps += step_s / c->inflow_lag_s *
                          (inflow_asked_mps(rotors_thrust(rotors, climb_mps), climb_mps) -
                           rotors->inflow_mps);
}

double rotors_drag_mps2(const rotors_t *rotors, double climb_mps, double tilt_cosine)
{
    const rotors_config_t *c = &rotors->config;
    const double sine_2 = 1.0 - tilt_cosine * tilt_cosine;

    return c->drag_per_m * (1.0 + c->tilt_drag * sine_2) * climb_mps * fabs(climb_mps);
}
