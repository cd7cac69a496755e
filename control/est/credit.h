/* How far the accelerometer is trusted, against the thrust model and the heights.
 *
 * Metres, m/s2; positive is upwards. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_CREDIT_H
#define CONTROL_CREDIT_H

#include <stdbool.h>
#include <stdint.h>

/* Acceleration that the thrust should cause. */
typedef struct {
    bool known;
    float up_mps2;
    float noise_mps2; /* rms error of up_mps2, > 0 */
} modelled_motion_t;

typedef struct {
    float previous_mps2[2];  /* raw accelerations of the two frames before */
    float noise_mps2;        /* measured rms of the accelerometer's noise */
    float off_model_mps2;    /* measured less modelled acceleration, low-passed */
    float mean_innovation_m; /* of the heights, low-passed */
    uint16_t fused_count; /* heights in a row that were fused; counted up to the number that a mean needs */
    uint16_t accused_frames; /* > 0: heights and model agree that the accelerometer is wrong */
} credit_t;

void credit_init(credit_t *credit);

/* The first frame, or the first one after a gap. */
void credit_restart(credit_t *credit, float up_mps2);

/* One frame with accelerations: its noise is measured. */
void credit_measure_noise(credit_t *credit, float up_mps2);

/* The source of the acceleration has changed: its error is another one. */
void credit_new_source(credit_t *credit);

/* One height was fused. innovation_m: measured minus predicted. */
void credit_height(credit_t *credit, float innovation_m);

/* A height was rejected: the terrain has an edge. */
void credit_edge(credit_t *credit);

/* Once per frame. off_mps2: measured less modelled acceleration; 0 when nothing is modelled. heights_noise_m:
 * rms noise of the heights. Returns the share of the accelerometer in the acceleration, 0 .. 1. */
float credit_share(credit_t *credit, const modelled_motion_t *model, float off_mps2, float heights_noise_m);

/* Heights and the modelled acceleration agree, or did within 0.8 s, that the accelerometer is wrong. */
bool credit_accuses(const credit_t *credit);

#endif
