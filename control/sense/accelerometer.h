/* The witness of the accelerometer: its bias, measured at rest and corrected by the heights in the air, and
 * the vertical speed that it feels.
 *
 * Metres, seconds; positive is upwards. Times named _us are on one wrapping 32-bit clock. Pure; the caller
 * owns the state. Context: one Task. */
#ifndef CONTROL_SENSE_ACCELEROMETER_H
#define CONTROL_SENSE_ACCELEROMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "control/sense/witness.h"

#define ACCELEROMETER_BLOCKS \
    4U /* of a second: a lift-off shows within 3 s, two SWAY_TIME_S; one is being filled */

/* While a pilot flies it without heights, the felt speed fades so, and what lasts of it becomes bias. */
#define ACCELEROMETER_IN_HANDS_S 2.0F /* chosen: above the period of a pilot's swings */
#define ACCELEROMETER_IN_HANDS_BIAS_S \
    (10.0F * ACCELEROMETER_IN_HANDS_S) /* chosen: ten times; the bias was measured at rest */

typedef struct {
    uint32_t sequence; /* latest frame that was processed */
    uint32_t time_us;
    float up_mps2;   /* upward acceleration in that frame, gravity removed */
    float rest_mps2; /* its mean at rest */
    float rested_s;  /* time at rest that this mean covers, at most 2 s */
    bool measured;   /* it has lasted a second once: a shorter one tells no better bias */
    float kept_bias_mps2[ACCELEROMETER_BLOCKS]; /* the bias at the end of the latest seconds at rest, oldest
                                                   first */
    float block_s;                              /* time since the latter was taken */
    float bias_mps2;  /* of the accelerometer: at rest its mean, in the air corrected by the heights */
    float beyond_s;   /* how long that has been BIAS_MAX_MPS2, at most 2 s */
    float shaken;     /* >= 1, more when it is noisy: its speed counts so much less */
    float in_hands_s; /* how long somebody has had it in his hands on the ground, at most 2 s */
    witness_t felt;
} accelerometer_t;

typedef enum { REST_UNKNOWN, REST_FIT, REST_UNFIT } rest_t;

void accelerometer_init(accelerometer_t *accelerometer);

/* One frame: remembers it. Returns the mean acceleration since the frame before, and writes the time since
 * it. */
float accelerometer_mean_mps2(accelerometer_t *accelerometer, uint32_t time_us, float up_mps2,
                              uint32_t *gap_us);

/* After a gap of the frames: the speed starts from another one. */
void accelerometer_restart(accelerometer_t *accelerometer, float speed_mps);

/* dt_s at rest on the ground: the acceleration is the bias. */
void accelerometer_rest(accelerometer_t *accelerometer, float dt_s);

/* dt_s in the hands of a pilot or of somebody, without heights. Its way up and down is bounded, so the means
 * of speed and acceleration are 0. */
void accelerometer_in_hands(accelerometer_t *accelerometer, float mean_mps2, bool counts, float dt_s);

/* dt_s off the ground, or with a take-off commanded (standing). rise_mps: rate of the heights. */
void accelerometer_move(accelerometer_t *accelerometer, float mean_mps2, bool standing, float dt_s);

/* At rest it has been more than 1.5 m/s2 off g for 1 s (unfit), or less than 1.2 m/s2 (fit). */
rest_t accelerometer_judge_rest(const accelerometer_t *accelerometer);

/* The vehicle left the ground without a take-off of this firmware: what was measured since is no rest, and
 * the bias is that of three to four seconds before. */
void accelerometer_was_lifted(accelerometer_t *accelerometer, float rise_mps);

/* noise_mps2: its rms noise, measured. */
void accelerometer_set_noise(accelerometer_t *accelerometer, float noise_mps2);

/* Compares the change of the height with the witness. While the heights are believed they also correct its
 * speed and bias. */
void accelerometer_compare(accelerometer_t *accelerometer, float rise_m, float gap_s, float age_s,
                           bool believed);

/* True in state GROUND without heights, when the tilt has swayed as in the air and gone on moving for 1.5 s:
 * a pilot flies it, or somebody carries it; a nudge or a wrong frame is over sooner. Then the speed is
 * valid. */
bool accelerometer_is_in_hands(const accelerometer_t *accelerometer);

/* In the air the heights have told for a second that it is off by more than any bias, BIAS_MAX_MPS2. */
bool accelerometer_is_beyond(const accelerometer_t *accelerometer);

#endif
