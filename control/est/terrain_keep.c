/* What breaks: the terrain height drifts. So it is forgotten slowly, and the setpoint stays above the ground.
 */
#include "control/est/terrain_keep.h"

#include "control/between.h"
#include "control/est/terrain.h"

#define STEPS_S 30.0F   /* chosen: drift of the summed terrain height is forgotten */
#define GROUND_S 300.0F /* chosen: what a ramp leaves, 0.05 m, is forgotten; a platform is not */

void terrain_keep_start(terrain_keep_t *keep, float terrain_m)
{
    keep->terrain_m = terrain_m;
}

float terrain_keep_setpoint_m(terrain_keep_t *keep, float reference_m, float terrain_m,
                              terrain_keep_how_t how, float step_s)
{
    const float ignored_m = terrain_m - keep->terrain_m;

    if (how == TERRAIN_KEEP_NOT || reference_m != keep->reference_m) {
        keep->terrain_m = terrain_m;
        keep->reference_m = reference_m;
        return reference_m;
    }
    keep->terrain_m += ignored_m * step_s / ((how == TERRAIN_KEEP_GROUND) ? GROUND_S : STEPS_S);
    return at_least(reference_m - ignored_m, TERRAIN_LEAST_M);
}
