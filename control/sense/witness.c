/* Dead reckoning and the leaky sum of its innovations. A single step of the height, however high, is a step
 * of the terrain, and the caller adds nothing of it to the sums. */
#include "control/sense/witness.h"

#include <math.h>

#include "control/between.h"

#define WARM_S 0.5F         /* chosen: five scans before a witness counts */
#define GAP_ALLOWS_MPS 0.3F /* chosen: the speed error of a witness that still counts as agreement */

void witness_start(witness_t *witness, float speed_mps)
{
    *witness = (witness_t){.speed_mps = speed_mps};
}

void witness_move(witness_t *witness, float mps2, float dt_s)
{
    witness->off_m -= (witness->speed_mps + 0.5F * mps2 * dt_s) * dt_s;
    witness->speed_mps += mps2 * dt_s;
    witness->running_s = at_most(witness->running_s + dt_s, WITNESS_OLD_S);
}

void witness_compare(witness_t *witness, float rise_m, float gap_s, float age_s, float leak_per_s,
                     float pull_per_s2)
{
    witness->off_m += rise_m;
    const float seen_m = witness->off_m + witness->speed_mps * age_s;
    witness->off_m -= at_most(leak_per_s * gap_s, 1.0F) * seen_m;
    witness->speed_mps += pull_per_s2 * gap_s * seen_m;
    witness->seen_m = seen_m;
}

void witness_forget(witness_t *witness)
{
    witness->off_m = witness->seen_m = 0.0F;
}

bool witness_counts(const witness_t *witness)
{
    return witness->running_s > WARM_S;
}

bool witness_follows(const witness_t *witness, float rise_m, float gap_s)
{
    return witness->running_s > 0.0F &&
           fabsf(rise_m - witness->speed_mps * gap_s) <= WITNESS_STEP_M + GAP_ALLOWS_MPS * gap_s;
}
