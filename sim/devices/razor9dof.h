/* Model of the Razor 9DOF IMU with the vehicle's text format: every 25 ms `#A-C=x,y,z` CR LF
 * `#YPR=yaw,pitch,roll` CR LF at 57600, content 15 ms old, noise and spikes as in the plant description. Axes
 * and signs are Razor_AHRS's own: roll positive with the right wing down, +256 along z at rest. Shares no
 * writer with the product. */
#ifndef SIM_DEVICES_RAZOR9DOF_H
#define SIM_DEVICES_RAZOR9DOF_H

#include <stdbool.h>

#include "sim/devices/serial.h"
#include "sim/devices/span.h"

typedef struct {
    double roll_rad, pitch_rad, yaw_rad; /* of the vehicle: roll > 0 raises its right side */
    double up_mps2;                      /* acceleration of the body along the earth's vertical, without g */
    double t_s;                          /* scenario time, for what goes wrong at its time */
} razor_truth_t;

typedef razor_truth_t (*razor_world_t)(void *context);

typedef struct {
    sim_time_t period;                      /* 25 ms */
    sim_time_t age;                         /* 15 ms */
    sim_time_t phase;                       /* first frame after power-up */
    double angle_noise_rad;                 /* 0.25 deg */
    double spike_probability;               /* 0.005 per angle */
    double spike_rad;                       /* 0.35 */
    double acceleration_noise_mps2;         /* 0.4 */
    double acceleration_bias_mps2;          /* 0.15 */
    double mount_roll_rad, mount_pitch_rad; /* constant misalignment, what the offset must remove */
    bool joined;                            /* both parts on one line */
    double stock;                           /* 1: Razor_AHRS as it comes, angles alone (at 20 ms: period) */
    double acceleration_scale;              /* 1: another unit than counts of 1/256 g */
    double acceleration_sign; /* 1; -1: upside down to the sensor, or a firmware with the other sign */
    /* What another firmware, unit or mounting does to the angles: 1, or -1; 1: exchanged; pi/180: radians. */
    double roll_sign, pitch_sign, swapped, angle_scale;
    double turned;                 /* 1: mounted with its nose to the tail: angles and accelerations agree */
    double acceleration_jump_mps2; /* 0: bias that comes at ... */
    double acceleration_jump_start_s; /* 10 */
    double
        acceleration_alias_mps2;  /* 0: amplitude of a vibration that the sampling has brought down to ... */
    double acceleration_alias_hz; /* 2 */
    double attitude_burst_rad;    /* 0: added to the attitude ... */
    double attitude_burst_radps;  /* 0: ... and growing so fast ... */
    double attitude_burst_turned_rad; /* 0: to roll; a right angle: to pitch */
    span_t attitude_burst;            /* 10 s, for three frames */
    span_t mute, frozen, garbled; /* 10 s, for 0 s: nothing is sent; the latest frame again and again; octets
                                   * with a wrong bit */
    double garbled_share;         /* 0.05 of the octets */
} razor_config_t;

extern const razor_config_t razor_default;

typedef struct razor9dof razor9dof_t;
razor9dof_t *razor9dof_create(const razor_config_t *config, razor_world_t world, void *world_context,
                              unsigned long seed, serial_sink_t sink, void *sink_context);
/* Noise and faults become others while it sends; its period, phase, age and kind of firmware stay. */
void razor9dof_change(razor9dof_t *razor, const razor_config_t *config);
void razor9dof_destroy(razor9dof_t *razor);
void razor9dof_power(razor9dof_t *razor, bool on);

#endif
