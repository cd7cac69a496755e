/* What breaks: a direction that is wrong. A tilt that is off by three degrees makes 0.3 m/s of
 * ground speed; so the direction is a probability, and both are looked at. Without an order "all mirrors
 * rise" explains a vehicle that sinks too: an oblique ramp may be that. There terrain_keep.c stops it above
 * the ground. */
#include "control/est/terrain_ramp.h"

#include <float.h>
#include <math.h>

#include "control/between.h"

/* ---- shares of the scans */
#define BEGINS 0.005F    /* one of 200: the seed's course has one ramp in 20 s */
#define GOES_ON 0.85F    /* the seed's ramp takes 7 scans, 0.7 s: 1 - 1/7 */
#define FOLLOWS 0.3F     /* a spot is 0.11 m behind another: at the seed's 0.4 m/s, three scans */
#define START_SHARE 0.5F /* of the grounds that it comes down to; the rest is any */
#define OBLIQUE 0.5F     /* docs/ablation.md: of the ramps, those that are met in no row */

/* docs/ablation.md: density of a ground where no plane and no level is known, of the densest where one is */
#define ANY_GROUND 0.5F

#define LOGISTIC 1.702F   /* the normal distribution function by a logistic one, within 0.01 (Haley 1952) */
#define SIGMAS_MOST 20.0F /* expf() */
#define PER_ROOT_TWO_PI 0.398942280F /* 1 / sqrt(2 pi) */

typedef enum { NOSE_FIRST, TAIL_FIRST } heading_t;

/* The mirrors, the leading one first. */
static const uint16_t rows[][MIRROR_COUNT] = {
    [NOSE_FIRST] = {MIRROR_FORE, MIRROR_FRONT, MIRROR_AFT},
    [TAIL_FIRST] = {MIRROR_AFT, MIRROR_FRONT, MIRROR_FORE},
};

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

terrain_passage_t terrain_ramp_passage(const terrain_hypothesis_t *h, uint16_t told, float moved_m,
                                       float gap_s)
{
    const float sigma_mps = sqrtf(at_least(h->p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED], FLT_EPSILON));
    const float sigmas = terrain_hypothesis_passed_m(h, moved_m, gap_s) / (gap_s * sigma_mps);

    return (terrain_passage_t){
        .ramps = h->ramps,
        .told = told,
        .fore = 1.0F / (1.0F + expf(-LOGISTIC * between(-SIGMAS_MOST, sigmas, SIGMAS_MOST))),
    };
}

/* Of a mirror behind another, or of the leading one: lead is MIRROR_COUNT then. */
static float rises(const terrain_passage_t *passage, uint16_t mirror, uint16_t lead)
{
    const bool leads = lead == (uint16_t)MIRROR_COUNT;

    if (has(passage->ramps, mirror)) {
        return leads ? GOES_ON : (has(passage->ramps, lead) ? 1.0F - BEGINS : 1.0F - FOLLOWS);
    }
    return (!leads && has(passage->ramps, lead)) ? FOLLOWS : BEGINS;
}

static float prior_of_row(const terrain_passage_t *passage, uint16_t rising, const uint16_t *row)
{
    uint16_t lead = MIRROR_COUNT;
    float share = 1.0F;

    for (uint16_t place = 0U; place < MIRROR_COUNT; ++place) {
        const uint16_t mirror = row[place];

        if (has(passage->told, mirror)) {
            const float probability = rises(passage, mirror, lead);

            share *= has(rising, mirror) ? probability : 1.0F - probability;
            lead = mirror;
        }
    }
    return share;
}

static float prior_in_a_row(const terrain_passage_t *passage, uint16_t rising)
{
    return passage->fore * prior_of_row(passage, rising, rows[NOSE_FIRST]) +
           (1.0F - passage->fore) * prior_of_row(passage, rising, rows[TAIL_FIRST]);
}

/* One mirror or another meets the ramp first, and then each joins and leaves it for itself. */
static float prior_oblique(const terrain_passage_t *passage, uint16_t rising)
{
    const float joins = (passage->ramps != 0U) ? FOLLOWS : BEGINS;
    float share = 1.0F;

    for (uint16_t mirror = 0U; mirror < MIRROR_COUNT; ++mirror) {
        if (has(passage->told, mirror)) {
            const float probability = has(passage->ramps, mirror) ? GOES_ON : joins;

            share *= has(rising, mirror) ? probability : 1.0F - probability;
        }
    }
    return share;
}

float terrain_ramp_prior(const terrain_passage_t *passage, uint16_t rising, bool oblique)
{
    const bool begins = passage->ramps == 0U && rising != 0U;
    const float share = begins ? (oblique ? OBLIQUE : 1.0F - OBLIQUE) : 1.0F;

    return share * (oblique ? prior_oblique(passage, rising) : prior_in_a_row(passage, rising));
}

/* ---- after the scan */

static float surprise(const terrain_tie_t *tie)
{
    return expf(-0.5F * tie->off_m * tie->off_m / tie->variance_m2);
}

/* Those on the ramp are on one plane. What joins it there is evidence; those that stay on it are on it by
 * what a ramp is. */
static void bind_plane(terrain_hypothesis_t *h, const terrain_passage_t *passage, const uint16_t *row,
                       const float fore_m[MIRROR_COUNT])
{
    uint16_t last = MIRROR_COUNT;

    for (uint16_t place = MIRROR_COUNT; place > 0U; --place) {
        const uint16_t mirror = row[place - 1U];

        if (!has(h->ramps, mirror)) {
            continue;
        }
        if (last != (uint16_t)MIRROR_COUNT) {
            const terrain_tie_t tie = terrain_hypothesis_tie(h, mirror, last, fore_m[mirror] - fore_m[last]);

            h->share *= (has(passage->ramps, mirror) && has(passage->ramps, last)) ? 1.0F : surprise(&tie);
            terrain_hypothesis_bind(h, &tie);
        } else {
            last = mirror;
        }
    }
}

static void bind_level(terrain_hypothesis_t *h, uint16_t mirror, uint16_t lead)
{
    const terrain_tie_t tie = terrain_hypothesis_tie(h, mirror, lead, 0.0F);

    h->share *= surprise(&tie);
    terrain_hypothesis_bind(h, &tie);
}

/* off_m: by what it has stepped, or stands above the start; any ground is as probable by that (Laplace). */
static void bind_start(terrain_hypothesis_t *h, uint16_t mirror, float off_m)
{
    const terrain_tie_t tie = terrain_hypothesis_tie(h, mirror, MIRROR_COUNT, 0.0F);
    const float any = expf(-fabsf(off_m) / TERRAIN_STEP_M) / (2.0F * TERRAIN_STEP_M);
    const float odds = START_SHARE / (1.0F - START_SHARE) * PER_ROOT_TWO_PI * surprise(&tie) /
                       (sqrtf(tie.variance_m2) * any);

    h->share *= (1.0F - START_SHARE) * (1.0F + odds);
    if (odds > 1.0F) {
        terrain_hypothesis_bind(h, &tie);
    }
}

/* The leading mirror. left: have left a ramp, downhill. */
static void come_down(terrain_hypothesis_t *h, uint16_t mirror, uint16_t steps, uint16_t left,
                      const float off_m[MIRROR_COUNT])
{
    if (has(steps, mirror) && off_m[mirror] > 0.0F) {
        bind_start(h, mirror, off_m[mirror]);
    } else if (has(left, mirror)) {
        bind_start(h, mirror, h->x[terrain_ground_of(mirror)]);
    }
}

static void settle_in_a_row(terrain_hypothesis_t *h, const terrain_passage_t *passage, uint16_t steps,
                            uint16_t left, const float off_m[MIRROR_COUNT], const float fore_m[MIRROR_COUNT])
{
    const bool nose_first = passage->fore > 0.5F;
    const uint16_t *row = rows[nose_first ? NOSE_FIRST : TAIL_FIRST];
    const bool downhill = nose_first == (h->x[TERRAIN_SLOPE] < 0.0F);

    uint16_t lead = MIRROR_COUNT;

    bind_plane(h, passage, row, fore_m);
    for (uint16_t place = 0U; place < MIRROR_COUNT; ++place) {
        const uint16_t mirror = row[place];

        if (!has(passage->told, mirror)) {
            continue;
        }
        if (lead == (uint16_t)MIRROR_COUNT) {
            come_down(h, mirror, steps, downhill ? left : 0U, off_m);
        } else if (has(left, mirror) && !has(h->ramps, lead)) {
            bind_level(h, mirror, lead);
        }
        lead = mirror;
    }
}

/* Whatever joins those on the ramp, or leaves it, stands anywhere. */
static void settle_oblique(terrain_hypothesis_t *h, const terrain_passage_t *passage, uint16_t left)
{
    const uint16_t joined = (passage->ramps != 0U) ? h->ramps & (uint16_t)~passage->ramps : 0U;

    for (uint16_t mirror = 0U; mirror < MIRROR_COUNT; ++mirror) {
        h->share *= has(joined | left, mirror) ? ANY_GROUND : 1.0F;
    }
}

void terrain_ramp_settle(terrain_hypothesis_t *h, const terrain_passage_t *passage, uint16_t steps,
                         const float off_m[MIRROR_COUNT], const float fore_m[MIRROR_COUNT])
{
    const uint16_t left = passage->ramps & passage->told & (uint16_t) ~(h->ramps | steps);

    if (h->oblique) {
        settle_oblique(h, passage, left);
    } else {
        settle_in_a_row(h, passage, steps, left, off_m, fore_m);
    }
}
