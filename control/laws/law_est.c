/* Law EST, in its three modes. */
#include "control/laws/laws.h"

static float step(est_law_t *est, const situation_t *now, est_mode_t mode)
{
    const where_t *where = now->where;
    const est_order_t order = {
        .mode = mode,
        .reference_m = now->aim_m,
        .airborne = where->contact.airborne,
        .hover_n = where->hover.thrust_n,
        .descends = where_lets_down(where),
    };

    return est_law_step(est, now->parameters, &order);
}

float law_est_hold(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return step(est, now, EST_MODE_HOLD);
}

float law_est_land(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return step(est, now, EST_MODE_LAND);
}

float law_est_sink(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    return step(est, now, EST_MODE_SINK);
}
