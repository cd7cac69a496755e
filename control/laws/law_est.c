/* Law EST, in its three modes. */
#include "control/laws/laws.h"

float law_est_hold(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return est_law_step(est, now->parameters, now->where->contact.airborne, EST_MODE_HOLD, now->aim_m);
}

float law_est_land(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return est_law_step(est, now->parameters, now->where->contact.airborne, EST_MODE_LAND, 0.0F);
}

float law_est_sink(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return est_law_step(est, now->parameters, now->where->contact.airborne, EST_MODE_SINK, 0.0F);
}
