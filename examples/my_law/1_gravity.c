/* Step 1: the thrust that the vehicle would hover with, if GRAV were right. No height is looked at. */
#include "control/laws/laws.h"

float law_mine_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    (void)est;
    return now->parameters->value[PARAMETER_GRAV];
}
