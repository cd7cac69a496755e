/* What breaks: the terrain height drifts. So it is forgotten slowly, and the setpoint stays above the ground.
 * A hard climb looks to the filter like ground that falls: 10 to 40 mm were held too low after a take-off. So
 * the rate of the terrain does not count before the reference is reached; its steps do. */
#include "control/est/terrain_keep.h"

#include <math.h>

#include "control/between.h"
#include "control/est/terrain.h"

#define STEPS_S 30.0F   /* chosen: drift of the summed terrain height is forgotten */
#define GROUND_S 300.0F /* chosen: what a ramp leaves, 0.05 m, is forgotten; a platform is not */

void terrain_keep_start(terrain_keep_t *keep, float terrain_m)
{
    keep->terrain_m = terrain_m;
    keep->arrived_m = 0.0F;
}

float terrain_keep_setpoint_m(terrain_keep_t *keep, float reference_m, const terrain_keep_ground_t *ground,
                              float step_s)
{
    const float ignored_m = ground->height_m - keep->terrain_m;

    if (ground->how == TERRAIN_KEEP_NOT || reference_m != keep->reference_m) {
        keep->terrain_m = ground->height_m;
        keep->arrived_m = (reference_m == keep->reference_m) ? keep->arrived_m : 0.0F;
        keep->reference_m = reference_m;
        return reference_m;
    }
    keep->terrain_m += ignored_m * step_s / ((ground->how == TERRAIN_KEEP_GROUND) ? GROUND_S : STEPS_S) +
                       ((keep->arrived_m == reference_m) ? 0.0F : ground->rate_mps * step_s);
    return at_least(reference_m - ignored_m, TERRAIN_LEAST_M);
}

float terrain_keep_above_mps(float height_m, float ground_mps, float acts_s, const cascade_gains_t *gains,
                             float wanted_mps)
{
    const float left_m = height_m - ground_mps * acts_s - TERRAIN_LEAST_M;
    const float sinks_mps = (left_m > 0.0F) ? sqrtf(2.0F * EST_FALL_MPS2 * left_m)
                                            : gains->height_per_s * left_m;

    return at_least(wanted_mps, at_most(ground_mps - sinks_mps, gains->up_mps));
}
