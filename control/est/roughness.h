/* Noise of the heights: of the sensor, and of a floor that is not flat.
 *
 * Metres. Times are in microseconds on one wrapping 32-bit clock. Pure; the caller owns the state. Context:
 * one Task. */
#ifndef CONTROL_ROUGHNESS_H
#define CONTROL_ROUGHNESS_H

#include <stdint.h>

#include "control/credible.h"

/* of the test of a height, estimator.c; tried: with a wider one a half-seen edge made it fly away */
#define INNOVATION_LIMIT_MAX_M 0.080F
#define ROUGHNESS_SMOOTH_M \
    (3.0F * HEIGHT_SIGMA_M) /* the noisiest scanner's, one scan in 370, is no floor \
                             */

typedef struct {
    float previous_m[2]; /* the two previous heights */
    uint16_t in_a_row;   /* of these, since an edge or a wrong scan */
    float noise_m;       /* measured rms noise of the heights */
    float edge_m;        /* latest innovation as high as a bar */
    uint32_t edge_us;    /* instant of its rays */
} roughness_t;

void roughness_init(roughness_t *roughness);

/* Each height, also one that is rejected. innovation_m: measured minus predicted. An edge that comes and goes
 * is a bar, and more will follow: the noise rises to that of a rough floor at once. */
void roughness_step(roughness_t *roughness, float height_m, float innovation_m, uint32_t rays_us);

/* Variance that a rough floor adds to a height, without what a step or a climb adds. */
float roughness_variance_m2(const roughness_t *roughness);

#endif
