/* What breaks: one Gaussian for all ways after each scan. The wrong slope carries all mirrors with it, the
 * law follows, and what it does then agrees with it. The belief about liars (sense/belief.h) is not asked: it
 * takes the one mirror that still shows level ground for blocked while two climb a ramp (0.999 in
 * simulation), because only here the motion is known. */
#include "control/est/terrain.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/est/terrain_ramp.h"
#include "control/imu_sample.h"

#define RAMP_SLOPE 0.7F /* rms, before a mirror is on it; the seed's ramp: 0.25 m over 0.28 m */

#define APART_M (3.0F * 1.41421356F * TERRAIN_OWN_M) /* three sigmas of two heights: another ground */

#define PER_OWN 66.4903801F /* 1 / (sqrt(2 pi) TERRAIN_OWN_M) */
#define NO_WAY 1.0e-3F      /* of the density of the best way: less than that is not kept */

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

void terrain_predict(terrain_t *terrain, const motion_t *motion, float dt_s, float bias_mps2)
{
    for (uint16_t i = 0U; i < terrain->count; ++i) {
        terrain_hypothesis_predict(&terrain->kept[i], motion, dt_s, bias_mps2);
    }
}

/* ---- the ways of one scan */

/* The grounds under some mirrors. */
typedef struct {
    float sum_m, low_m, high_m, count;
} grounds_t;

static grounds_t grounds_of(const float under_m[MIRROR_COUNT], uint16_t set)
{
    grounds_t grounds = {.low_m = INFINITY, .high_m = -INFINITY};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(set, m)) {
            grounds.sum_m += under_m[m];
            grounds.low_m = at_most(grounds.low_m, under_m[m]);
            grounds.high_m = at_least(grounds.high_m, under_m[m]);
            grounds.count += 1.0F;
        }
    }
    return grounds;
}

/* What the mirrors that do not rise add to the density of a way: those that step, and those that stay. As all
 * densities here it is counted in the densest that a height can have, PER_OWN: so no way is denser than its
 * share before the scan. */
static float steps_of(const float *stepped, uint16_t staying, uint16_t steps)
{
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(steps, m)) {
            density *= stepped[m];
        } else if (has(staying, m)) {
            density *= 1.0F - TERRAIN_STEP;
        }
    }
    return density;
}

/* The scan came about so. */
static void go_on(terrain_hypothesis_t *h, const terrain_heights_t *heights, const terrain_passage_t *passage,
                  uint16_t steps, const float off_m[MIRROR_COUNT])
{
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(passage->told, m) && !has(steps, m)) {
            terrain_hypothesis_correct(h, m, heights->height_m[m]);
        }
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(steps, m)) {
            terrain_hypothesis_meet(h, m, heights->height_m[m]);
        }
    }
    terrain_ramp_settle(h, passage, steps, off_m, heights->fore_m);
}

/* Among the next ones: with one that tells the same, or in a free place, or in place of the least. Returns
 * how many these are then. */
static uint16_t keep(terrain_hypothesis_t *next, uint16_t count, const terrain_hypothesis_t *way)
{
    uint16_t least = 0U;

    for (uint16_t i = 0U; i < count; ++i) {
        if (terrain_hypothesis_alike(&next[i], way)) {
            terrain_hypothesis_merge(&next[i], way);
            return count;
        }
        least = (next[i].share < next[least].share) ? i : least;
    }
    if (count < TERRAIN_KEPT) {
        next[count] = *way;
        return (uint16_t)(count + 1U);
    }
    if (next[least].share < way->share) {
        next[least] = *way;
    }
    return count;
}

/* All ways in which the same mirrors have risen. */
static uint16_t step(terrain_t *t, const terrain_heights_t *heights, const terrain_passage_t *passage,
                     uint16_t count)
{
    const terrain_innovation_t innovation = terrain_hypothesis_innovation(&t->risen, heights->height_m);
    const uint16_t staying = passage->told & (uint16_t)~t->risen.ramps;
    float stepped[MIRROR_COUNT];

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        stepped[m] = TERRAIN_STEP * expf(-fabsf(innovation.off_m[m]) / TERRAIN_STEP_M) /
                     (2.0F * TERRAIN_STEP_M * PER_OWN);
    }
    for (uint16_t steps = 0U; steps <= staying; ++steps) {
        const bool is_way = (steps & (uint16_t)~staying) == 0U;
        float density = is_way ? t->risen.share * steps_of(stepped, staying, steps) : 0.0F;

        density *= (density > NO_WAY * t->best)
                       ? terrain_innovation_density(innovation, passage->told & (uint16_t)~steps)
                       : 0.0F;
        if (density > NO_WAY * t->best) {
            t->way = t->risen;
            t->way.share = density;
            go_on(&t->way, heights, passage, steps, innovation.off_m);
            if (t->way.share > NO_WAY * t->best) { /* two of no share would be merged to no number */
                t->best = at_least(t->best, t->way.share);
                count = keep(t->next, count, &t->way);
            }
        }
    }
    return count;
}

/* All ways that go on from one hypothesis, over a ramp that is met in a row, or obliquely. */
static uint16_t branch_over(terrain_t *t, const terrain_hypothesis_t *from, const terrain_heights_t *heights,
                            const terrain_passage_t *passage, bool oblique, float gap_s, uint16_t count)
{
    const uint16_t told = heights->valid;
    const float moved_m = heights->reach_m - t->reach_m;
    const uint16_t first = (from->ramps == 0U && oblique) ? 1U : 0U; /* without a ramp it is not oblique */

    for (uint16_t rising = first; rising <= told; ++rising) {
        const bool is_way = (rising & (uint16_t)~told) == 0U;
        const float share = is_way ? from->share * terrain_ramp_prior(passage, rising, oblique) : 0.0F;

        if (share > NO_WAY * t->best) {
            t->risen = *from;
            t->risen.share = share;
            t->risen.oblique = oblique;
            terrain_hypothesis_rise(&t->risen, rising, moved_m, gap_s);
            count = step(t, heights, passage, count);
        }
    }
    return count;
}

/* All ways that go on from one hypothesis. A ramp that it is on stays what it is. */
static uint16_t branch(terrain_t *t, const terrain_hypothesis_t *from, const terrain_heights_t *heights,
                       float gap_s, uint16_t count)
{
    const bool begins = from->ramps == 0U;
    const terrain_passage_t passage = terrain_ramp_passage(from, heights->valid,
                                                           heights->reach_m - t->reach_m, gap_s);

    if (begins || !from->oblique) {
        count = branch_over(t, from, heights, &passage, false, gap_s, count);
    }
    if (begins || from->oblique) {
        count = branch_over(t, from, heights, &passage, true, gap_s, count);
    }
    return count;
}

/* Before a scan: the common noise, and the way over the ground. The next ramp may have any slope. */
static void expect(terrain_hypothesis_t *h, float gained_mps, float gap_s)
{
    h->p[TERRAIN_ALTITUDE][TERRAIN_ALTITUDE] += TERRAIN_COMMON_M * TERRAIN_COMMON_M;
    terrain_hypothesis_travel(h, gained_mps, gap_s);
    if (h->ramps == 0U) {
        h->x[TERRAIN_SLOPE] = 0.0F;
        terrain_hypothesis_reset_variance(h, TERRAIN_SLOPE, RAMP_SLOPE * RAMP_SLOPE);
    }
}

/* The tilt of this scan is that of the next one's begin. */
static void note_tilt(terrain_t *t, const terrain_heights_t *heights)
{
    t->reach_m = heights->reach_m;
    t->lean = heights->lean;
}

/* The next ones become those that are kept, where any way is possible. The most probable is the first: it
 * tells early which ways are not worth a look. */
static void take_over(terrain_t *t, uint16_t count)
{
    uint16_t first = 0U;
    float sum = 0.0F;

    for (uint16_t i = 0U; i < count; ++i) {
        sum += t->next[i].share;
        first = (t->next[i].share > t->next[first].share) ? i : first;
    }
    if (!(sum > 0.0F)) {
        return;
    }
    t->count = count;
    for (uint16_t i = 0U; i < count; ++i) {
        t->kept[i] = t->next[(first + i) % count];
        t->kept[i].share /= sum;
    }
}

/* ---- what it means */

/* The middle one of three, the mean of two. */
static float middle_m(const float under_m[MIRROR_COUNT], uint16_t set)
{
    const grounds_t grounds = grounds_of(under_m, set);

    return (grounds.count > 2.0F) ? grounds.sum_m - grounds.low_m - grounds.high_m
                                  : grounds.sum_m / grounds.count;
}

void terrain_begin(terrain_t *terrain, const filter_t *filter, const terrain_heights_t *heights,
                   float altitude_m, float ground_m)
{
    terrain_hypothesis_t *const first = &terrain->kept[0];

    if (terrain->count != 0U) {
        return;
    }
    terrain->count = 1U;
    note_tilt(terrain, heights);
    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        terrain_hypothesis_reset_variance(first, i, 0.0F);
        first->x[i] = 0.0F;
    }
    first->share = 1.0F;
    first->ramps = 0U;
    first->oblique = false;
    first->x[TERRAIN_ALTITUDE] = altitude_m;
    first->x[TERRAIN_SPEED] = filter->estimate.speed_mps;
    first->x[TERRAIN_BIAS] = filter->estimate.bias_mps2;
    for (uint16_t i = 0U; i <= (uint16_t)TERRAIN_BIAS; ++i) {
        first->p[i][i] = filter->covariance[i][i];
    }
    first->p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED] = TERRAIN_SPEED_UNTOLD_MPS *
                                                           TERRAIN_SPEED_UNTOLD_MPS;
    const float middle_height_m = middle_m(heights->height_m, heights->valid);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool tells = has(heights->valid, m);
        const float apart_m = tells ? middle_height_m - heights->height_m[m] : 0.0F;
        const float sigma_m = tells ? TERRAIN_OWN_M : TERRAIN_STEP_M;
        const uint16_t ground = terrain_ground_of(m);

        first->x[ground] = ground_m + ((fabsf(apart_m) > APART_M) ? apart_m : 0.0F);
        first->p[ground][ground] = sigma_m * sigma_m;
    }
}

terrain_shown_t terrain_scan(terrain_t *t, const terrain_heights_t *heights, float gap_s)
{
    const float gained_mps = -IMU_GRAVITY_MPS2 * 0.5F * (t->lean + heights->lean) * gap_s;
    uint16_t count = 0U;

    t->best = 0.0F;
    for (uint16_t i = 0U; i < t->count; ++i) {
        expect(&t->kept[i], gained_mps, gap_s);
    }
    for (uint16_t i = 0U; i < t->count; ++i) {
        count = branch(t, &t->kept[i], heights, gap_s, count);
    }
    take_over(t, count);
    note_tilt(t, heights);
    t->way = t->kept[0];
    for (uint16_t i = 1U; i < t->count; ++i) {
        terrain_hypothesis_merge(&t->way, &t->kept[i]);
    }
    return (terrain_shown_t){
        .altitude_m = t->way.x[TERRAIN_ALTITUDE],
        .speed_mps = t->way.x[TERRAIN_SPEED],
        .bias_mps2 = t->way.x[TERRAIN_BIAS],
        .speed_variance = t->way.p[TERRAIN_SPEED][TERRAIN_SPEED],
        .bias_variance = t->way.p[TERRAIN_BIAS][TERRAIN_BIAS],
        .ground_m = middle_m(&t->way.x[TERRAIN_GROUND], heights->valid),
    };
}
