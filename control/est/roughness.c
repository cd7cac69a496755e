/* What breaks: innovations would also contain the noise of the accelerometer; so the heights are compared
 * with each other. An edge or a wrong scan is no noise, or after some of them none would be rejected any
 * more: a height that is off by more than a bar begins anew. Over bars the filter takes small edges for
 * speed, and after a large one the next change of the height. */
#include "control/est/roughness.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

#define FLOOR_START_M 0.004F     /* of a smooth floor: MIRROR_NOISE_MM of sense/plane.c */
#define FLOOR_SHARE 0.20F        /* tried: a slower mean knows bars of 60 mm only after the take-off */
#define FLOOR_CLIP (3.0F * 3.0F) /* 3 sigma of what is measured, one in 370: an edge counts little */
#define FLOOR_VARIANCE \
    0.5F /* tried 1: it swings by the thrust model alone, to 0.5 m too high behind a ramp */
#define BAR_US UINT32_C(1000000) /* chosen: two edges within that time are a bar, and more will follow */
#define BAR_SHARE 0.5F           /* rms of a height that is half of the time on the bar */
/* Higher ones would be noise beyond what any floor has: edges or wrong scans, which are rejected. */
#define BAR_MOST_M (INNOVATION_LIMIT_MAX_M / BAR_SHARE)

void roughness_init(roughness_t *roughness)
{
    *roughness = (roughness_t){.noise_m = FLOOR_START_M};
}

static void keep(roughness_t *roughness, float height_m)
{
    roughness->previous_m[1] = roughness->previous_m[0];
    roughness->previous_m[0] = height_m;
}

/* The second difference of white noise has six times its variance. */
static void measure(roughness_t *roughness, float height_m)
{
    const float difference_m = height_m - 2.0F * roughness->previous_m[0] + roughness->previous_m[1];
    const float variance = roughness->noise_m * roughness->noise_m;
    const float seen = at_most(difference_m * difference_m / 6.0F, FLOOR_CLIP * variance);

    roughness->noise_m = between(FLOOR_START_M, sqrtf(variance + FLOOR_SHARE * (seen - variance)),
                                 INNOVATION_LIMIT_MAX_M);
}

float roughness_variance_m2(const roughness_t *roughness)
{
    const float noise_m = roughness->noise_m;
    return FLOOR_VARIANCE * at_least(noise_m * noise_m - ROUGHNESS_SMOOTH_M * ROUGHNESS_SMOOTH_M, 0.0F);
}

static void watch_bars(roughness_t *roughness, float innovation_m, uint32_t rays_us)
{
    if (fabsf(innovation_m) < HEIGHT_NO_NOISE_M || fabsf(innovation_m) > BAR_MOST_M) {
        return;
    }
    if (innovation_m * roughness->edge_m < 0.0F && rays_us - roughness->edge_us < BAR_US) {
        const float bar_m = at_most(fabsf(innovation_m), fabsf(roughness->edge_m));
        roughness->noise_m = between(roughness->noise_m, BAR_SHARE * bar_m, INNOVATION_LIMIT_MAX_M);
    }
    roughness->edge_m = innovation_m;
    roughness->edge_us = rays_us;
}

void roughness_step(roughness_t *roughness, float height_m, float innovation_m, uint32_t rays_us)
{
    if (fabsf(innovation_m) > BAR_MOST_M) {
        roughness->in_a_row = 0U;
    } else if (roughness->in_a_row < 2U) {
        ++roughness->in_a_row;
    } else {
        measure(roughness, height_m);
    }
    keep(roughness, height_m);
    watch_bars(roughness, innovation_m, rays_us);
}
