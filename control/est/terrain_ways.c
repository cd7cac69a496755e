/* What breaks: a way that does not compete. A ramp explains each scan as well as a sinking vehicle does, so
 * each way solves for both, and its density tells which of them is probable. */
#include "control/est/terrain_ways.h"

#include <math.h>

#include "control/between.h"

#define PER_OWN 66.4903801F /* 1 / (sqrt(2 pi) TERRAIN_OWN_M) */
#define NO_WAY 1.0e-5F      /* a way that is less probable before the scan is not computed */

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

/* One way: bits of the mirrors under which the ground steps or rises. */
typedef struct {
    uint16_t steps, rises;
} way_t;

/* What the mirrors that do not step show in one way. */
typedef struct {
    float count, rising;
    float sum_m, rising_sum_m, squares_m2;
} sight_t;

/* The most probable motion of vehicle and ramp in one way. */
typedef struct {
    float density;
    float off_m, off_m2;   /* of the prediction, with the common noise: mean, variance */
    float rise_m, rise_m2; /* of the ramp, beyond what was expected */
} explained_t;

static float prior_of(const terrain_ways_t *w, const way_t *way)
{
    float share = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(way->steps, m)) {
            share *= w->steps[m];
        } else if (has(way->rises, m)) {
            share *= w->rises[m];
        } else if (has(w->told, m)) {
            share *= 1.0F - w->steps[m] - w->rises[m];
        }
    }
    return share;
}

/* Returns the density of the steps and the noise's norm. */
static float look(const terrain_ways_t *w, const way_t *way, sight_t *sight)
{
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool rises = has(way->rises, m);
        const float off_m = w->off_m[m] + (rises ? w->rise_m : 0.0F);

        if (has(way->steps, m)) {
            density *= expf(-fabsf(w->off_m[m]) / TERRAIN_STEP_M) / (2.0F * TERRAIN_STEP_M);
        } else if (has(w->told, m)) {
            density *= PER_OWN;
            sight->count += 1.0F;
            sight->sum_m += off_m;
            sight->squares_m2 += off_m * off_m;
            sight->rising += rises ? 1.0F : 0.0F;
            sight->rising_sum_m += rises ? off_m : 0.0F;
        }
    }
    return density;
}

/* Two unknowns, the error of the prediction and the ramp's rise, from the normal equations. */
static explained_t explain(const terrain_ways_t *w, const sight_t *sight)
{
    const float per_m2 = 1.0F / (TERRAIN_OWN_M * TERRAIN_OWN_M);
    const float off = 1.0F / w->common_m2 + sight->count * per_m2;
    const float both = -sight->rising * per_m2;
    const float rise = 1.0F / w->rise_m2 + sight->rising * per_m2;
    const float det = off * rise - both * both;
    const float off_side = sight->sum_m * per_m2;
    const float rise_side = -sight->rising_sum_m * per_m2;
    const explained_t motion = {
        .off_m = (rise * off_side - both * rise_side) / det,
        .off_m2 = rise / det,
        .rise_m = (off * rise_side - both * off_side) / det,
        .rise_m2 = off / det,
    };
    const float square = sight->squares_m2 * per_m2 - off_side * motion.off_m - rise_side * motion.rise_m;
    const float norm = sqrtf(det * w->common_m2 * w->rise_m2);

    return (explained_t){expf(-0.5F * square) / norm, motion.off_m, motion.off_m2, motion.rise_m,
                         motion.rise_m2};
}

static void add_grounds(terrain_ways_t *w, const way_t *way, float density, float higher_m, float risen_m)
{
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(way->steps, m)) {
            w->ground_m[m] += density * (higher_m - w->off_m[m]);
        } else if (has(way->rises, m)) {
            w->on_ramp[m] += density;
            w->ground_m[m] += density * risen_m;
        }
    }
}

/* Where no ground has stayed, the height is known by its noise alone, and tells nothing of the speed. */
static void add_way(terrain_ways_t *w, const way_t *way)
{
    const float prior = prior_of(w, way);
    sight_t sight = {.count = 0.0F};

    if (prior < NO_WAY) {
        return;
    }
    const float look_density = look(w, way, &sight);
    const explained_t motion = explain(w, &sight);
    const float density = prior * look_density * motion.density;
    const bool anchored = sight.count > sight.rising;
    const float pull = motion.off_m / w->common_m2;
    const float gain = (w->common_m2 - motion.off_m2) / (w->common_m2 * w->common_m2);
    const float kept = 1.0F - w->variance_m2 * gain;
    const float noise_m2 = TERRAIN_COMMON_M * TERRAIN_COMMON_M +
                           TERRAIN_OWN_M * TERRAIN_OWN_M / at_least(sight.count, 1.0F);
    const float risen_m = w->rise_m + motion.rise_m;

    w->density += density;
    w->off += density * motion.off_m;
    w->pull += density * pull;
    w->pull_2 += density * pull * pull;
    w->gain += density * gain;
    w->kept += anchored ? density * kept : 0.0F;
    w->after_m2 += density * (anchored ? w->variance_m2 * kept : noise_m2);
    if (sight.rising > 0.0F) {
        w->ramp += density;
        w->risen += density * risen_m;
        w->risen_2 += density * (risen_m * risen_m + motion.rise_m2);
    }
    add_grounds(w, way, density, w->variance_m2 * pull, risen_m);
}

void terrain_ways_add(terrain_ways_t *w)
{
    for (uint16_t steps = 0U; steps <= w->told; ++steps) {
        for (uint16_t rises = 0U; rises <= w->told; ++rises) {
            if (((steps | rises) & (uint16_t)~w->told) == 0U && (steps & rises) == 0U) {
                add_way(w, &(way_t){steps, rises});
            }
        }
    }
}
