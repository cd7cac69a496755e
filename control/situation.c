/* What several rooms ask, answered once. */
#include "control/situation.h"

#include "control/credible.h"

bool situation_is_risen(const where_t *where, const est_law_t *est)
{
    const float height_m = where->supervisor.height.height_mm * 0.001F;

    return height_m - est->lift.ground_m > LOW_MM * 0.001F;
}

bool situation_is_rocking(const evidence_t *evidence, const est_law_t *est)
{
    return evidence->rocks && est_law_has_imu(est);
}

bool situation_without_effect(const situation_t *now)
{
    return now->evidence->mirrors.no_effect &&
           parameters_choice(now->parameters, PARAMETER_PLANT) != PLANT_CLIMB;
}
