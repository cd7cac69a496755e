/* What breaks: a height of one ray. altitude_from_ranges() refuses it; examples/one_ray makes groups of
 * single readings. */
#include "control/sense/beam.h"

#include "control/credible.h"

#define HEIGHT_BACK_MM (HEIGHT_MIN_MM + 3000.0F * HEIGHT_SIGMA_M) /* hysteresis of three sigma */

bool beam_scan(beam_t *beam, const altitude_t *altitude)
{
    beam->below_ground = !(altitude->height_mm >= (beam->below_ground ? HEIGHT_BACK_MM : HEIGHT_MIN_MM));
    return !beam->below_ground;
}
