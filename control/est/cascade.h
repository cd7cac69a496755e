/* Height -> vertical speed -> acceleration -> thrust, and the take-off before it. Pure; the caller owns the state. */
#ifndef CONTROL_CASCADE_H
#define CONTROL_CASCADE_H

#include <stdbool.h>

/* What thrust does to the vehicle: acceleration = authority (thrust - hover) - damping speed. */
typedef struct {
    float authority_mps2_per_n;
    float damping_per_s;
    float hover_n;          /* without gusts */
    float need_n;           /* to stay where it is now: hover and gusts */
    float upright;          /* cos(roll) cos(pitch), or 1 where the autopilot sees to that itself */
} cascade_vehicle_t;

typedef struct {
    float height_per_s;     /* metres off the reference -> metres per second */
    float speed_per_s;      /* metres per second off -> metres per second squared */
    float up_mps, down_mps; /* limits of the speed, > 0 */
    float fall_mps2;        /* limit of the acceleration downwards, > 0 */
    float below_hover_n;    /* and of the thrust that it is got by */
} cascade_gains_t;

/* The vehicle at the instant when the next command takes effect. */
typedef struct {
    float height_m;         /* above the terrain */
    float speed_mps;
    float terrain_mps;
    float thrust_n;         /* delivered then, by the commands on their way */
} cascade_state_t;

typedef struct {
    float thrust_n;         /* previous command */
    float quick_n;          /* quick changes of the command: mean square */
    float slow_n;           /* slow mean of the command */
} cascade_t;

void cascade_init(cascade_t *cascade, float thrust_n);

/* Speed that brings the vehicle to reference_m, terrain included. */
float cascade_speed_to(const cascade_gains_t *gains, const cascade_state_t *state, float reference_m);

/* Thrust for a speed, newtons per motor, within the actuator's range. */
float cascade_step(cascade_t *cascade, const cascade_gains_t *gains, const cascade_vehicle_t *vehicle,
                   const cascade_state_t *state, float speed_mps, float dt_s);

#endif
