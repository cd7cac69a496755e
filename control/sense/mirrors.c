/* The vote. What breaks: to take part, a mirror only has to be believed; terrain differs under each of them.
 * So the vote does not ask who is right, but which height the vehicle's middle most probably has. */
#include "control/sense/mirrors.h"

#include <math.h>

#include "control/between.h"

#define TOGETHER_MM 40.0F /* chosen: eight times the noise of a group, below ALTITUDE_DISAGREE_MM */
#define LIES 0.5F         /* more probably than not */
#define AGREE 0.99F       /* one wrong in a hundred: then the rules of rules.c are not asked */

void mirrors_frame(mirrors_t *mirrors, float gained_mps)
{
    mirrors->gained_mps += gained_mps;
}

/* What the heights will show of it: their rays are older than the frames. */
static float gained_mps(mirrors_t *mirrors, float gap_s, float age_s)
{
    const float late = at_most(age_s / gap_s, 1.0F);
    const float shown_mps = (1.0F - late) * mirrors->gained_mps + late * mirrors->gained_before_mps;

    mirrors->gained_before_mps = mirrors->gained_mps;
    mirrors->gained_mps = 0.0F;
    return shown_mps;
}

/* Identical digits are no new scan, see beam.c. */
static bool is_copy(mirrors_t *mirrors, uint16_t m, const altitude_t *shown)
{
    const bool copy = shown->good_rays > 1U && shown->slant_mm == mirrors->latest[m].slant_mm &&
                      shown->spread_mm == mirrors->latest[m].spread_mm;

    mirrors->latest[m].slant_mm = shown->slant_mm;
    mirrors->latest[m].spread_mm = shown->spread_mm;
    return copy;
}

static bool has(uint16_t set, uint16_t mirror)
{
    return (set & (1U << mirror)) != 0U;
}

/* Returns those that are believed, as bits. */
static uint16_t believe(mirrors_t *mirrors, const altitude_t *shown, float gap_s, float speed_mps)
{
    belief_beam_t beams[MIRROR_COUNT];
    uint16_t fit = 0U;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool valid = shown[m].valid && !is_copy(mirrors, m, &shown[m]);

        beams[m] = (belief_beam_t){valid, shown[m].slant_mm, shown[m].height_mm};
    }
    belief_scan(&mirrors->belief, beams, gap_s, speed_mps);
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const bool lies = belief_of_lie(&mirrors->belief, (mirror_t)m) > LIES;

        if (beams[m].valid && !lies) {
            fit |= (uint16_t)(1U << m);
        }
    }
    return fit;
}

/* ---- the vote: mirrors as numbers, the lowest height first */

typedef struct {
    uint16_t count;
    uint16_t mirror[MIRROR_COUNT];
} voters_t;

static void swap_if_higher(voters_t *voters, uint16_t a, uint16_t b, const altitude_t *shown)
{
    const uint16_t first = voters->mirror[a];

    if (shown[first].height_mm > shown[voters->mirror[b]].height_mm) {
        voters->mirror[a] = voters->mirror[b];
        voters->mirror[b] = first;
    }
}

/* Those that are fit; all that are valid when none is. */
static voters_t voters_of(const altitude_t *shown, uint16_t fit)
{
    voters_t voters = {.count = 0U};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if ((fit != 0U) ? has(fit, m) : shown[m].valid) {
            voters.mirror[voters.count++] = m;
        }
    }
    for (uint16_t turn = 1U; turn < voters.count; ++turn) {
        for (uint16_t i = 0U; i + turn < voters.count; ++i) {
            swap_if_higher(&voters, i, (uint16_t)(i + 1U), shown);
        }
    }
    return voters;
}

static float height_of(const voters_t *voters, uint16_t voter, const altitude_t *shown)
{
    return shown[voters->mirror[voter]].height_mm;
}

static bool lie_together(const voters_t *voters, uint16_t low, uint16_t high, const altitude_t *shown)
{
    return height_of(voters, high, shown) - height_of(voters, low, shown) <= TOGETHER_MM;
}

/* Of three that do not all lie together: the nearer pair, or the middle one alone. */
static voters_t keep_of_three(const voters_t *voters, const altitude_t *shown)
{
    const float middle_mm = height_of(voters, 1U, shown);
    const bool upper = height_of(voters, 2U, shown) - middle_mm < middle_mm - height_of(voters, 0U, shown);
    const uint16_t low = upper ? 1U : 0U;
    voters_t kept = {.count = 2U, .mirror = {voters->mirror[low], voters->mirror[low + 1U]}};

    if (!lie_together(&kept, 0U, 1U, shown)) {
        kept = (voters_t){.count = 1U, .mirror = {voters->mirror[1]}};
    }
    return kept;
}

static voters_t keep_of_two(const voters_t *voters, const altitude_t *shown, const altitude_t *before)
{
    const float from_low_mm = fabsf(height_of(voters, 0U, shown) - before->height_mm);
    const float from_high_mm = fabsf(height_of(voters, 1U, shown) - before->height_mm);
    const uint16_t nearer = (before->valid && from_high_mm < from_low_mm) ? 1U : 0U;

    return (voters_t){.count = 1U, .mirror = {voters->mirror[nearer]}};
}

static voters_t keep(const voters_t *voters, const altitude_t *shown, const altitude_t *before)
{
    if (voters->count < 2U || lie_together(voters, 0U, (uint16_t)(voters->count - 1U), shown)) {
        return *voters;
    }
    return (voters->count == 2U) ? keep_of_two(voters, shown, before) : keep_of_three(voters, shown);
}

static uint16_t bits(const voters_t *voters)
{
    uint16_t set = 0U;

    for (uint16_t i = 0U; i < voters->count; ++i) {
        set |= (uint16_t)(1U << voters->mirror[i]);
    }
    return set;
}

void mirrors_scan(mirrors_t *mirrors, const altitude_t *shown, float gap_s, float age_s, bool felt)
{
    const float speed_mps = gained_mps(mirrors, gap_s, age_s);
    const uint16_t fit = believe(mirrors, shown, gap_s, felt ? speed_mps : 0.0F);
    const voters_t voters = voters_of(shown, fit);
    if (voters.count == 0U) {
        mirrors->agree = false;
        return;
    }
    const voters_t kept = keep(&voters, shown, &mirrors->altitude);
    altitude_t all[MIRROR_COUNT];
    for (uint16_t i = 0U; i < kept.count; ++i) {
        all[i] = shown[kept.mirror[i]];
    }
    mirrors->altitude = altitude_mean(all, kept.count);
    mirrors->altitude.disagree = voters.count > 1U &&
                                 height_of(&voters, (uint16_t)(voters.count - 1U), shown) -
                                         height_of(&voters, 0U, shown) >
                                     ALTITUDE_DISAGREE_MM;
    mirrors->agree = belief_of_two(&mirrors->belief, bits(&voters)) > AGREE;
}
