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

/* ---- noise models: see terrain.h */
#define OWN_M 0.006F           /* BELIEF_NOISE_MM of sense/belief.h, fitted */
#define COMMON_M 0.004F        /* sim/devices/scene.h: 3 mm of a scan, drawn up to 6 */
#define PER_OWN 66.4903801F    /* 1 / (sqrt(2 pi) OWN_M) */
#define RAMP_MPS 0.4F          /* rms of a rate, as the seed's ramp: 0.25 m in 0.7 s */
#define RAMP_DRIFT_MPS2_2 0.1F /* (m/s)2 a second: half of RAMP_MPS in 0.4 s */

/* ---- shares of the scans, for each mirror */
#define STEP_UNEVEN 0.05F  /* and more where it is not */
#define RAMP_BEGINS 0.005F /* one of 200: the seed's course has one ramp in 20 s */
#define RAMP_UNEVEN 0.1F
#define RAMP_GOES_ON 0.85F /* the seed's ramp takes 7 scans, 0.7 s: 1 - 1/7 */
#define RAMP_NEXT 0.2F     /* of a mirror, where another one is on it: 0.2 m of bracket at 0.4 m/s */
#define MOVES_MOST 0.95F   /* one that stays is never impossible */

#define UNEVEN_M 0.012F   /* a difference of the grounds that shows: twice OWN_M */
#define EVEN_SHARE 0.005F /* of a scan: the mirrors' own errors are known after 20 s */
#define NO_WAY 1.0e-5F    /* a way that is less probable before the scan is not computed */

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

/* ---- one scan, while the ways are summed in which it can have come about */

typedef struct {
    uint16_t told;                                  /* bits: mirrors with a height whose ground is known */
    float off_m[MIRROR_COUNT];                      /* height less its prediction */
    float steps[MIRROR_COUNT], rises[MIRROR_COUNT]; /* probabilities before the scan */
    float variance_m2, common_m2;                   /* of the prediction; with the common noise */
    float rise_m, rise_m2;                          /* of the ramp since the scan before: mean, variance */
    /* sums, times the density of each way */
    float density, off, pull, pull_2, gain, kept, after_m2;
    float ramp, risen, risen_2;
    float on_ramp[MIRROR_COUNT], ground_m[MIRROR_COUNT];
} ways_t;

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

static float prior_of(const ways_t *w, const way_t *way)
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
static float look(const ways_t *w, const way_t *way, sight_t *sight)
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
static explained_t explain(const ways_t *w, const sight_t *sight)
{
    const float per_m2 = 1.0F / (OWN_M * OWN_M);
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

static void add_grounds(ways_t *w, const way_t *way, float density, float higher_m, float risen_m)
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
static void add_way(ways_t *w, const way_t *way)
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
    const float noise_m2 = COMMON_M * COMMON_M + OWN_M * OWN_M / at_least(sight.count, 1.0F);
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

static void add_ways(ways_t *w)
{
    for (uint16_t steps = 0U; steps <= w->told; ++steps) {
        for (uint16_t rises = 0U; rises <= w->told; ++rises) {
            if (((steps | rises) & (uint16_t)~w->told) == 0U && (steps & rises) == 0U) {
                add_way(w, &(way_t){steps, rises});
            }
        }
    }
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
static void expect(const terrain_t *terrain, ways_t *w, float gap_s)
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
static void learn(terrain_t *terrain, const ways_t *w, float gap_s)
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

static filter_merge_t merge_of(const ways_t *w)
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
    ways_t w = {.variance_m2 = variance_m2, .common_m2 = variance_m2 + COMMON_M * COMMON_M};
    terrain_shown_t shown = {.merge = {.kept = 1.0F, .variance_m2 = variance_m2}};

    w.told = heights->valid & terrain->known;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(heights->valid, m) && !has(terrain->known, m)) {
            meet(terrain, m, altitude_m - heights->height_m[m]);
        }
        w.off_m[m] = heights->height_m[m] - (altitude_m - terrain->ground_m[m]);
    }
    expect(terrain, &w, gap_s);
    add_ways(&w);
    if (w.told != 0U && w.density > 0.0F) {
        shown.merge = merge_of(&w);
        shown.innovation_m = w.off / w.density;
        learn(terrain, &w, gap_s);
    }
    shown.ground_m = middle_m(terrain, heights->valid);
    return shown;
}
