/* How roll and pitch move. A vehicle in the air sways all the time; one on the ground does not.
 *
 * Radians. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_SWAY_H
#define CONTROL_SENSE_SWAY_H

#include <stdbool.h>
#include <stdint.h>

#include "control/imu_sample.h"

#define SWAY_TIME_S 1.5F /* chosen: 60 frames, nearly a period of the sway, 0.6 Hz */

typedef struct {
    float mean_rad[2];   /* low-passed roll and pitch */
    float anchor_rad[2]; /* roll and pitch when they last moved, near the ground */
    float unrocked_s;    /* time since then */
    float sway_rad2;     /* low-passed mean square of roll and pitch around mean_rad */
    uint32_t alone_us;   /* latest frame without accelerations */
} sway_t;

/* One accepted frame, dt_s after the one before. height_m: latest height. */
void sway_frame(sway_t *sway, const imu_sample_t *frame, float height_m, float dt_s);

/* The same for a frame that came without accelerations. They have a clock of their own. */
void sway_frame_alone(sway_t *sway, const imu_sample_t *frame, float height_m);

/* True when roll and pitch sway as in the air: more than 1.1 degrees rms together. */
bool sway_as_in_the_air(const sway_t *sway);

/* True when they sway less than that: below 0.9 degrees rms, as on the ground. */
bool sway_is_calm(const sway_t *sway);

/* The contrary of calm with less delay, for the end of a landing: the tilt has moved by a degree within the
 * last 0.8 s. */
bool sway_rocks(const sway_t *sway);

/* True when they sway less than a vehicle that somebody tilts by hand. */
bool sway_is_no_hand(const sway_t *sway);

#endif
