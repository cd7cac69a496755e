/* Take-off of law EST: the thrust ramps up until the vehicle leaves the ground.
 *
 * Metres, seconds, newtons per motor; positive is upwards. Pure; the caller owns the state, all zero at
 * first. Context: one Task. */
#ifndef CONTROL_LIFT_OFF_H
#define CONTROL_LIFT_OFF_H

#include <stdbool.h>

typedef struct {
    bool ramping;   /* the thrust ramps up */
    float ramp_n;   /* thrust of that ramp */
    float up_mps2;  /* low-passed upward acceleration */
    float thrust_n; /* delivered thrust through the same low-pass */
    float up_mps;   /* upward speed since the ramp began, from the accelerometer */
    float ground_m; /* height where it stood last; not 0 when something blocks the beam */
} lift_off_t;

/* On the ground, in every cycle. ground_m: the height as it is estimated there. */
void lift_off_reset(lift_off_t *lift, float gravity_n, float ground_m);

/* Once per IMU frame. felt_mps2: upward acceleration, 0 when none is measured. delivered_n: the thrust. */
void lift_off_watch(lift_off_t *lift, float felt_mps2, float delivered_n, float dt_s);

/* What one cycle shows of a vehicle that stands, or has just left the ground. */
typedef struct {
    float height_m;    /* estimated */
    float delivered_n; /* thrust */
    float noise_mps2;  /* rms noise of the accelerometer */
    bool felt;         /* accelerations are measured */
    float most_mps2;   /* as the lightest vehicle would accelerate at lift->thrust_n; more is noise */
} lift_off_signs_t;

/* True when the vehicle has left the ground. */
bool lift_off_is_seen(const lift_off_t *lift, const lift_off_signs_t *signs);

/* It stands: the ramp goes on for step_s, up to what lifts a vehicle that hovers with known_n. */
void lift_off_ramp(lift_off_t *lift, float known_n, float step_s);

/* It stands, and is to stay there: the ramp goes back to 0. */
void lift_off_give_up(lift_off_t *lift, float step_s);

/* During the ramp the vehicle does not yet accelerate upwards. noise_mps2: as above. */
bool lift_off_stands(const lift_off_t *lift, float noise_mps2);

/* Where the ramp alone has brought a vehicle whose lift-off only the heights show. */
typedef struct {
    float height_m, speed_mps;
    float thrust_n; /* delivered at the lift-off */
} lifted_t;

/* height_m: as estimated. late_s: age of that height. authority_mps2_per_n: see cascade.h. */
lifted_t lift_off_by_height(const lift_off_t *lift, const lift_off_signs_t *signs, float late_s,
                            float authority_mps2_per_n);

#endif
