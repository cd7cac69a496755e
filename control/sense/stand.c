/* A fall is a change of the felt speed since the tilt became calm, because the speed of the accelerometer may
 * be wrong from before, and may drift. */
#include "control/sense/stand.h"

#include "control/est/let_down.h"

#define FALL_MPS (2.0F * FELL_MPS)
#define STANDS_S 0.6F    /* chosen: 24 frames */
#define CALM_S 1.0F      /* chosen: two thirds of SWAY_TIME_S in sway.h */
#define CALM_TIME_S 2.0F /* chosen: a bias of 0.15 m/s2 makes 0.3 m/s in that time */
#define FELL_MPS 0.4F    /* chosen: a third faster than any landing */

static void watch_calm(stand_t *stand, const witness_t *felt, bool calm, float dt_s)
{
    const bool fell = felt->speed_mps < stand->calm_mps - FELL_MPS;

    if (!calm || fell || stand->calm_s == 0.0F) {
        stand->calm_mps = felt->speed_mps;
        stand->calm_s = 0.0F;
    }
    const float share = dt_s / CALM_TIME_S;
    stand->calm_mps += share * (felt->speed_mps - stand->calm_mps);
    stand->calm_s = calm ? stand->calm_s + dt_s : 0.0F;
}

void stand_frame(stand_t *stand, const witness_t *felt, const witness_t *pushed, bool calm, float dt_s)
{
    watch_calm(stand, felt, calm, dt_s);
    const bool falls = witness_counts(pushed) && witness_counts(felt) && pushed->speed_mps < -FALL_MPS &&
                       pushed->speed_mps < felt->speed_mps - FALL_MPS;

    stand->stands_s = (falls && calm) ? stand->stands_s + dt_s : 0.0F;
}

bool stand_is_possible(const stand_t *stand)
{
    return stand->calm_s > CALM_S;
}

bool stand_is_sure(const stand_t *stand)
{
    return stand->stands_s > STANDS_S;
}
