/* What breaks: the summed terrain height drifts. So it is forgotten slowly, and the setpoint stays above the
 * ground. */
#include "control/est/terrain_keep.h"

#include "control/between.h"

#define TERRAIN_KEEP_S 30.0F        /* chosen: drift of the summed terrain height is forgotten */
#define LOWEST_OVER_TERRAIN_M 0.15F /* the height of OFF_GROUND_MM in supervisor.c */

void terrain_keep_start(terrain_keep_t *keep, float terrain_m)
{
    keep->terrain_m = terrain_m;
}

float terrain_keep_setpoint_m(terrain_keep_t *keep, float reference_m, float terrain_m, bool follows,
                              float step_s)
{
    const float ignored_m = terrain_m - keep->terrain_m;

    if (follows || reference_m != keep->reference_m) {
        keep->terrain_m = terrain_m;
        keep->reference_m = reference_m;
        return reference_m;
    }
    keep->terrain_m += ignored_m * step_s / TERRAIN_KEEP_S;
    return at_least(reference_m - ignored_m, LOWEST_OVER_TERRAIN_M);
}
