/* Theory: any text on extended Kalman filters. What breaks: a covariance that is left out. A slope that is
 * thought independent of the speed takes a part of each innovation, and then a hovering vehicle slides down a
 * ramp with it. */
#include "control/est/terrain_hypothesis.h"

#include <math.h>

#include "control/between.h"

#define OWN_M2 (TERRAIN_OWN_M * TERRAIN_OWN_M)
#define EVEN_M 0.012F /* docs/ablation.md: rms of what a ramp is off a plane, or a platform off a level */
#define LEAN_S 0.6F   /* docs/ablation.md: time constant after which a tilt no longer tells the speed */
#define BEND_2 0.1F   /* docs/ablation.md: variance of a slope, per second: ramps bend */

/* ---- one Gaussian tells two hypotheses whose means are nearer than this together */
#define ALIKE_M 0.01F    /* two heights of a mirror: TERRAIN_OWN_M times root 2 */
#define ALIKE_MPS 0.05F  /* what the filter knows of a speed between two heights: sqrt of its variance */
#define ALIKE_SLOPE 0.1F /* 10 mm between two mirrors */

void terrain_hypothesis_reset_variance(terrain_hypothesis_t *h, uint16_t state, float variance)
{
    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        h->p[state][i] = 0.0F;
        h->p[i][state] = 0.0F;
    }
    h->p[state][state] = variance;
}

/* One state changes with another by a factor: the covariance. */
static void depend(terrain_hypothesis_t *h, uint16_t state, uint16_t other, float by)
{
    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        h->p[state][i] += by * h->p[other][i];
    }
    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        h->p[i][state] += by * h->p[i][other];
    }
}

/* One state becomes itself plus `by` times another: mean and covariance. */
static void add(terrain_hypothesis_t *h, uint16_t state, uint16_t other, float by)
{
    h->x[state] += by * h->x[other];
    depend(h, state, other, by);
}

void terrain_hypothesis_predict(terrain_hypothesis_t *h, const motion_t *motion, float dt_s, float bias_mps2)
{
    add(h, TERRAIN_ALTITUDE, TERRAIN_SPEED, dt_s);
    add(h, TERRAIN_ALTITUDE, TERRAIN_BIAS, -0.5F * motion->share * dt_s * dt_s);
    add(h, TERRAIN_SPEED, TERRAIN_BIAS, -motion->share * dt_s);
    h->x[TERRAIN_ALTITUDE] += 0.5F * motion->up_mps2 * dt_s * dt_s;
    h->x[TERRAIN_SPEED] += motion->up_mps2 * dt_s;
    h->p[TERRAIN_SPEED][TERRAIN_SPEED] += motion->drift * dt_s;
    h->p[TERRAIN_BIAS][TERRAIN_BIAS] += bias_mps2 * bias_mps2 * dt_s;
}

void terrain_hypothesis_travel(terrain_hypothesis_t *h, float gained_mps, float gap_s)
{
    const float taken = at_most(gap_s / LEAN_S, 1.0F);

    add(h, TERRAIN_GROUND_SPEED, TERRAIN_GROUND_SPEED, -taken);
    h->x[TERRAIN_GROUND_SPEED] += gained_mps;
    h->p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED] += taken * (2.0F - taken) * TERRAIN_SPEED_UNTOLD_MPS *
                                                        TERRAIN_SPEED_UNTOLD_MPS;
    h->p[TERRAIN_SLOPE][TERRAIN_SLOPE] += BEND_2 * gap_s;
}

/* The variance of a product has a part that no derivative tells: that of a slope and a speed which may both
 * be anything. One that has just joined was on the ramp for an even share of the time. */
static float rise_variance_m2(const terrain_hypothesis_t *h, float passed_m, float gap_s, bool joins)
{
    const float slope = h->x[TERRAIN_SLOPE];
    const float slope_2 = h->p[TERRAIN_SLOPE][TERRAIN_SLOPE];
    const float both_m2 = slope_2 * h->p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED] * gap_s * gap_s;

    return both_m2 + (joins ? (slope * slope + slope_2) * passed_m * passed_m / 12.0F : 0.0F);
}

void terrain_hypothesis_rise(terrain_hypothesis_t *h, uint16_t ramps, float moved_m, float gap_s)
{
    const float passed_m = terrain_hypothesis_passed_m(h, moved_m, gap_s);
    const float slope = h->x[TERRAIN_SLOPE];

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool joins = (h->ramps & (1U << m)) == 0U;
        const float part = joins ? 0.5F : 1.0F;
        const uint16_t ground = terrain_ground_of(m);

        if ((ramps & (1U << m)) != 0U) {
            add(h, ground, TERRAIN_SLOPE, part * passed_m);
            depend(h, ground, TERRAIN_GROUND_SPEED, part * slope * gap_s);
            h->p[ground][ground] += rise_variance_m2(h, passed_m, gap_s, joins);
        }
    }
    h->ramps = ramps;
}

terrain_tie_t terrain_hypothesis_tie(const terrain_hypothesis_t *h, uint16_t mirror, uint16_t other,
                                     float apart_m)
{
    const uint16_t ground = terrain_ground_of(mirror);
    const bool start = other == (uint16_t)MIRROR_COUNT;
    const uint16_t second = start ? ground : terrain_ground_of(other);
    const float share = start ? 0.0F : 1.0F;
    terrain_tie_t tie = {.off_m = share * h->x[second] + apart_m * h->x[TERRAIN_SLOPE] - h->x[ground]};

    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        tie.row[i] = h->p[ground][i] - share * h->p[second][i] - apart_m * h->p[TERRAIN_SLOPE][i];
    }
    tie.variance_m2 = at_least(tie.row[ground] - share * tie.row[second] - apart_m * tie.row[TERRAIN_SLOPE],
                               0.0F) +
                      EVEN_M * EVEN_M;
    return tie;
}

/* A measurement whose covariances with the states are row: off by off, with this variance in all. */
static void correct_by(terrain_hypothesis_t *h, const float row[TERRAIN_STATES], float off_m,
                       float variance_m2)
{
    const float per_variance = 1.0F / variance_m2;

    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        const float gain = row[i] * per_variance;

        h->x[i] += gain * off_m;
        for (uint16_t j = i; j < TERRAIN_STATES; ++j) {
            h->p[i][j] -= gain * row[j];
            h->p[j][i] = h->p[i][j];
        }
    }
}

void terrain_hypothesis_bind(terrain_hypothesis_t *h, const terrain_tie_t *tie)
{
    correct_by(h, tie->row, tie->off_m, tie->variance_m2);
}

terrain_innovation_t terrain_hypothesis_innovation(const terrain_hypothesis_t *h,
                                                   const float height_m[MIRROR_COUNT])
{
    terrain_innovation_t innovation;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const uint16_t ground = terrain_ground_of(m);

        innovation.off_m[m] = height_m[m] - (h->x[TERRAIN_ALTITUDE] - h->x[ground]);
        for (uint16_t n = 0U; n < MIRROR_COUNT; ++n) {
            const uint16_t other = terrain_ground_of(n);

            innovation.covariance_m2[m][n] = h->p[TERRAIN_ALTITUDE][TERRAIN_ALTITUDE] -
                                             h->p[TERRAIN_ALTITUDE][other] - h->p[ground][TERRAIN_ALTITUDE] +
                                             h->p[ground][other];
        }
        innovation.covariance_m2[m][m] = at_least(innovation.covariance_m2[m][m], 0.0F) + OWN_M2;
    }
    return innovation;
}

/* One after the other; each corrects what is expected of those behind it. */
float terrain_innovation_density(terrain_innovation_t innovation, uint16_t set)
{
    float squares = 0.0F;
    float scale = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if ((set & (1U << m)) != 0U) {
            const float per_sum = 1.0F / innovation.covariance_m2[m][m];

            squares += innovation.off_m[m] * innovation.off_m[m] * per_sum;
            scale *= OWN_M2 * per_sum;
            for (uint16_t n = (uint16_t)(m + 1U); n < MIRROR_COUNT; ++n) {
                const float part = innovation.covariance_m2[n][m] * per_sum;

                innovation.off_m[n] -= part * innovation.off_m[m];
                for (uint16_t k = (uint16_t)(m + 1U); k < MIRROR_COUNT; ++k) {
                    innovation.covariance_m2[n][k] -= part * innovation.covariance_m2[m][k];
                }
            }
        }
    }
    return sqrtf(scale) * expf(-0.5F * squares);
}

void terrain_hypothesis_correct(terrain_hypothesis_t *h, uint16_t mirror, float height_m)
{
    const uint16_t ground = terrain_ground_of(mirror);
    const float innovation_m = height_m - (h->x[TERRAIN_ALTITUDE] - h->x[ground]);
    float row[TERRAIN_STATES];

    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        row[i] = h->p[TERRAIN_ALTITUDE][i] - h->p[ground][i];
    }
    correct_by(h, row, innovation_m, at_least(row[TERRAIN_ALTITUDE] - row[ground], 0.0F) + OWN_M2);
}

void terrain_hypothesis_meet(terrain_hypothesis_t *h, uint16_t mirror, float height_m)
{
    const uint16_t ground = terrain_ground_of(mirror);

    terrain_hypothesis_reset_variance(h, ground, 0.0F);
    h->x[ground] = -height_m;
    add(h, ground, TERRAIN_ALTITUDE, 1.0F);
    h->p[ground][ground] += OWN_M2;
}

bool terrain_hypothesis_alike(const terrain_hypothesis_t *a, const terrain_hypothesis_t *b)
{
    const float off = (a->x[TERRAIN_ALTITUDE] - b->x[TERRAIN_ALTITUDE]) / ALIKE_M;
    const float speed = (a->x[TERRAIN_SPEED] - b->x[TERRAIN_SPEED]) / ALIKE_MPS;
    const bool ramp = a->ramps != 0U;
    const float slope = ramp ? (a->x[TERRAIN_SLOPE] - b->x[TERRAIN_SLOPE]) / ALIKE_SLOPE : 0.0F;

    return a->ramps == b->ramps && (!ramp || a->oblique == b->oblique) &&
           off * off + speed * speed + slope * slope < 1.0F;
}

void terrain_hypothesis_merge(terrain_hypothesis_t *into, const terrain_hypothesis_t *other)
{
    const float share = other->share / (into->share + other->share);
    float apart[TERRAIN_STATES];

    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        apart[i] = other->x[i] - into->x[i];
        into->x[i] += share * apart[i];
    }
    for (uint16_t i = 0U; i < TERRAIN_STATES; ++i) {
        for (uint16_t j = 0U; j < TERRAIN_STATES; ++j) {
            into->p[i][j] += share * (other->p[i][j] - into->p[i][j] + (1.0F - share) * apart[i] * apart[j]);
        }
    }
    into->share += other->share;
}
