/* A second airframe, by momentum theory, for what must not depend on the first one's simplicity: thrust
 * follows the throttle by a power, the rotors spin up faster than they slow down, the air that they push down
 * takes time to follow and makes the thrust depend on the climb, and the fuselage's drag grows with the
 * square of the speed and with the tilt.
 *
 * Everything in ratios to hover: throttle, rotor speed, thrust. */
#ifndef SIM_DEVICES_ROTORS_H
#define SIM_DEVICES_ROTORS_H

typedef struct {
    double exponent;     /* 1.5: thrust = throttle to the power of it, at rest and in steady air */
    double spin_up_s;    /* 0.07 */
    double slow_down_s;  /* 0.16 */
    double inflow_lag_s; /* 0.10 */
    double drag_per_m;   /* 0.35: deceleration by the fuselage = this times the square of the climb ... */
    double tilt_drag;    /* 6: ... and (1 + this times the square of the tilt's sine) */
} rotors_config_t;

#define ROTORS_DEFAULT \
    { \
        .exponent = 1.5, .spin_up_s = 0.07, .slow_down_s = 0.16, .inflow_lag_s = 0.10, .drag_per_m = 0.35, \
        .tilt_drag = 6.0 \
    }

typedef struct {
    rotors_config_t config;
    double speed;      /* of the rotors */
    double inflow_mps; /* of the air through them, pushed by themselves */
} rotors_t;

void rotors_init(rotors_t *rotors, const rotors_config_t *config);
/* One step later: rotor speed and inflow. throttle >= 0; climb in m/s. */
void rotors_step(rotors_t *rotors, double step_s, double throttle, double climb_mps);
double rotors_thrust(const rotors_t *rotors, double climb_mps);
/* Deceleration upwards, against the climb; the cosine of the tilt tells the tilt. */
double rotors_drag_mps2(const rotors_t *rotors, double climb_mps, double tilt_cosine);

#endif
