/* Laboratory 2, for the numbers of 0: the thesis's equation 31, with the side mirrors. */
#include <math.h>

#include "control/altitude.h"

const float foreseen_error_mm = 57.0F;

float student_height(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad)
{
    return (slant_mm - mirror->distance_mm) * cosf(pitch_rad) * cosf(roll_rad) -
           mirror->arm_mm * sinf(roll_rad) - mirror->fore_sign * mirror->distance_mm * sinf(pitch_rad) -
           mirror->leg_mm;
}
