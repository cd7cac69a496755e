/* How probable a value is that a scan shows: a step of the terrain, a constant, what the accelerometer tells,
 * a motion that mirrors share. Densities integrate to one, but for STEP_SHARE, REST_MPS2, and
 * density_of_motion(), a ratio.
 *
 * Millimetres, m/s2. Pure, without a state. Context: any. */
#ifndef CONTROL_SENSE_BELIEF_DENSITY_H
#define CONTROL_SENSE_BELIEF_DENSITY_H

#include <math.h>
#include <stdint.h>

/* Standard deviation of one mirror's height about that of the others, and of a blocked beam's slant. Fitted
 * on healthy flights, see belief_world.c; recorded: 1 mm at most. */
#define BELIEF_NOISE_MM 6.0F

#define PER_MM 0.0664903801F  /* 1 / (sqrt(2 pi) BELIEF_NOISE_MM) */
#define STEP_SHARE 0.04F      /* of the scans, for each mirror: an edge passes under it */
#define STEP_MM 170.0F        /* mean size of these steps (Laplace): stairs of 170 mm, boxes, tables */
#define STEP_NEAR_SHARE 0.7F  /* of the steps: a slope begins or ends, or a small edge */
#define STEP_NEAR_MM 10.0F    /* fitted, docs/control.md */
#define STEP_FAR_SHARE 0.002F /* of the steps: as far as the scanner sees */
#define STEP_FAR_PER_MM (1.0F / 8000.0F) /* 4 m up or down */
/* What a sound accelerometer tells beyond the thrust: a Student t of three degrees of freedom, whose
 * percentiles make noise prints beside those of healthy flights. A Gaussian has no such tail. While the
 * thrust changes, it tells more beyond the model's. A lying one tells anything within its range. */
#define STRANGE_MPS2 0.5F /* fitted: its scale */
/* The same of a vehicle that stands, where no mirror tells whether it does: no model of a thrust is wrong
 * there. With the scale of flight, one that fell at 2 m/s2 seemed to stand as well as to fly. The peak is
 * that of flight, because calm scans come in a row, and are no evidence for the ground each. So the density
 * integrates to 0.6. Where the heights tell that it stands, motors that shake the IMU must not refute it. */
#define REST_MPS2 0.3F /* fitted: its scale, on the ground */

/* Of a step under one mirror, times the share of the scans that have one. */
static inline float density_of_step(float step_mm)
{
    return STEP_SHARE *
           ((1.0F - STEP_FAR_SHARE - STEP_NEAR_SHARE) * expf(-fabsf(step_mm) / STEP_MM) / (2.0F * STEP_MM) +
            STEP_NEAR_SHARE * expf(-fabsf(step_mm) / STEP_NEAR_MM) / (2.0F * STEP_NEAR_MM) +
            STEP_FAR_SHARE * STEP_FAR_PER_MM);
}

/* Of a value that is a constant, known as the mean of so many. */
static inline float density_of_constant(float mm, float mean_mm, float count)
{
    const float wider = 1.0F + 1.0F / ((count > 1.0F) ? count : 1.0F); /* variance, in that of the noise */
    const float off_mm = mm - mean_mm;

    return PER_MM * expf(-0.5F * off_mm * off_mm / (BELIEF_NOISE_MM * BELIEF_NOISE_MM * wider)) /
           sqrtf(wider);
}

/* Of two causes together. */
static inline float variance(float sigma, float other_sigma)
{
    return sigma * sigma + other_sigma * other_sigma;
}

/* Of this acceleration, with this scale. */
static inline float density_of_strange(float mps2, float scale_mps2)
{
    const float scales = mps2 / scale_mps2;
    const float wider = 1.0F + scales * scales / 3.0F;

    return 0.367552597F / (scale_mps2 * wider * wider); /* 2 / (pi sqrt(3)) */
}

/* What mirrors share in one kind of motion, in their density: its factor, and 1/mm2 of the exponent, of the
 * square of their sum. */
typedef struct {
    float norm, shared;
} belief_motion_t;

/* A motion that n mirrors share, beside the noise of each: by hand, as the noises are equal (Sherman and
 * Morrison 1950). */
static inline belief_motion_t motion_of(uint16_t n, float sigma_mm)
{
    const float noise_mm2 = BELIEF_NOISE_MM * BELIEF_NOISE_MM;
    const float all_mm2 = noise_mm2 + (float)n * sigma_mm * sigma_mm;

    return (belief_motion_t){.norm = sqrtf(noise_mm2 / all_mm2),
                             .shared = 0.5F * sigma_mm * sigma_mm / (all_mm2 * noise_mm2)};
}

/* Normal density of their innovations, by sum and sum of squares, in that of as many without motion or
 * innovation. */
static inline float density_of_motion(float sum_mm, float squares_mm2, const belief_motion_t *motion)
{
    const float half_per_mm2 = 0.5F / (BELIEF_NOISE_MM * BELIEF_NOISE_MM);

    return motion->norm * expf(motion->shared * sum_mm * sum_mm - half_per_mm2 * squares_mm2);
}

#endif
