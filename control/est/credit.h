/* How far the accelerometer is trusted, against the thrust model.
 *
 * Metres, m/s2; positive is upwards. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_CREDIT_H
#define CONTROL_CREDIT_H

#include <stdbool.h>
#include <stdint.h>

#define CREDIT_NOISE_MPS2 0.4F /* rms, assumed of a Razor on a flying frame */

/* Acceleration that the thrust should cause. */
typedef struct {
    bool known;
    float up_mps2;
    float noise_mps2; /* rms error of up_mps2, > 0 */
    float bias_mps2;  /* rms error of the accelerometer that lasts; 0 while heights are there to correct it */
} modelled_motion_t;

typedef struct {
    float previous_mps2[2]; /* raw accelerations of the two frames before */
    float noise_mps2;       /* measured rms of the accelerometer's noise */
} credit_t;

void credit_init(credit_t *credit);

/* The first frame, or the first one after a gap. */
void credit_restart(credit_t *credit, float up_mps2);

/* One frame with accelerations: its noise is measured. */
void credit_measure_noise(credit_t *credit, float up_mps2);

/* Share of the accelerometer in the acceleration, 0 .. 1, by the noise of both. */
float credit_share(const credit_t *credit, const modelled_motion_t *model);

#endif
