/* A take-off is unconfirmed until a climb shows in the heights, as is a step of the terrain towards the
 * vehicle. A jump is no first climb. After a far fall of the terrain the heights have to show that the
 * vehicle moves: a blocked beam's do not. A climb shows it too: by an accelerometer that lies the bound
 * DESCENT lifts the vehicle, and would never end. */
#include "control/sense/confirmation.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/sense/witness.h"

#define CONFIRMED_M \
    0.12F /* more than steps that do not show, WITNESS_STEP_M, and 3 HEIGHT_SIGMA_M: 119 mm \
           */
#define TERRAIN_FALL_M 0.40F /* chosen: above the edge of the seed's course, 0.25 m */
#define QUIET_S 1.0F         /* tried: 60 drawn vehicles whose blocked beam shows the reference; ten scans */

static void watch_depth(confirmation_t *confirmation, const height_change_t *change, bool standing)
{
    if (change->step) {
        confirmation->terrain_fell = change->rise_m > TERRAIN_FALL_M;
        confirmation->after_fall_m = change->height_m;
    } else if (standing || fabsf(change->height_m - confirmation->after_fall_m) > CONFIRMED_M) {
        confirmation->terrain_fell = false;
    }
}

/* A climb shows, or nothing can contradict it any more. */
static bool is_over(const confirmation_t *confirmation, const height_change_t *change)
{
    return !change->fresh || change->rise_m > WITNESS_STEP_M ||
           change->height_m > confirmation->near_m + CONFIRMED_M || confirmation->quiet_s > QUIET_S;
}

bool confirmation_height(confirmation_t *confirmation, const height_change_t *change, bool standing)
{
    watch_depth(confirmation, change, standing);
    confirmation->proved = confirmation->proved && !standing;
    const bool first = confirmation_is_first(confirmation);
    const bool nearer = change->rise_m < 0.0F;

    if (standing || (change->step && (first || nearer))) {
        confirmation->unconfirmed = true;
        confirmation->near_m = change->height_m;
        confirmation->quiet_s = 0.0F;
        return false;
    }
    if (!is_over(confirmation, change)) {
        return false;
    }
    confirmation->proved = confirmation->proved || first;
    confirmation->unconfirmed = false;
    return first;
}

void confirmation_wait(confirmation_t *confirmation, const height_change_t *change, float wanted_m)
{
    confirmation->quiet_s = (wanted_m < CONTENT_M) ? confirmation->quiet_s + change->gap_s : 0.0F;
}
