/* What several rooms ask, answered once. */
#include "control/situation.h"

#include "control/credible.h"

void situation_derive(situation_t *now)
{
    const float height_m = now->where->supervisor.height.height_mm * 0.001F;

    now->risen = height_m - now->est->lift.ground_m > LOW_MM * 0.001F;
    now->rocks = now->evidence->rocks && est_law_has_imu(now->est);
}
