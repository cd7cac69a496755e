/* What breaks: a covariance that is kept against the start. After a slide of the ground the height above it
 * is known as well as ever, and only the altitude is not; so the variance belongs to the height above the
 * ground of now. And a rate that is not remembered: a ramp explains each scan as well as a sinking vehicle
 * does, and only that all mirrors rise by what the first one has shown tells them apart. The belief about
 * liars (sense/belief.h) is not asked: it takes the one mirror that still shows level ground for blocked
 * while two climb a ramp (0.999 in simulation), because only here the motion is known. */
#include "control/est/terrain.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/est/terrain_ways.h"

/* ---- noise models: see terrain.h and terrain_ways.h */
#define RAMP_MPS 0.4F          /* rms of a rate, as the seed's ramp: 0.25 m in 0.7 s */
#define RAMP_DRIFT_MPS2_2 0.1F /* (m/s)2 a second: half of RAMP_MPS in 0.4 s */

/* ---- shares of the scans, for each mirror */
#define STEP_UNEVEN 0.05F  /* and more where it is not */
#define RAMP_BEGINS 0.005F /* one of 200: the seed's course has one ramp in 20 s */
#define RAMP_UNEVEN 0.1F
#define RAMP_GOES_ON 0.85F /* the seed's ramp takes 7 scans, 0.7 s: 1 - 1/7 */
#define RAMP_NEXT 0.2F     /* of a mirror, where another one is on it: 0.2 m of bracket at 0.4 m/s */
#define MOVES_MOST 0.95F   /* one that stays is never impossible */

#define UNEVEN_M 0.012F   /* a difference of the grounds that shows: twice TERRAIN_OWN_M */
#define EVEN_SHARE 0.005F /* of a scan: the mirrors' own errors are known after 20 s */

#define FLAT_VARIANCE (RAMP_MPS * RAMP_MPS)

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

static bool is_shown(const terrain_sight_t *sight, uint16_t mirror, uint16_t left_out)
{
    return sight->mirrors[mirror].valid && !has(left_out, mirror);
}

bool terrain_is_shown(const terrain_sight_t *sight, mirror_t mirror)
{
    return is_shown(sight, (uint16_t)mirror, sight->liars);
}

bool terrain_sees_ground(const terrain_sight_t *sight, bool begun)
{
    uint16_t shown = 0U;

    for (uint16_t m = 0U; sight->mirrors != NULL && m < MIRROR_COUNT; ++m) {
        shown = (uint16_t)(shown + is_shown(sight, m, begun ? sight->liars : sight->doubted));
    }
    return shown > 1U;
}

/* ---- from scan to scan */

/* How uneven the ground under the mirrors is, 0 .. 1. */
static float unevenness(const terrain_t *terrain)
{
    float low_m = INFINITY;
    float high_m = -INFINITY;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(terrain->known, m)) {
            low_m = at_most(low_m, terrain->ground_m[m] - terrain->even_m[m]);
            high_m = at_least(high_m, terrain->ground_m[m] - terrain->even_m[m]);
        }
    }
    const float sigmas = (high_m > low_m) ? (high_m - low_m) / UNEVEN_M : 0.0F;
    return 1.0F - expf(-0.5F * sigmas * sigmas);
}

/* Probabilities before the scan. */
static void expect(const terrain_t *terrain, terrain_ways_t *w, float gap_s)
{
    const float uneven = unevenness(terrain);
    float most = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        most = at_least(most, terrain->ramp[m]);
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float on = RAMP_GOES_ON * terrain->ramp[m] + RAMP_NEXT * (most - terrain->ramp[m]);

        w->steps[m] = TERRAIN_STEP_LEVEL + STEP_UNEVEN * uneven;
        w->rises[m] = at_most(RAMP_BEGINS + (RAMP_UNEVEN + on) * uneven, MOVES_MOST - w->steps[m]);
    }
    w->rise_m = terrain->rise_mps * gap_s;
    w->rise_m2 = (terrain->rise_variance + RAMP_DRIFT_MPS2_2 * gap_s) * gap_s * gap_s;
}

/* A mirror that tells something for the first time has its ground from that. */
static void meet(terrain_t *terrain, uint16_t mirror, float ground_m)
{
    terrain->rise_variance = (terrain->known == 0U) ? FLAT_VARIANCE : terrain->rise_variance;
    terrain->known |= (uint16_t)(1U << mirror);
    terrain->ground_m[mirror] = ground_m;
    terrain->even_m[mirror] = ground_m;
    terrain->ramp[mirror] = 0.0F;
}

/* The grounds, and the ramp: none is a new one, of any rate. */
static void learn(terrain_t *terrain, const terrain_ways_t *w, float gap_s)
{
    const float rise_mps = w->risen / (w->density * gap_s);
    const float squares = w->risen_2 / (w->density * gap_s * gap_s) +
                          (1.0F - w->ramp / w->density) * FLAT_VARIANCE;

    terrain->rise_mps = rise_mps;
    terrain->rise_variance = squares - rise_mps * rise_mps;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(w->told, m)) {
            terrain->ramp[m] = w->on_ramp[m] / w->density;
            terrain->ground_m[m] += w->ground_m[m] / w->density;
        }
        terrain->even_m[m] += EVEN_SHARE * (terrain->ground_m[m] - terrain->even_m[m]);
    }
}

/* The middle one of three, the mean of two. */
static float middle_m(const terrain_t *terrain, uint16_t set)
{
    float sum_m = 0.0F;
    float low_m = INFINITY;
    float high_m = -INFINITY;
    float count = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(set, m)) {
            sum_m += terrain->ground_m[m];
            low_m = at_most(low_m, terrain->ground_m[m]);
            high_m = at_least(high_m, terrain->ground_m[m]);
            count += 1.0F;
        }
    }
    return (count > 2.0F) ? sum_m - low_m - high_m : sum_m / count;
}

static filter_merge_t merge_of(const terrain_ways_t *w)
{
    const float pull = w->pull / w->density;

    return (filter_merge_t){
        .pull_per_m = pull,
        .less_per_m2 = (w->gain - w->pull_2) / w->density + pull * pull,
        .kept = w->kept / w->density,
        .variance_m2 = w->after_m2 / w->density,
    };
}

terrain_shown_t terrain_scan(terrain_t *terrain, const terrain_heights_t *heights, float altitude_m,
                             float variance_m2, float gap_s)
{
    terrain_ways_t w = {.variance_m2 = variance_m2,
                        .common_m2 = variance_m2 + TERRAIN_COMMON_M * TERRAIN_COMMON_M};
    terrain_shown_t shown = {.merge = {.kept = 1.0F, .variance_m2 = variance_m2}};

    w.told = heights->valid & terrain->known;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(heights->valid, m) && !has(terrain->known, m)) {
            meet(terrain, m, altitude_m - heights->height_m[m]);
        }
        w.off_m[m] = heights->height_m[m] - (altitude_m - terrain->ground_m[m]);
    }
    expect(terrain, &w, gap_s);
    terrain_ways_add(&w);
    if (w.told != 0U && w.density > 0.0F) {
        shown.merge = merge_of(&w);
        shown.innovation_m = w.off / w.density;
        learn(terrain, &w, gap_s);
    }
    shown.ground_m = middle_m(terrain, heights->valid);
    return shown;
}
