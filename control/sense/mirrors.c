/* The vote. What breaks: to take part, a mirror only has to be believed; terrain differs under each of them.
 * So the vote does not ask who is right, but which height the vehicle's middle most probably has. It is a
 * mean about the middle one, whose weights fall smoothly (a redescending M-estimate, Huber 1981). With a
 * limit in place of the weights the height jumped by 35 mm whenever another pair lay nearest: on slopes,
 * which took the estimator off its track. A mirror also counts as much as it is probably honest. */
#include "control/sense/mirrors.h"

#include <float.h>
#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/imu_sample.h"

#define RELIEF_MM 75.0F          /* chosen: what ground differs by under one vehicle; stairs are 170 mm */
#define RELIEF_SIGMAS 3.0F       /* beyond, it is another ground */
#define LIES 0.5F                /* more probably than not */
#define MOST 0.5F                /* of the gap */
#define LIAR_S 2.0F              /* chosen: the bracket is 0.22 m long, which takes 1.1 s at 0.2 m/s */
#define DISBELIEVED_MOST_S 10.0F /* the counter stops here */
#define AGREE 0.99F              /* one wrong in a hundred */

void mirrors_frame(mirrors_t *mirrors, float gained_mps, float dt_s)
{
    mirrors->felt.gained += gained_mps;
    mirrors->heard.gained += dt_s;
}

static void drop_motions(mirrors_t *mirrors)
{
    const mirrors_motion_t none = {0.0F, 0.0F};

    mirrors->felt = mirrors->heard = mirrors->pushed = mirrors->dragged = mirrors->undelivered = none;
}

void mirrors_rest(mirrors_t *mirrors, bool unseen)
{
    belief_land(&mirrors->belief);
    if (unseen) {
        drop_motions(mirrors);
    }
}

float mirrors_blind_mps(const mirrors_t *mirrors, bool believed)
{
    const mirrors_motion_t *since = (mirrors->felt_told && believed) ? &mirrors->felt : &mirrors->pushed;

    const float rate_mps = 0.001F * belief_blind(&mirrors->belief).rate_mm_s;
    const float dragged = (since == &mirrors->pushed) ? mirrors->dragged.left + mirrors->dragged.gained
                                                      : 0.0F;

    return (1.0F - dragged) * rate_mps + since->left + since->gained;
}

void mirrors_thrust(mirrors_t *mirrors, float gained_mps, float undelivered_mps, float dragged)
{
    mirrors->undelivered.gained += fabsf(undelivered_mps);
    mirrors->pushed.gained += gained_mps;
    mirrors->dragged.gained += dragged;
}

void mirrors_carried(mirrors_t *mirrors, float step_s)
{
    mirrors_thrust(mirrors, 0.0F, IMU_GRAVITY_MPS2 * step_s, 0.0F);
}

/* What this scan shows of it: its rays are older than the frames. late: share of the gap; that is left for
 * the next scan. */
static float shown(mirrors_motion_t *motion, float late)
{
    const float shown = (1.0F - late) * motion->gained + motion->left;

    motion->left = late * motion->gained;
    motion->gained = 0.0F;
    return shown;
}

/* After a gap of the IMU its frames tell a small part of the scan's motion. */
static belief_felt_t felt_of(mirrors_t *mirrors, float gap_s, float age_s, bool believed)
{
    const float late = at_most(age_s / gap_s, 1.0F);

    if (gap_s >= MIRRORS_GAP_MOST_S) { /* the sums are of a longer time */
        drop_motions(mirrors);
    }
    mirrors->felt_told = shown(&mirrors->heard, late) > MOST * gap_s && believed;
    return (belief_felt_t){.untold = !mirrors->felt_told,
                           .gained_mps = shown(&mirrors->felt, late),
                           .pushed_mps = shown(&mirrors->pushed, late),
                           .undelivered_mps = shown(&mirrors->undelivered, late),
                           .dragged = shown(&mirrors->dragged, late)};
}

/* Identical digits are no new scan: with a sensor noise of 3 mm, chance makes them once in some thousands. */
static bool is_copy(mirror_digits_t *latest, const altitude_t *shown)
{
    const bool copy = shown->good_rays > 1U && shown->slant_mm == latest->slant_mm &&
                      shown->spread_mm == latest->spread_mm;

    *latest = (mirror_digits_t){shown->slant_mm, shown->spread_mm};
    return copy;
}

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

uint16_t mirrors_liars(const mirrors_t *mirrors, bool lasting)
{
    uint16_t liars = 0U;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (mirrors->disbelieved_s[m] > (lasting ? LIAR_S : 0.0F)) {
            liars |= (uint16_t)(1U << m);
        }
    }
    return liars;
}

/* Returns those that are believed, as bits; all that do not repeat their scan when none is. */
static uint16_t believe(mirrors_t *mirrors, const altitude_t *shown, float gap_s, belief_felt_t felt)
{
    belief_beam_t beams[MIRROR_COUNT];
    uint16_t fresh = 0U;
    uint16_t fit = 0U;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool valid = shown[m].valid && fabsf(shown[m].height_mm) <= HEIGHT_MAX_MM &&
                           !is_copy(&mirrors->latest[m], &shown[m]);

        if (valid) {
            fresh |= (uint16_t)(1U << m);
        }
        beams[m] = (belief_beam_t){valid, shown[m].slant_mm, shown[m].height_mm};
    }
    belief_scan(&mirrors->belief, beams, gap_s, felt);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        mirrors->lies[m] = belief_of_lie(&mirrors->belief, (mirror_t)m);
        const bool lies = mirrors->lies[m] > LIES;

        mirrors->disbelieved_s[m] = lies ? at_most(mirrors->disbelieved_s[m] + gap_s, DISBELIEVED_MOST_S)
                                         : 0.0F;
        if (beams[m].valid && !lies) {
            fit |= (uint16_t)(1U << m);
        }
    }
    return (fit != 0U) ? fit : fresh;
}

/* ---- the vote */

static float middle_of(const float heights_mm[MIRROR_COUNT])
{
    const float low_mm = fminf(heights_mm[0], heights_mm[1]);
    const float high_mm = fmaxf(heights_mm[0], heights_mm[1]);

    return between(low_mm, heights_mm[2], high_mm);
}

/* Of two: that which is nearer to the height before; the lower one when there is none. */
static float nearer_of(const float heights_mm[MIRROR_COUNT], const altitude_t *before)
{
    const float low_mm = fminf(heights_mm[0], heights_mm[1]);
    const float high_mm = fmaxf(heights_mm[0], heights_mm[1]);
    const float middle_mm = 0.5F * (low_mm + high_mm);

    return (before->valid && before->height_mm > middle_mm) ? high_mm : low_mm;
}

/* Writes how much each of these mirrors counts. Returns those that tell something and do not count. */
static uint16_t weigh(float weights[MIRROR_COUNT], const mirrors_t *mirrors, const altitude_t *shown,
                      uint16_t voters)
{
    float heights_mm[MIRROR_COUNT];
    uint16_t count = 0U;
    uint16_t left_out = 0U;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (has(voters, m)) {
            heights_mm[count++] = shown[m].height_mm;
        }
    }
    const float centre_mm = (count == 3U)   ? middle_of(heights_mm)
                            : (count == 2U) ? nearer_of(heights_mm, &mirrors->altitude)
                                            : heights_mm[0];
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const float off = (shown[m].height_mm - centre_mm) / RELIEF_MM;
        const bool counts = has(voters, m) && fabsf(off) < RELIEF_SIGMAS;
        const float honest = at_least(1.0F - mirrors->lies[m], FLT_EPSILON);

        weights[m] = counts ? honest * expf(-0.5F * off * off) : 0.0F;
        if (shown[m].valid && !counts) {
            left_out |= (uint16_t)(1U << m);
        }
    }
    return left_out;
}

/* no_step: probability that the heights show how the vehicle moved; 0: the scan tells nothing, or was held
 * up, so that nothing is known of the motion that it shows. Numbers go on after 65535 at 1. */
static void number_ground(mirrors_t *mirrors, float no_step)
{
    if (mirrors->ground == 0U || no_step <= AGREE) {
        mirrors->ground = (uint16_t)((mirrors->ground < UINT16_MAX) ? mirrors->ground + 1U : 1U);
    }
}

static void tell_nothing(mirrors_t *mirrors)
{
    mirrors->agree = mirrors->sees = mirrors->suspected = mirrors->blind = false;
    mirrors->felt_lies = mirrors->felt_may_lie = false;
    mirrors->stirs = mirrors->moves = mirrors->unpushed = mirrors->no_effect = false;
    mirrors->left_out = 0U;
}

void mirrors_wait(mirrors_t *mirrors, float step_s)
{
    mirrors->unseen_s = at_most(mirrors->unseen_s + step_s, MIRRORS_GAP_MOST_S);
    if (mirrors->unseen_s > HEIGHT_LOST_S) {
        tell_nothing(mirrors);
    }
}

bool mirrors_scan(mirrors_t *mirrors, const altitude_t *shown, float gap_s, float age_s, bool felt,
                  bool held_up)
{
    const belief_felt_t nothing = {.untold = true};
    const belief_felt_t told = felt_of(mirrors, gap_s, age_s, felt && !held_up);
    const uint16_t voters = believe(mirrors, shown, gap_s, held_up ? nothing : told);
    float weights[MIRROR_COUNT];

    if (voters == 0U) {
        tell_nothing(mirrors);
        number_ground(mirrors, 0.0F);
        return false;
    }
    mirrors->unseen_s = 0.0F;
    mirrors->left_out = weigh(weights, mirrors, shown, voters);
    mirrors->altitude = altitude_mean(shown, weights, MIRROR_COUNT);
    const belief_t *belief = &mirrors->belief;
    const float honest = belief_of_honest(belief, voters, 2U);
    const float none = belief_of_none(belief, voters);
    const belief_motions_t motions = belief_of_motions(belief);
    const float moves = 1.0F - motions.stands - motions.felt_lies;

    mirrors->agree = honest > AGREE;
    mirrors->felt_lies = motions.felt_lies > AGREE && (mirrors->felt_may_lie || !belief_has_several(voters));
    mirrors->felt_may_lie = motions.felt_lies > AGREE;
    mirrors->stirs = 1.0F - motions.still > AGREE;
    mirrors->moves = moves > AGREE;
    mirrors->no_effect = motions.held > AGREE;
    mirrors->unpushed = motions.held + motions.stands > AGREE;
    mirrors->suspected = none > 1.0F - AGREE;
    mirrors->blind = none > AGREE;
    mirrors->sees = !mirrors->suspected && moves > LIES;
    number_ground(mirrors, held_up ? 0.0F : motions.no_step);
    mirrors->altitude.disagree = honest < 1.0F - LIES;
    return true;
}

uint16_t mirrors_tell(const mirrors_t *mirrors, float lies[MIRROR_COUNT])
{
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        lies[m] = mirrors->lies[m];
    }
    return mirrors->left_out;
}
