/* Bayes' rule over the worlds of belief_world.c. The source is the multiple-model filter (Blom and Bar-Shalom
 * 1988), with one model for each set of liars. Between two scans a mirror may begin to lie, or end to. */
#include "control/sense/belief.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

#define PRIOR 1.0e-3F        /* a mirror lies at power-on */
#define LIES_PER_S 1.0e-4F   /* it begins to: once in three hours of flight */
#define TOGETHER_SHARE 0.1F  /* of these: a common cause, any set at once (beta factor, IEC 61508-6) */
#define BETWEEN_RAYS 0.25F   /* of a scan's time: two mirrors are 256 steps of 1024 apart, docs/hardware.md */
#define TRUTHS_PER_S 2.0e-2F /* and ends to, after 50 s */
#define LEAST 1.0e-12F       /* no world is ever impossible */

#define MEAN_MOST 10.0F  /* scans in the mean of a slant */
#define MEAN_BREAKS 3.0F /* sigmas: it is another constant */

static void start(belief_t *belief)
{
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].probability = 1.0F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            belief->worlds[k].probability *= belief_has(k, m) ? PRIOR : 1.0F - PRIOR;
        }
        belief->worlds[k].probability += (k != 0U) ? TOGETHER_SHARE * PRIOR / (float)(BELIEF_WORLDS - 1U)
                                                   : -TOGETHER_SHARE * PRIOR;
        belief_world_start(&belief->worlds[k]);
    }
}

/* So much of a world's probability has just come from another: its motion is, too. */
static void take_motion(belief_world_t *world, const belief_world_t *other, float share)
{
    world->rate_mm_s += share * (other->rate_mm_s - world->rate_mm_s);
    world->push_off_mps2 += share * (other->push_off_mps2 - world->push_off_mps2);
    world->push_known += share * (other->push_known - world->push_known);
}

/* What has just begun to lie goes on from the height of before. */
static void take_height(belief_world_t *world, const belief_world_t *other, float share)
{
    world->height_mm += share * (other->height_mm - world->height_mm);
}

/* Mirror m begins to lie, or ends to, in this world and in that which differs by it alone. A blocked vehicle
 * that climbs still climbs when a mirror sees again: else each mirror alone would look honest without end. */
static void turn(belief_world_t *true_world, belief_world_t *lie_world, uint16_t m, float gap_s)
{
    const float begins = true_world->probability * at_most(LIES_PER_S * gap_s, 0.5F);
    const float ends = lie_world->probability * at_most(TRUTHS_PER_S * gap_s, 0.5F);

    true_world->probability += ends - begins;
    take_motion(true_world, lie_world, ends / true_world->probability);
    lie_world->probability += begins - ends;
    take_height(lie_world, true_world, begins / lie_world->probability);
    lie_world->begun[m] += begins;
}

/* Of a world's probability, a part has come by so many mirrors that have begun to lie together. */
static void begin_together(belief_world_t *world, const belief_world_t *honest, uint16_t liars,
                           float probability)
{
    world->probability += probability;
    take_height(world, honest, probability / world->probability);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->begun[m] = belief_has(liars, m) ? probability : 0.0F;
    }
}

/* ---- something comes before several mirrors at once */

/* Rays are taken one mirror after the other: aft, front, fore. */
static uint16_t rank_of(uint16_t mirror)
{
    return (mirror == (uint16_t)MIRROR_AFT) ? 0U : (uint16_t)(mirror + 1U);
}

static uint16_t first_of(uint16_t set)
{
    uint16_t first = MIRROR_COUNT;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        first = (belief_has(set, m) && rank_of(m) < first) ? rank_of(m) : first;
    }
    return first;
}

static uint16_t last_of(uint16_t set)
{
    uint16_t last = 0U;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        last = (belief_has(set, m) && rank_of(m) > last) ? rank_of(m) : last;
    }
    return last;
}

/* It comes between two scans: then all of these show it in the next one. */
static float at_once(uint16_t liars)
{
    return 1.0F - BETWEEN_RAYS * (float)(last_of(liars) - first_of(liars));
}

/* How probable a world is, and that all its lies have begun in the scan before, by a common cause. */
static float just_begun(const belief_world_t *world, uint16_t liars)
{
    const float common = belief_has_several(liars) ? 1.0F : TOGETHER_SHARE / (float)(BELIEF_WORLDS - 1U);
    float begun = 1.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        begun = belief_has(liars, m) ? at_most(begun, world->begun[m]) : begun;
    }
    return common * begun * world->probability;
}

/* It has come after the rays of some: these show it a scan later than the rest. Without this, three that were
 * blocked by one thing looked like three steps of the terrain. */
static void follow(belief_world_t *world, belief_world_t *before, uint16_t later, float probability)
{
    before->probability -= probability;
    world->probability += probability;
    take_height(world, before, probability / world->probability);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->begun[m] += belief_has(later, m) ? probability : 0.0F;
    }
}

/* As far as a world's lies have just begun, its motion is that of the world in which nobody lies. */
static void share_begun(belief_world_t *world, const belief_world_t *honest)
{
    float begun = 0.0F;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        world->begun[m] = at_most(world->begun[m] / world->probability, 1.0F);
        begun = at_least(begun, world->begun[m]);
    }
    take_motion(world, honest, begun);
}

/* None of these liars has told nothing yet. The other worlds keep their probability, and their filters are
 * not read: meet() begins them. */
static bool are_known(const belief_t *belief, uint16_t liars)
{
    return (liars & (uint16_t)~belief->known) == 0U;
}

/* begun: just_begun() of each world. */
static void follow_all(belief_t *belief, const float begun[BELIEF_WORLDS])
{
    uint16_t last[BELIEF_WORLDS];

    for (uint16_t k = 1U; k <= belief->known; ++k) {
        last[k] = last_of(k);
    }
    for (uint16_t k = 1U; k <= belief->known; ++k) {
        const uint16_t first = first_of(k);

        for (uint16_t later = 1U; later <= belief->known; ++later) {
            if (last[later] < first && are_known(belief, later | k)) {
                follow(&belief->worlds[k | later], &belief->worlds[k], later,
                       BETWEEN_RAYS * (float)(first - last[later]) * begun[k]);
            }
        }
    }
}

static void mix(belief_t *belief, float gap_s)
{
    belief_world_t *worlds = belief->worlds;
    const float together = worlds[0].probability * at_most(TOGETHER_SHARE * LIES_PER_S * gap_s, 0.5F) /
                           (float)(BELIEF_WORLDS - 1U);
    float begun[BELIEF_WORLDS];

    for (uint16_t k = 1U; k <= belief->known; ++k) {
        begun[k] = just_begun(&worlds[k], k);
        if (are_known(belief, k)) {
            begin_together(&worlds[k], &worlds[0], k, at_once(k) * together);
            worlds[0].probability -= at_once(k) * together;
        }
    }
    if (belief_has_several(belief->known)) {
        follow_all(belief, begun);
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        for (uint16_t k = 0U; k <= belief->known; ++k) {
            if (belief_has(belief->known & (uint16_t)~k, m)) {
                turn(&worlds[k], &worlds[k | (1U << m)], m, gap_s);
            }
        }
    }
    for (uint16_t k = 1U; k <= belief->known; ++k) {
        share_begun(&worlds[k], &worlds[0]);
    }
}

static bool breaks(const belief_mean_t *mean, float mm)
{
    return fabsf(mm - mean->mm) > MEAN_BREAKS * BELIEF_NOISE_MM;
}

static void keep_mean(belief_mean_t *mean, float mm)
{
    mean->count = at_most(mean->count + 1.0F, MEAN_MOST);
    mean->mm += (mm - mean->mm) / mean->count;
}

/* Slant and height begin anew together: a mean of older scans in one of them would make the other worse. */
static void keep_means(belief_mean_t *slant, belief_mean_t *height, const belief_beam_t *beam)
{
    if (breaks(slant, beam->slant_mm)) {
        slant->count = height->count = 0.0F;
    }
    if (breaks(height, beam->height_mm)) {
        height->count = 0.0F;
    }
    keep_mean(slant, beam->slant_mm);
    keep_mean(height, beam->height_mm);
}

/* A mirror that has told nothing yet makes no difference: this world is the same as that without its lie. */
static void take_filter(belief_world_t *world, const belief_world_t *same)
{
    const float probability = world->probability;

    *world = *same;
    world->probability = probability;
}

/* A mirror that tells something for the first time has its level from that. */
static void meet(belief_t *belief, uint16_t mirror, float height_mm)
{
    const uint16_t bit = (uint16_t)(1U << mirror);

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        if ((k & bit & (uint16_t)~belief->known) != 0U) {
            take_filter(&belief->worlds[k], &belief->worlds[k & (uint16_t)~bit]);
        }
        belief->worlds[k].level_mm[mirror] = height_mm;
    }
    belief->known |= bit;
}

static void judge(belief_t *belief, belief_scan_t *scan)
{
    float density[BELIEF_WORLDS];
    float sum = 0.0F;

    belief_world_look(scan, belief->slant, belief->height);
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief_world_t *world = &belief->worlds[k];

        density[k] = are_known(belief, k) ? belief_world_scan(world, scan, k) : density[k & belief->known];
        world->probability *= density[k];
        sum += world->probability;
    }
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].probability = at_least(belief->worlds[k].probability / sum, LEAST);
    }
}

/* A motion that nothing tells is an acceleration. After n scans it makes n squared times the way of one scan,
 * and a rate that is wrong by n times its change in one scan. The filter corrects that by RATE_GAIN. */
static void loosen(belief_t *belief, float gap_s)
{
    const float scans = at_least(gap_s / SCAN_S, 1.0F);
    const float loose = at_least(scans * scans, 1.0F + 2.0F * belief->missed);

    belief->missed = at_least(scans - 1.0F, (1.0F - BELIEF_RATE_GAIN) * belief->missed);
    if (loose != belief->loose) {
        belief->loose = loose;
        belief_world_loosen(belief->motion, loose);
    }
}

void belief_scan(belief_t *belief, const belief_beam_t *beams, float gap_s, belief_felt_t felt)
{
    belief_scan_t scan = {.beams = beams, .gap_s = gap_s, .motion = belief->motion, .felt = felt};

    if (belief->known == 0U) {
        start(belief);
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (beams[m].valid && belief_has(belief->known, m) && gap_s <= HEIGHT_LOST_S) {
            scan.told |= (uint16_t)(1U << m);
        }
    }
    belief->told = scan.told;
    loosen(belief, gap_s);
    mix(belief, gap_s);
    judge(belief, &scan);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (beams[m].valid && !belief_has(scan.told, m)) {
            meet(belief, m, beams[m].height_mm);
        }
        if (beams[m].valid) {
            keep_means(&belief->slant[m], &belief->height[m], &beams[m]);
        }
    }
}

float belief_of_lie(const belief_t *belief, mirror_t mirror)
{
    float sum = 0.0F;

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        sum += belief_has(k, (uint16_t)mirror) ? belief->worlds[k].probability : 0.0F;
    }
    return sum;
}

float belief_of_honest(const belief_t *belief, uint16_t mirrors, uint16_t count)
{
    float sum = 0.0F;

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        uint16_t found = 0U;

        for (uint16_t honest = mirrors & (uint16_t)~k; honest != 0U; honest &= (uint16_t)(honest - 1U)) {
            ++found;
        }
        sum += (found >= count) ? belief->worlds[k].probability : 0.0F;
    }
    return sum;
}

belief_motions_t belief_of_motions(const belief_t *belief)
{
    belief_motions_t sums = {.no_step = 0.0F};

    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        const belief_world_t *world = &belief->worlds[k & belief->known];
        const float probability = belief->worlds[k].probability;

        sums.no_step += probability * world->no_step;
        sums.still += probability * world->still;
        sums.stands += probability * world->motions[BELIEF_STANDS];
        sums.held += probability * world->motions[BELIEF_HELD];
        sums.felt_lies += probability * world->motions[BELIEF_FELT_LIES];
    }
    return sums;
}

/* The worlds in which all lie that told something in the latest scan. */
static bool is_blind(const belief_t *belief, uint16_t liars)
{
    return (belief->told & (uint16_t)~liars) == 0U && are_known(belief, liars);
}

belief_blind_t belief_blind(const belief_t *belief)
{
    belief_blind_t blind = {0.0F, 0.0F};
    float probability = 0.0F;

    for (uint16_t k = 0U; k <= belief->known; ++k) {
        const belief_world_t *world = &belief->worlds[k];

        if (is_blind(belief, k)) {
            blind.rate_mm_s += world->probability * world->rate_mm_s * (1.0F - world->motions[BELIEF_STANDS]);
            blind.height_mm += world->probability * world->height_mm;
            probability += world->probability;
        }
    }
    blind.rate_mm_s /= at_least(probability, LEAST);
    blind.height_mm /= at_least(probability, LEAST);
    return blind;
}

void belief_land(belief_t *belief)
{
    for (uint16_t k = 0U; k < BELIEF_WORLDS; ++k) {
        belief->worlds[k].push_off_mps2 = belief->worlds[k].push_known = belief->worlds[k].height_mm = 0.0F;
    }
}
