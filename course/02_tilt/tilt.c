/* Laboratory 2: from the way of the ray to the height. Fill in the function and the number. */
#include <math.h>

#include "control/altitude.h"

/* The height that is measured too much when nobody corrects the tilt: see the numbers that `make lab N=2`
 * prints. */
const float foreseen_error_mm = 0.0F;

/* mirror->distance_mm is d, leg_mm is l, arm_mm is L, fore_sign is s. */
float student_height(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad)
{
    (void)mirror;
    (void)roll_rad;
    (void)pitch_rad;
    return slant_mm;
}
