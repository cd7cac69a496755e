/* Likelihoods of one scan in each world, and Bayes' rule. The source is the multiple-model filter (Blom and
 * Bar-Shalom 1988), with one model for each set of liars, and mixtures in place of one Gaussian, because a
 * single bad scan must never decide.
 * What breaks: densities that do not integrate to one. A hypothesis whose density is too wide or too narrow
 * wins in silence, in calm air first. Rates and shares may be tuned on lies; noises never. */
#include "control/sense/belief.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

/* ---- noise models */
#define PER_MM 0.0664903801F  /* 1 / (sqrt(2 pi) BELIEF_NOISE_MM) */
#define STEP_SHARE 0.04F      /* of the scans, for each mirror: an edge passes under it */
#define STEP_MM 170.0F        /* mean size of these steps (Laplace): stairs of 170 mm, boxes, tables */
#define STEP_NEAR_SHARE 0.7F  /* of the steps: a slope begins or ends, or a small edge */
#define STEP_NEAR_MM 10.0F    /* fitted, docs/control.md */
#define STEP_FAR_SHARE 0.002F /* of the steps: as far as the scanner sees */
#define STEP_FAR_PER_MM (1.0F / 8000.0F) /* 4 m up or down */
#define ODD_SHARE 0.05F /* of a liar's scans: no constant, anything within the 4 m of the scanner */
#define ODD_PER_MM (1.0F / 4000.0F) /* the URG-04LX tells up to 4095 mm */

/* Kinds of motion. Standing, slants and heights are constants, and a liar's slant is no better explained:
 * then nobody is suspected. Else: what the shared motion of a scan is, less what the filter predicts. */
#define STANDS 0U
static const struct {
    float share, sigma_mm;
} motions[] = {
    {0.2F, 0.0F},  /* it stands */
    {0.6F, 7.0F},  /* it flies: 2.4 m/s2 that nothing has told, in 0.1 s */
    {0.2F, 20.0F}, /* a gust, a touch, a slope that begins */
};
typedef char one_line_for_each_motion[(sizeof motions / sizeof motions[0] == BELIEF_MOTIONS) ? 1 : -1];
#define MOTION_CHANGES 0.05F /* of the scans: the kind of motion is drawn anew, by its share; a second */

/* ---- rates */
#define PRIOR 1.0e-3F        /* a mirror lies at power-on */
#define LIES_PER_S 1.0e-3F   /* it begins to: once in 17 minutes, far more than a healthy bracket */
#define TOGETHER_SHARE 0.1F  /* of these: a common cause, any set at once (beta factor, IEC 61508-6) */
#define TRUTHS_PER_S 2.0e-2F /* and ends to, after 50 s */
#define LEAST 1.0e-12F       /* no world is ever impossible */

/* ---- gains of the filters: alpha and beta of Kalata 1984 for 0.5 m/s2 */
#define SHARED_GAIN 0.85F
#define RATE_GAIN 0.42F  /* beta of the same table */
#define OWN_GAIN 0.42F   /* of what one mirror shows alone: slow, it is terrain or noise */
#define MEAN_MOST 10.0F  /* scans in the mean of a slant */
#define MEAN_BREAKS 6.0F /* sigmas: it is another constant */

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

/* ---- densities */

/* What one set of honest mirrors shows without a step: n innovations, their sum and that of their squares. */
typedef struct {
    float n, sum_mm, squares_mm2;
} shown_t;

/* Normal density of these, in that of as many without motion or innovation: BELIEF_NOISE_MM each, and a
 * shared motion. With equal noises the matrix is inverted by hand (Sherman and Morrison 1950). */
static float density_of_motion(const shown_t *shown, float sigma_mm)
{
    const float noise_mm2 = BELIEF_NOISE_MM * BELIEF_NOISE_MM;
    const float all_mm2 = noise_mm2 + shown->n * sigma_mm * sigma_mm;
    const float square = shown->squares_mm2 - sigma_mm * sigma_mm * shown->sum_mm * shown->sum_mm / all_mm2;

    return expf(-0.5F * square / noise_mm2) * sqrtf(noise_mm2 / all_mm2);
}

static float density_of_step(float step_mm)
{
    return STEP_SHARE *
           ((1.0F - STEP_FAR_SHARE - STEP_NEAR_SHARE) * expf(-fabsf(step_mm) / STEP_MM) / (2.0F * STEP_MM) +
            STEP_NEAR_SHARE * expf(-fabsf(step_mm) / STEP_NEAR_MM) / (2.0F * STEP_NEAR_MM) +
            STEP_FAR_SHARE * STEP_FAR_PER_MM);
}

/* Of a value that is a constant, known as a mean. */
static float density_of_constant(float mm, const belief_mean_t *mean)
{
    const float wider = 1.0F + 1.0F / at_least(mean->count, 1.0F); /* variance, in that of the noise */
    const float off_mm = mm - mean->mm;

    return PER_MM * expf(-0.5F * off_mm * off_mm / (BELIEF_NOISE_MM * BELIEF_NOISE_MM * wider)) /
           sqrtf(wider);
}

/* Densities of one scan, by mirror, if nothing moves. */
typedef struct {
    float slant[MIRROR_COUNT], height[MIRROR_COUNT];
} constants_t;

/* ---- one world */

/* One scan in one world, while the ways are summed in which it can have come about. */
typedef struct {
    uint16_t honest;               /* bits: those that tell something in this scan */
    float off_mm[MIRROR_COUNT];    /* height less what the world predicts */
    float step[MIRROR_COUNT];      /* density of that as a step, of the honest ones */
    float density;                 /* of all ways */
    float stepped[MIRROR_COUNT];   /* of those with a step under this mirror */
    float moved_mm;                /* mean of the others' innovations, times its density */
    float motions[BELIEF_MOTIONS]; /* of those with this kind of motion */
} ways_t;

/* Adds the way in which the honest mirrors show this, times what the steps under the others cost. Returns its
 * density. */
static float add_motions(const belief_world_t *world, ways_t *ways, const shown_t *shown, float density)
{
    float sum = 0.0F;

    for (uint16_t k = STANDS + 1U; k < BELIEF_MOTIONS; ++k) {
        const float of_motion = density * world->motions[k] * density_of_motion(shown, motions[k].sigma_mm);

        ways->motions[k] += of_motion;
        sum += of_motion;
    }
    return sum;
}

/* The way in which the terrain steps under these mirrors. */
static void add_way(const belief_world_t *world, ways_t *ways, uint16_t steps)
{
    shown_t shown = {.n = 0.0F};
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(steps, m)) {
            density *= ways->step[m];
        } else if (has(ways->honest, m)) {
            density *= (1.0F - STEP_SHARE) * PER_MM;
            shown.n += 1.0F;
            shown.sum_mm += ways->off_mm[m];
            shown.squares_mm2 += ways->off_mm[m] * ways->off_mm[m];
        }
    }
    density = add_motions(world, ways, &shown, density);
    ways->density += density;
    ways->moved_mm += density * shown.sum_mm / at_least(shown.n, 1.0F);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        ways->stepped[m] += has(steps, m) ? density : 0.0F;
    }
}

/* The way in which it stands, on the ground or in calm air. */
static void add_stand(const belief_world_t *world, ways_t *ways, const constants_t *constant)
{
    float density = world->motions[STANDS];
    float sum_mm = 0.0F;
    float n = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(ways->honest, m)) {
            density *= constant->height[m];
            sum_mm += ways->off_mm[m];
            n += 1.0F;
        }
    }
    ways->density += density;
    ways->motions[STANDS] = density;
    ways->moved_mm += density * sum_mm / at_least(n, 1.0F);
}

static void predict(belief_world_t *world, float gap_s, float gained_mps)
{
    world->rate_mm_s += 1000.0F * gained_mps;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->level_mm[m] += (world->rate_mm_s - 500.0F * gained_mps) * gap_s;
    }
}

static void correct_motions(belief_world_t *world, const ways_t *ways)
{
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        world->motions[k] = MOTION_CHANGES * motions[k].share +
                            (1.0F - MOTION_CHANGES) * ways->motions[k] / ways->density;
    }
}

/* The filter follows what the honest ones share, and each mirror's own part slowly, but a step at once. */
static void correct(belief_world_t *world, const ways_t *ways, uint16_t told, float gap_s)
{
    const float shared_mm = ways->moved_mm / ways->density;

    /* A rate that nobody tells is not known: the accelerometer alone would carry it away. */
    world->rate_mm_s = (ways->honest == 0U) ? 0.0F : world->rate_mm_s + RATE_GAIN * shared_mm / gap_s;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float step = ways->stepped[m] / ways->density;
        const float moved_mm = (1.0F - step) * shared_mm;
        const float gain = OWN_GAIN + (1.0F - OWN_GAIN) * step;

        if (has(ways->honest, m)) {
            world->level_mm[m] += SHARED_GAIN * moved_mm + gain * (ways->off_mm[m] - moved_mm);
        } else if (has(told, m)) {
            world->level_mm[m] += SHARED_GAIN * ways->off_mm[m];
        }
    }
}

/* Returns the density of what the honest mirrors of this world show. */
static float world_scan(belief_world_t *world, const belief_beam_t *beams, const constants_t *constant,
                        uint16_t told, uint16_t liars, float gap_s)
{
    ways_t ways = {.honest = told & (uint16_t)~liars};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        ways.off_mm[m] = beams[m].height_mm - world->level_mm[m];
        ways.step[m] = has(ways.honest, m) ? density_of_step(ways.off_mm[m]) : 0.0F;
    }
    add_stand(world, &ways, constant);
    for (uint16_t steps = 0U; steps < BELIEF_WORLDS; ++steps) {
        if ((steps & (uint16_t)~ways.honest) == 0U) {
            add_way(world, &ways, steps);
        }
    }
    correct_motions(world, &ways);
    correct(world, &ways, told, gap_s);
    return ways.density;
}

/* ---- all worlds */

static void start(belief_t *belief)
{
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].probability = 1.0F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            belief->worlds[k].probability *= has(k, m) ? PRIOR : 1.0F - PRIOR;
        }
        for (uint16_t i = 0U; i < BELIEF_MOTIONS; ++i) {
            belief->worlds[k].motions[i] = motions[i].share;
        }
    }
}

/* One mirror begins to lie, or ends to, in this world and in that which differs by it alone. */
static void turn(belief_world_t *true_world, belief_world_t *lie_world, float gap_s)
{
    const float begins = true_world->probability * at_most(LIES_PER_S * gap_s, 0.5F);
    const float ends = lie_world->probability * at_most(TRUTHS_PER_S * gap_s, 0.5F);

    true_world->probability += ends - begins;
    lie_world->probability += begins - ends;
}

static void mix(belief_t *belief, float gap_s)
{
    belief_world_t *worlds = belief->worlds;
    const float together = worlds[0].probability * at_most(TOGETHER_SHARE * LIES_PER_S * gap_s, 0.5F);

    worlds[0].probability -= together;
    for (uint16_t k = 1U; k < BELIEF_WORLDS; ++k) {
        worlds[k].probability += together / (float)(BELIEF_WORLDS - 1U);
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
            if (!has(k, m)) {
                turn(&worlds[k], &worlds[k | (1U << m)], gap_s);
            }
        }
    }
}

/* Density of what the liars among these show. */
static float density_of_lies(const constants_t *constant, uint16_t liars)
{
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        density *= has(liars, m) ? (1.0F - ODD_SHARE) * constant->slant[m] + ODD_SHARE * ODD_PER_MM : 1.0F;
    }
    return density;
}

static void keep_mean(belief_mean_t *mean, float mm)
{
    const float off_mm = mm - mean->mm;

    if (mean->count == 0.0F || fabsf(off_mm) > MEAN_BREAKS * BELIEF_NOISE_MM) {
        *mean = (belief_mean_t){.mm = mm, .count = 1.0F};
        return;
    }
    mean->count = at_most(mean->count + 1.0F, MEAN_MOST);
    mean->mm += off_mm / mean->count;
}

/* A mirror that tells something for the first time has its level from that. */
static void meet(belief_t *belief, uint16_t mirror, float height_mm)
{
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].level_mm[mirror] = height_mm;
    }
    belief->known |= (uint16_t)(1U << mirror);
}

static void judge(belief_t *belief, const belief_beam_t *beams, uint16_t told, float gap_s, float gained_mps)
{
    constants_t constant;
    float sum = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        constant.slant[m] = density_of_constant(beams[m].slant_mm, &belief->slant[m]);
        constant.height[m] = density_of_constant(beams[m].height_mm, &belief->height[m]);
    }
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief_world_t *world = &belief->worlds[k];

        predict(world, gap_s, gained_mps);
        world->probability *= density_of_lies(&constant, told & k) *
                              world_scan(world, beams, &constant, told, k, gap_s);
        sum += world->probability;
    }
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].probability = at_least(belief->worlds[k].probability / sum, LEAST);
    }
}

void belief_scan(belief_t *belief, const belief_beam_t *beams, float gap_s, float gained_mps)
{
    uint16_t told = 0U;

    if (belief->known == 0U) {
        start(belief);
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (beams[m].valid && has(belief->known, m) && gap_s <= HEIGHT_LOST_S) {
            told |= (uint16_t)(1U << m);
        }
    }
    mix(belief, gap_s);
    judge(belief, beams, told, gap_s, gained_mps);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (beams[m].valid && !has(told, m)) {
            meet(belief, m, beams[m].height_mm);
        }
        if (beams[m].valid) {
            keep_mean(&belief->slant[m], beams[m].slant_mm);
            keep_mean(&belief->height[m], beams[m].height_mm);
        }
    }
}

float belief_of_lie(const belief_t *belief, mirror_t mirror)
{
    float sum = 0.0F;

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        sum += has(k, (uint16_t)mirror) ? belief->worlds[k].probability : 0.0F;
    }
    return sum;
}

float belief_of_two(const belief_t *belief, uint16_t mirrors)
{
    float sum = 0.0F;

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        const uint16_t honest = mirrors & (uint16_t)~k;

        sum += ((honest & (honest - 1U)) != 0U) ? belief->worlds[k].probability : 0.0F;
    }
    return sum;
}

float belief_of_none(const belief_t *belief, uint16_t mirrors)
{
    float sum = 0.0F;

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        sum += ((mirrors & (uint16_t)~k) == 0U) ? belief->worlds[k].probability : 0.0F;
    }
    return sum;
}
