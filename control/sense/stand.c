/* Only changes of the two speeds since the tilt became calm are compared, because the speed of the
 * accelerometer may be wrong from before, and may drift. */
#include "control/sense/stand.h"

#define FALL_MPS 0.8F      /* chosen: above SINK_MAX_MPS in let_down.c, 0.6 m/s */
#define STANDS_S 0.6F      /* chosen: 24 frames */
#define CALM_S 1.0F        /* chosen: two thirds of SWAY_TIME_S in sway.c */
#define CALM_TIME_S 2.0F   /* chosen: a bias of 0.15 m/s2 makes 0.3 m/s in that time */
#define FELL_MPS 0.4F      /* chosen: half of FALL_MPS */
#define FALL_CALM_MPS 0.5F /* chosen: above FELL_MPS */

static void watch_calm(stand_t *stand, const witness_t *felt, const witness_t *pushed, bool calm, float dt_s)
{
    const bool fell = felt->speed_mps < stand->calm_mps[0] - FELL_MPS;

    if (!calm || fell || stand->calm_s == 0.0F) {
        stand->calm_mps[0] = felt->speed_mps;
        stand->calm_mps[1] = pushed->speed_mps;
        stand->calm_s = 0.0F;
    }
    const float share = dt_s / CALM_TIME_S;
    stand->calm_mps[0] += share * (felt->speed_mps - stand->calm_mps[0]);
    stand->calm_mps[1] += share * (pushed->speed_mps - stand->calm_mps[1]);
    stand->calm_s = calm ? stand->calm_s + dt_s : 0.0F;
}

void stand_frame(stand_t *stand, const witness_t *felt, const witness_t *pushed, bool calm, float dt_s)
{
    watch_calm(stand, felt, pushed, calm, dt_s);
    const float felt_mps = felt->speed_mps - stand->calm_mps[0];
    const float pushed_mps = pushed->speed_mps - stand->calm_mps[1];
    const bool apart = pushed->speed_mps < felt->speed_mps - FALL_MPS ||
                       (stand->calm_s > CALM_S && pushed_mps < felt_mps - FALL_CALM_MPS);
    const bool falls = witness_counts(pushed) && witness_counts(felt) && apart &&
                       pushed->speed_mps < -FALL_MPS;

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
