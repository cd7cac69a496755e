/* Cascade control: height error -> vertical speed -> acceleration -> thrust. Heights in metres, speeds in
 * m/s, positive upwards. Thrust in newtons per motor. Pure, without a state. */
#ifndef CONTROL_CASCADE_H
#define CONTROL_CASCADE_H

#include <stdbool.h>

#define EST_FALL_MPS2 3.96F /* RISE_MAX_MPS2 of cascade.c: how hard a climb is braked */

/* Model of the vehicle: acceleration = authority (thrust - hover) - damping speed. */
typedef struct {
    float authority_mps2_per_n;
    float damping_per_s;
    float hover_n; /* hover thrust in calm air */
    float need_n;  /* hover thrust plus gust thrust */
    float upright; /* cos(roll) cos(pitch); 1 where the autopilot compensates the tilt itself */
} cascade_vehicle_t;

typedef struct {
    float height_per_s;     /* height error (m) -> vertical speed (m/s) */
    float speed_per_s;      /* speed error (m/s) -> acceleration (m/s2) */
    float up_mps, down_mps; /* limits of climb and descent, both > 0 */
} cascade_gains_t;

/* Predicted state of the vehicle at the instant when the next command takes effect. */
typedef struct {
    float height_m; /* above the terrain */
    float speed_mps;
    float terrain_mps;
    float thrust_n; /* delivered thrust at that instant, from the commands already given */
} cascade_state_t;

/* Vertical speed (m/s, against the earth) that brings the vehicle to reference_m above the terrain. It
 * includes the speed of the terrain. */
float cascade_speed_to(const cascade_gains_t *gains, const cascade_state_t *state, float reference_m);

/* Thrust for the wanted speed_mps: a quarter of the hover thrust at least, THRUST_MAX_N at most. */
float cascade_thrust_n(const cascade_gains_t *gains, const cascade_vehicle_t *vehicle,
                       const cascade_state_t *state, float speed_mps);

#endif
