/* A single step of the height, however high, is a step of the terrain. A blocked beam first looks like one
 * too, but then the height stays where it is while the vehicle moves. */
#include "control/sense/heights.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/sense/witness.h"

#define RISE_TIME_S 0.2F                                   /* chosen: two scans */
#define BACK_MM (HEIGHT_MIN_MM + 3000.0F * HEIGHT_SIGMA_M) /* hysteresis of three sigma */

bool heights_can_be(heights_t *heights, float height_mm)
{
    heights->below_ground = !(height_mm >= (heights->below_ground ? BACK_MM : HEIGHT_MIN_MM));
    return !heights->below_ground;
}

height_change_t heights_change(const heights_t *heights, float height_m, float gap_s, float age_s)
{
    const float rise_m = height_m - heights->height_m;
    const bool fresh = heights->known && gap_s < HEIGHT_LOST_S;

    return (height_change_t){
        .height_m = height_m,
        .rise_m = rise_m,
        .gap_s = gap_s,
        .age_s = age_s,
        .fresh = fresh,
        .step = fresh && fabsf(rise_m) > WITNESS_STEP_M,
    };
}

void heights_update(heights_t *heights, const height_change_t *change)
{
    const float gap_s = change->gap_s;
    const float rise_mps = change->step ? heights->rise_mps : change->rise_m / at_least(gap_s, 0.01F);

    heights->height_m = change->height_m;
    heights->known = true;
    heights->stepped = change->step;
    heights->rise_mps += gap_s / (RISE_TIME_S + gap_s) * (rise_mps - heights->rise_mps);
}
