/* What breaks: a step of the estimate that is taken for the ground's. The grounds are compared with those of
 * the scan before, over an altitude that knows of steps. When that is reset, all grounds step alike, and none
 * follows another. */
#include "control/est/ahead.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/seconds.h"

#define SPEED_MPS 0.4F /* at which the seed's course is flown, sim/scenarios/seed_course.h */
#define LASTS_S 3.7F   /* a direction, on the seed's course: ramp at 7.3 s, edge at 11.0 s */
#define BEGINS 0.05F   /* chosen: unknown is neither, until grounds follow each other */
#define MEETS 0.04F    /* of the scans, for a mirror that leads: STEP_SHARE of belief_density.h, fitted */
#define CHANGE_M \
    0.010198F             /* of one scan's height against another's: root of 2 (6 mm^2 + 4 mm^2), terrain.h */
#define MILLIMETRE 0.001F /* the least length that a parameter tells: D1 and D2 may be 0 */
#define ROOT_TWO_PI 2.5066283F /* the square root of 2 pi */

#define ALL_MIRRORS ((1U << MIRROR_COUNT) - 1U)

typedef struct {
    float was_m[MIRROR_COUNT];
    float changed_m[MIRROR_COUNT];
    float gap_s;
} grounds_t;

static float normal(float off_m, float sigma_m)
{
    const float sigmas = off_m / sigma_m;

    return expf(-0.5F * sigmas * sigmas) / (ROOT_TWO_PI * sigma_m);
}

/* A difference as small as noise is none: heights that come back from their noise seem to follow others. */
static float beyond_noise(float off_m)
{
    const float sigmas = off_m / CHANGE_M;

    return off_m * (1.0F - expf(-0.5F * sigmas * sigmas));
}

/* Probability that a spot is passed which is so far away. */
static float passes(float way_m, float time_s)
{
    return 1.0F - expf(-SPEED_MPS * time_s / way_m);
}

/* Density of the change of a ground that follows no other. */
static float on_its_own(float changed_m, float steps)
{
    return (1.0F - steps) * normal(changed_m, CHANGE_M) +
           steps * expf(-fabsf(changed_m) / TERRAIN_STEP_M) / (2.0F * TERRAIN_STEP_M);
}

/* Density of the change of a ground that becomes the one way_m farther on: all of it where an edge is passed,
 * and on a slope the part that is flown in a scan. The two are one sigma to either side of the mean. */
static float as_another(const grounds_t *grounds, uint16_t m, uint16_t leads, float way_m)
{
    const float changed_m = grounds->changed_m[m];
    const float off_m = beyond_noise(grounds->was_m[leads] - grounds->was_m[m]);
    const float part = passes(way_m, grounds->gap_s);
    const float mean_m = 0.5F * (1.0F + part) * off_m;
    const float spread_m = 0.5F * (1.0F - part) * off_m;
    const float follows = normal(changed_m - mean_m, sqrtf(CHANGE_M * CHANGE_M + spread_m * spread_m));

    return part * follows + (1.0F - part) * on_its_own(changed_m, TERRAIN_STEP);
}

static float in_a_row(const ahead_t *ahead, const grounds_t *grounds, uint16_t leads, uint16_t trails)
{
    return on_its_own(grounds->changed_m[leads], MEETS) *
           as_another(grounds, MIRROR_FRONT, leads, ahead->way_m[leads]) *
           as_another(grounds, trails, MIRROR_FRONT, ahead->way_m[trails]);
}

static float each_on_its_own(const grounds_t *grounds)
{
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        density *= on_its_own(grounds->changed_m[m], TERRAIN_STEP);
    }
    return density;
}

static void learn(ahead_t *ahead, const grounds_t *grounds)
{
    const float anew = at_most(grounds->gap_s / LASTS_S, 1.0F);
    const float nose = ahead->nose + anew * (BEGINS - ahead->nose);
    const float tail = ahead->tail + anew * (BEGINS - ahead->tail);
    const float is_nose = nose * in_a_row(ahead, grounds, MIRROR_FORE, MIRROR_AFT);
    const float is_tail = tail * in_a_row(ahead, grounds, MIRROR_AFT, MIRROR_FORE);
    const float sum = is_nose + is_tail + (1.0F - nose - tail) * each_on_its_own(grounds);

    ahead->nose = (sum > 0.0F) ? is_nose / sum : 0.0F;
    ahead->tail = (sum > 0.0F) ? is_tail / sum : 0.0F;
}

void ahead_scan(ahead_t *ahead, const terrain_heights_t *heights, float altitude_m, float ground_m,
                uint32_t rays_us)
{
    if (heights->valid != ALL_MIRRORS) {
        *ahead = (ahead_t){.known = false};
        return;
    }
    grounds_t grounds = {.gap_s = at_most(seconds_between(ahead->rays_us, rays_us), CYCLE_MAX_S)};
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float under_m = altitude_m - heights->height_m[m];

        grounds.was_m[m] = ahead->under_m[m];
        grounds.changed_m[m] = under_m - ahead->under_m[m];
        ahead->under_m[m] = under_m;
        ahead->way_m[m] = at_least(fabsf(heights->fore_m[m] - heights->fore_m[MIRROR_FRONT]), MILLIMETRE);
    }
    if (ahead->known) {
        learn(ahead, &grounds);
    }
    ahead->known = true;
    ahead->ground_m = ground_m;
    ahead->rays_us = rays_us;
}

void ahead_look(ahead_t *ahead, const estimator_t *estimator, const terrain_sight_t *sight, uint32_t rays_us)
{
    const float ground_m = estimator->terrain_height_m;

    if (sight->doubted != 0U) {
        *ahead = (ahead_t){.known = false};
    } else if (sight->mirrors != NULL) {
        const terrain_heights_t heights = estimator_heights(estimator, sight, rays_us);

        ahead_scan(ahead, &heights, estimator->filter.estimate.height_m + ground_m, ground_m, rays_us);
    }
}

/* How much the ground rises, on average, by the mirror that leads with this probability. */
static float rise_m(const ahead_t *ahead, const cascade_gains_t *gains, mirror_t leads, float probability,
                    float later_s)
{
    const float off_m = between(-gains->down_mps / gains->height_per_s,
                                ahead->under_m[leads] - ahead->ground_m, gains->up_mps / gains->height_per_s);

    return probability * passes(ahead->way_m[leads], later_s) * beyond_noise(off_m);
}

float ahead_setpoint_m(const ahead_t *ahead, const cascade_gains_t *gains, float setpoint_m, uint32_t then_us)
{
    float highest_m = 0.0F;

    if (!ahead->known) {
        return setpoint_m;
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        highest_m = at_least(highest_m, ahead->under_m[m] - ahead->ground_m);
    }
    const float later_s = seconds_between(ahead->rays_us, then_us);
    const float wanted_m = setpoint_m + rise_m(ahead, gains, MIRROR_FORE, ahead->nose, later_s) +
                           rise_m(ahead, gains, MIRROR_AFT, ahead->tail, later_s);
    return at_least(wanted_m, at_most(setpoint_m, highest_m + TERRAIN_LEAST_M));
}
