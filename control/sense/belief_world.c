/* Likelihood of one scan in one world, and the filter of that world. Mixtures stand in place of one Gaussian,
 * because a single bad scan must never decide: a step of the terrain, kinds of motion, an accelerometer that
 * lies. All ways are summed in which the scan can have come about.
 * What breaks: densities that do not integrate to one. A hypothesis whose density is too wide or too narrow
 * wins in silence, in calm air first. Shares may be tuned on lies; noises never. */
#include "control/sense/belief_world.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/where/hover_thrust.h"

/* ---- noise models */
#define ODD_SHARE 0.05F           /* of a liar's scans: no constant, anything within the 4 m of the scanner */
#define SHARED_MM BELIEF_NOISE_MM /* of a noise that all mirrors share, in what is constant but for it */
#define FROZEN_SHARE 0.5F         /* of the lies that begin a scan freezes; else something comes: not known */
#define ODD_PER_MM (1.0F / 4000.0F) /* the URG-04LX tells up to 4095 mm */

/* Kinds of motion. Standing, slants and heights are constants, and a liar's slant is no better explained:
 * then nobody is suspected. Else: what the shared motion of a scan is, less what the filter predicts. */
static const struct {
    float share, sigma_mm;
} motions[] = {
    {0.2F, 0.0F},    /* it stands */
    {0.3F, 3.0F},    /* it flies in calm air, as the accelerometer tells */
    {0.196F, 20.0F}, /* a gust, a touch, a slope that begins */
    {0.3F, 7.0F},    /* it flies: 2.4 m/s2 that nothing has told, in 0.1 s */
    {0.002F, 7.0F},  /* the same, and the thrust has no effect; or it hangs still, see add_stand() */
    {0.002F, 7.0F},  /* any of these, it stands too, and the thrust tells it, not the accelerometer */
};
typedef char one_line_for_each_motion[(sizeof motions / sizeof motions[0] == BELIEF_MOTIONS) ? 1 : -1];
#define MOTION_CHANGES 0.05F /* of the scans: the kind of motion is drawn anew, by its share; a second */
#define PUSHED_SHARE 0.2F /* chosen: of the scans in which the accelerometer lies; about as of the others */

#define UNDELIVERED_SHARE 0.29F /* rms error of LAG, on the vehicles of plan.py: so unsure is that part */
#define LIE_PER_MPS2 0.0254930F /* 1 / 4 g: the Razor's ADXL345 is set to 2 g each way */

/* ---- gains of the filters: alpha and beta of Kalata 1984 for 0.5 m/s2 */
#define SHARED_GAIN 0.85F
#define PUSH_GAIN (SCAN_S / HOVER_TIME_S) /* what the hover thrust is off by is learned as in push.c */
/* GRAV of a vehicle whose mass is off by 20 %, as tools/campaign/plan.py draws */
#define PUSH_OFF_MPS2 2.0F
#define BLIND_GAIN 0.03F /* chosen: s; the drag tells the speed in 1.4 s, once the thrust is known */
#define OWN_GAIN 0.42F   /* of what one mirror shows alone: slow, it is terrain or noise */

/* ---- densities */

/* What a set of mirrors shows: n innovations, their sum and that of their squares. */
typedef struct {
    uint16_t n;
    float sum_mm, squares_mm2;
    float density; /* of their noise, if no innovation were there */
} shown_t;

static shown_t shown_by(uint16_t mirrors, const float off_mm[MIRROR_COUNT])
{
    shown_t shown = {.density = 1.0F};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (belief_has(mirrors, m)) {
            ++shown.n;
            shown.sum_mm += off_mm[m];
            shown.squares_mm2 += off_mm[m] * off_mm[m];
            shown.density *= PER_MM;
        }
    }
    return shown;
}

/* ---- one world */

/* One scan in one world, while the ways are summed in which it can have come about. */
typedef struct {
    uint16_t honest;            /* bits: those that tell something in this scan */
    uint16_t count;             /* of these */
    float off_mm[MIRROR_COUNT]; /* height less what the world predicts */
    float step[MIRROR_COUNT];   /* density of that as a step, of the honest ones */
    float gained_mps;           /* change of the speed that is foretold */
    float strange_mps2; /* the accelerometer, less thrust and drag at the speed of this world, as it knows
                           them */
    float kinds[BELIEF_MOTIONS];   /* of what the accelerometer tells, with that kind of motion */
    bool aloft;                    /* its honest mirrors show air below it, and the accelerometer is heard */
    float hangs;                   /* of the same, if it stands still there, and something holds it */
    float way_mm;                  /* that the world predicts */
    float untrue_mps;              /* part of what the accelerometer tells that is not so, if it lies */
    float foretold_mm;             /* way that it has foretold then */
    float density;                 /* of all ways */
    float no_step;                 /* of those without a step under most of the honest ones */
    float still;                   /* of those in which it does not move */
    float stepped[MIRROR_COUNT];   /* of those with a step under this mirror */
    float moved_mm;                /* mean of the others' innovations, times its density */
    float motions[BELIEF_MOTIONS]; /* of those with this kind of motion */
} ways_t;

/* If the accelerometer lies, the way that it has foretold was not flown: it flies as the thrust tells, or
 * something pushes it. */
static float density_of_untold(const shown_t *shown, float foretold_mm, const belief_motion_t *motion,
                               float pushed)
{
    const float moved_mm = (float)shown->n * foretold_mm;
    const float sum_mm = shown->sum_mm + moved_mm;
    const float squares_mm2 = shown->squares_mm2 + foretold_mm * (sum_mm + shown->sum_mm);
    const float flies = density_of_motion(sum_mm, squares_mm2, &motion[BELIEF_FELT_LIES]);

    return flies + pushed * (density_of_motion(sum_mm, squares_mm2, &motion[BELIEF_PUSHED]) - flies);
}

/* Adds the way in which the honest mirrors show this, times what the steps under the others cost. Returns its
 * density. */
static float add_motions(ways_t *ways, const belief_motion_t *motion, const shown_t *shown, float density)
{
    float lies = density * ways->kinds[BELIEF_FELT_LIES] * (1.0F - motions[BELIEF_STANDS].share);
    float sum = 0.0F;
    float of_heights = density;

    for (uint16_t k = BELIEF_STANDS + 1U; k < BELIEF_FELT_LIES; ++k) {
        if (shown->n > 0U && k != BELIEF_HELD) { /* it moves as the kind before */
            of_heights = density * density_of_motion(shown->sum_mm, shown->squares_mm2, &motion[k]);
        }
        const float of_motion = of_heights * ways->kinds[k];

        ways->motions[k] += of_motion;
        sum += of_motion;
    }
    if (shown->n > 0U) { /* else nothing tells the motion */
        lies *= density_of_untold(shown, ways->foretold_mm, motion,
                                  belief_has_several(ways->honest) ? PUSHED_SHARE : 1.0F);
        ways->moved_mm += (sum + lies) * shown->sum_mm / (float)shown->n + lies * ways->foretold_mm;
    }
    ways->motions[BELIEF_FELT_LIES] += lies;
    return sum + lies;
}

/* The way in which the terrain steps under these mirrors. */
static void add_way(ways_t *ways, const belief_scan_t *scan, uint16_t steps)
{
    const shown_t shown = shown_by(ways->honest & (uint16_t)~steps, ways->off_mm);
    float density = shown.density;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        density *= belief_has(steps, m)          ? ways->step[m]
                   : belief_has(ways->honest, m) ? 1.0F - STEP_SHARE
                                                 : 1.0F;
    }
    density = add_motions(ways, scan->motion[(shown.n > 0U) ? shown.n - 1U : 0U], &shown, density);
    ways->density += density;
    ways->no_step += (2U * shown.n > ways->count) ? density : 0.0F;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        ways->stepped[m] += belief_has(steps, m) ? density : 0.0F;
    }
}

/* Density of constants that share one noise. off_mm: from what each repeats. Where one noise is shared and
 * where each has its own is not known: both are as likely, of what lies and of what stands. */
static float density_of_shared(const float off_mm[MIRROR_COUNT], uint16_t mirrors)
{
    const shown_t shown = shown_by(mirrors, off_mm);
    const belief_motion_t motion = motion_of(shown.n, SHARED_MM);

    return shown.density * density_of_motion(shown.sum_mm, shown.squares_mm2, &motion);
}

/* The way in which it stands, on the ground or in calm air; or hangs, in a share of the scans as of those
 * that stand. */
static void add_stand(ways_t *ways, const belief_scan_t *scan)
{
    const float sound = ways->kinds[BELIEF_STANDS];
    const float hangs = ways->hangs;
    const float lies = ways->kinds[BELIEF_FELT_LIES] * motions[BELIEF_STANDS].share;
    const shown_t shown = shown_by(ways->honest, ways->off_mm);
    float density = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        density *= belief_has(ways->honest, m) ? scan->height[m] : 1.0F;
    }
    if (belief_has_several(ways->honest)) {
        density = 0.5F * (density + density_of_shared(scan->height_off_mm, ways->honest));
    }
    ways->count = shown.n;
    ways->still = (sound + hangs + lies) * density;
    ways->density += ways->still;
    ways->motions[BELIEF_STANDS] = sound * density;
    ways->motions[BELIEF_HELD] = hangs * density;
    ways->motions[BELIEF_FELT_LIES] = lies * density;
    ways->moved_mm += density * ((sound + hangs + lies) * shown.sum_mm / at_least((float)shown.n, 1.0F) +
                                 lies * ways->foretold_mm);
}

/* By the honest mirrors, at least one. */
static float height_of(const belief_world_t *world, uint16_t honest)
{
    float sum_mm = 0.0F;
    float count = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        sum_mm += belief_has(honest, m) ? world->level_mm[m] : 0.0F;
        count += belief_has(honest, m) ? 1.0F : 0.0F;
    }
    return sum_mm / count;
}

/* No vehicle stands that its thrust lifts. Nor does one whose honest mirrors show air below it, and whose
 * thrust is too small: it would sink, or something holds it. Where nothing tells whether it sinks, that would
 * be a guess. */
static void stand(const belief_world_t *world, ways_t *ways, const belief_scan_t *scan)
{
    const float gained_mps2 = scan->felt.untold ? 0.0F : scan->felt.gained_mps / scan->gap_s;
    const float lift_mps2 = scan->felt.pushed_mps / scan->gap_s;
    const float scale_mps2 = (ways->honest == 0U) ? REST_MPS2 : STRANGE_MPS2;
    const float still = density_of_strange(gained_mps2, scale_mps2) / density_of_strange(0.0F, scale_mps2);
    const float carried = still * density_of_strange(at_least(lift_mps2, 0.0F), STRANGE_MPS2);

    ways->aloft = ways->honest != 0U && height_of(world, ways->honest) > LOW_MM && !scan->felt.untold;
    ways->kinds[BELIEF_STANDS] = ways->aloft ? still * density_of_strange(lift_mps2, STRANGE_MPS2) : carried;
    ways->hangs = ways->aloft ? carried : 0.0F;
}

/* What the accelerometer tells beyond the thrust depends on the speed, by the drag: a world in which the
 * vehicle climbs fast, and its mirrors do not show it, is contradicted for as long as that lasts. */
static void feel(const belief_world_t *world, ways_t *ways, const belief_scan_t *scan)
{
    const belief_felt_t *felt = &scan->felt;
    const float off_mps = (felt->dragged > 0.0F) ? world->push_off_mps2 * scan->gap_s : 0.0F;
    const float rate_mps = 0.001F * world->rate_mm_s;
    const float half = 0.5F * felt->dragged; /* speed that is gained meanwhile is dragged half as long */
    const float thrust_mps = (felt->pushed_mps + off_mps - felt->dragged * rate_mps) / (1.0F + half);

    ways->gained_mps = felt->untold ? thrust_mps : felt->gained_mps;
    ways->strange_mps2 = (1.0F + half) * (ways->gained_mps - thrust_mps) / scan->gap_s;
    const float moving = density_of_strange(ways->strange_mps2, scan->strange_mps2);
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        ways->kinds[k] = moving;
    }
    stand(world, ways, scan);
    /* Where the thrust foretells, it is not tried whether it lies too: that would explain all. */
    ways->kinds[BELIEF_HELD] = felt->untold
                                   ? 0.0F
                                   : density_of_strange(felt->gained_mps / scan->gap_s, STRANGE_MPS2);
    ways->kinds[BELIEF_FELT_LIES] = LIE_PER_MPS2;
    /* If it lies, or tells nothing, the thrust foretells the motion. */
    ways->untrue_mps = ways->strange_mps2 * scan->gap_s;
    ways->foretold_mm = 500.0F * ways->untrue_mps * scan->gap_s;
}

/* The kinds of motion before the scan. push_ends: probability that a push is over. One that the accelerometer
 * does not tell is a touch, or a rate that changes: over after one scan. */
static void draw_motion(belief_world_t *world, float push_ends)
{
    const float ended = (push_ends - MOTION_CHANGES) * world->motions[BELIEF_PUSHED];
    const float anew = MOTION_CHANGES + ended;

    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        world->motions[k] += anew * motions[k].share - MOTION_CHANGES * world->motions[k];
    }
    world->motions[BELIEF_PUSHED] -= ended;
}

/* Of a vehicle that moves now, the share that moved before the scan: what has just left the ground has no
 * speed. */
static float moved_before(const belief_world_t *world)
{
    const float stood = world->motions[BELIEF_STANDS];
    const float left = stood * MOTION_CHANGES * (1.0F - motions[BELIEF_STANDS].share);
    const float moves_on = (1.0F - stood) * (1.0F - MOTION_CHANGES * motions[BELIEF_STANDS].share);

    return moves_on / (moves_on + left);
}

static void predict(belief_world_t *world, ways_t *ways, const belief_scan_t *scan)
{
    const float gained_mm_s = 1000.0F * ways->gained_mps;
    /* a gust; or with one mirror alone, which would else lie whenever the accelerometer is off a little */
    const bool push_lasts = scan->felt.untold || !belief_has_several(ways->honest);

    if (ways->honest == 0U) {
        world->rate_mm_s *= moved_before(world);
    }
    ways->way_mm = (world->rate_mm_s + 0.5F * gained_mm_s) * scan->gap_s;
    world->rate_mm_s += gained_mm_s;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->level_mm[m] += ways->way_mm;
    }
    draw_motion(world, push_lasts ? MOTION_CHANGES : 1.0F);
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        ways->kinds[k] *= world->motions[k];
    }
    ways->hangs *= world->motions[BELIEF_HELD] * motions[BELIEF_STANDS].share;
    ways->kinds[BELIEF_HELD] *= ways->aloft ? 1.0F - motions[BELIEF_STANDS].share : 1.0F;
}

/* As probably as the accelerometer lies, what it has foretold is taken back. */
static void take_back(belief_world_t *world, ways_t *ways)
{
    const float lies = ways->motions[BELIEF_FELT_LIES] / ways->density;
    const float foretold_mm = ways->foretold_mm * lies;

    world->rate_mm_s -= 1000.0F * ways->untrue_mps * lies;
    ways->way_mm -= foretold_mm;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->level_mm[m] -= foretold_mm;
        ways->off_mm[m] += foretold_mm;
    }
}

static void correct_motions(belief_world_t *world, const ways_t *ways)
{
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        world->motions[k] = ways->motions[k] / ways->density;
    }
}

/* The heights tell the rate, and what the thrust is off by is learned at it, from the accelerometer or from
 * them. Where none tells it, the accelerometer does, and the thrust by its drag: the more, the better the
 * thrust is known. */
static void correct_rate(belief_world_t *world, const ways_t *ways, const belief_scan_t *scan,
                         float shared_mm)
{
    /* A load is learned too where it first looks like a thrust without effect: that parts it from a pilot. */
    const float flies = 1.0F -
                        (ways->motions[BELIEF_STANDS] + ways->motions[BELIEF_FELT_LIES]) / ways->density;
    const bool carried = scan->felt.dragged > 0.0F;

    if (ways->honest != 0U) {
        const float more_mm_s = BELIEF_RATE_GAIN * shared_mm / scan->gap_s;
        const float felt_mps2 = scan->felt.untold ? 0.001F * more_mm_s / scan->gap_s : ways->strange_mps2;
        const float off_mps2 = world->push_off_mps2 + PUSH_GAIN * flies * felt_mps2;

        world->rate_mm_s += more_mm_s;
        world->push_known += carried ? PUSH_GAIN * flies * (1.0F - world->push_known) : 0.0F;
        world->push_off_mps2 = carried ? between(-PUSH_OFF_MPS2, off_mps2, PUSH_OFF_MPS2)
                                       : world->push_off_mps2;
    } else if (carried) {
        const float unknown_mps2 = PUSH_OFF_MPS2 * (1.0F - world->push_known);
        const float sure = STRANGE_MPS2 * STRANGE_MPS2 / variance(STRANGE_MPS2, unknown_mps2);
        const float untrue = ways->motions[BELIEF_FELT_LIES] / ways->density; /* taken back already */

        world->rate_mm_s -= 1000.0F * BLIND_GAIN * sure * (1.0F - untrue) * ways->strange_mps2;
    }
}

/* What it has flown, where no mirror tells it. */
static void correct_height(belief_world_t *world, const ways_t *ways)
{
    const float moves = 1.0F - ways->motions[BELIEF_STANDS] / ways->density;

    world->height_mm = (ways->honest != 0U)
                           ? height_of(world, ways->honest)
                           : between(0.0F, world->height_mm + moves * ways->way_mm, HEIGHT_MAX_MM);
}

/* The filter follows what the honest ones share, and each mirror's own part slowly, but a step at once. */
static void correct(belief_world_t *world, const ways_t *ways, const belief_scan_t *scan)
{
    const float shared_mm = ways->moved_mm / ways->density;

    correct_rate(world, ways, scan, shared_mm);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float step = ways->stepped[m] / ways->density;
        const float moved_mm = (1.0F - step) * shared_mm;
        const float gain = OWN_GAIN + (1.0F - OWN_GAIN) * step;

        if (belief_has(ways->honest, m)) {
            world->level_mm[m] += SHARED_GAIN * moved_mm + gain * (ways->off_mm[m] - moved_mm);
        } else if (belief_has(scan->told, m)) {
            world->level_mm[m] += SHARED_GAIN * ways->off_mm[m];
        } else {
            world->level_mm[m] += SHARED_GAIN * shared_mm;
        }
    }
    correct_height(world, ways);
}

/* Density of what the liars show. What has just come before a mirror stands anywhere, unless the mirror has
 * frozen. liars: those that tell something. */
static float density_of_lies(const belief_world_t *world, const belief_scan_t *scan, uint16_t liars)
{
    float own = 1.0F;
    float stay = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float odd = ODD_SHARE + (1.0F - FROZEN_SHARE - ODD_SHARE) * world->begun[m];

        if (belief_has(liars, m)) {
            own *= (1.0F - odd) * scan->slant[m] + odd * ODD_PER_MM;
            stay *= 1.0F - odd;
        }
    }
    return belief_has_several(liars) ? 0.5F * (own + stay * density_of_shared(scan->slant_off_mm, liars))
                                     : own;
}

float belief_world_scan(belief_world_t *world, const belief_scan_t *scan, uint16_t liars)
{
    ways_t ways = {.honest = scan->told & (uint16_t)~liars};

    feel(world, &ways, scan);
    predict(world, &ways, scan);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        ways.off_mm[m] = scan->beams[m].height_mm - world->level_mm[m];
        ways.step[m] = belief_has(ways.honest, m) ? density_of_step(ways.off_mm[m]) : 0.0F;
    }
    add_stand(&ways, scan);
    for (uint16_t steps = 0U; steps <= ways.honest; ++steps) {
        if ((steps & (uint16_t)~ways.honest) == 0U) {
            add_way(&ways, scan, steps);
        }
    }
    take_back(world, &ways);
    correct_motions(world, &ways);
    correct(world, &ways, scan);
    world->no_step = ways.no_step / ways.density;
    world->still = ways.still / ways.density;
    return ways.density * density_of_lies(world, scan, scan->told & liars);
}

void belief_world_loosen(belief_motion_t motion[MIRROR_COUNT][BELIEF_MOTIONS], float loose)
{
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        for (uint16_t n = 1U; n <= MIRROR_COUNT; ++n) {
            motion[n - 1U][k] = motion_of(n, motions[k].sigma_mm * loose);
        }
    }
}

void belief_world_look(belief_scan_t *scan, const belief_mean_t *slant, const belief_mean_t *height)
{
    const float undelivered_mps2 = UNDELIVERED_SHARE * scan->felt.undelivered_mps / scan->gap_s;

    scan->strange_mps2 = sqrtf(variance(STRANGE_MPS2, undelivered_mps2));
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (belief_has(scan->told, m)) {
            scan->slant_off_mm[m] = scan->beams[m].slant_mm - slant[m].mm;
            scan->height_off_mm[m] = scan->beams[m].height_mm - height[m].mm;
            scan->slant[m] = density_of_constant(scan->beams[m].slant_mm, slant[m].mm, slant[m].count);
            scan->height[m] = density_of_constant(scan->beams[m].height_mm, height[m].mm, height[m].count);
        }
    }
}

void belief_world_start(belief_world_t *world)
{
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; ++k) {
        world->motions[k] = motions[k].share;
    }
}
