/* The ceiling starts from the hover thrust that was sure when the descent began, and it only falls. Neither
 * learning during the descent nor a change of the kind of descent raises it again. What breaks: a ceiling
 * that follows what a descent teaches can rise with a wrong height, and the vehicle climbs away. Where two
 * mirrors agree on the heights, a landing has none: below it a gust would press the vehicle to the ground.
 * One exception: a landing that a pilot has held up begins when he gives the throttle back, and so does its
 * ceiling. What has lost a load looks held up too, but it climbs: its ceiling goes on falling. */
#include "control/est/let_down.h"

#include "control/between.h"
#include "control/credible.h"
#include "control/thrust.h"
#include "control/touchdown.h"
#include "control/where/hover_thrust.h"

void let_down_reset(let_down_t *down)
{
    down->ceiling_n = THRUST_MAX_N;
    down->near_ground_s = 0.0F;
}

void let_down_arm(let_down_t *down, float hover_n)
{
    down->ceiling_n = THRUST_MAX_N;
    down->entry_hover_n = hover_n;
}

float let_down_mps(est_mode_t mode, float height_m)
{
    const float over_m = at_least(height_m, 0.0F);

    return (mode == EST_MODE_SINK) ? -LAND_MAX_MPS : -at_most(LAND_MPS + LAND_PER_S * over_m, LAND_MAX_MPS);
}

/* Has a pilot given the throttle back? What has climbed by LAW_REACH_M meanwhile was probably not held by
 * one, and its thrust is too large. */
static void watch_pilot(let_down_t *down, est_mode_t mode, const let_down_signs_t *signs)
{
    const bool given_back = mode == EST_MODE_LAND && down->held && signs->pushes;
    const bool climbed = signs->height_m > down->entry_m + LAW_REACH_M;

    down->entry_m = (down->ceiling_n == THRUST_MAX_N) ? signs->height_m : down->entry_m;
    down->ceiling_n = (given_back && !climbed) ? THRUST_MAX_N : down->ceiling_n;
    down->held = !signs->pushes;
}

void let_down_step(let_down_t *down, est_mode_t mode, const let_down_signs_t *signs)
{
    const bool sinks = mode == EST_MODE_SINK;
    const float above_n = sinks ? NEAR_HOVER_N : HOVER_THRUST_MARGIN_N;

    watch_pilot(down, mode, signs);
    down->seen = signs->seen;
    down->near_ground_s = (mode == EST_MODE_LAND) ? touchdown_time_s(down->near_ground_s, signs->height_m,
                                                                     signs->rocks, signs->step_s)
                                                  : 0.0F;
    if (mode == EST_MODE_SINK || (mode == EST_MODE_LAND && !signs->seen)) {
        down->ceiling_n = at_most(down->ceiling_n - SINK_FADE_N_PER_S * signs->step_s,
                                  down->entry_hover_n + above_n);
        down->ceiling_n = at_least(down->ceiling_n, 0.0F);
    }
}

/* Without heights the estimated speed may be wrong. It must not cut the thrust so far that the vehicle falls.
 */
static float least_n(const let_down_t *down, est_mode_t mode)
{
    return (mode == EST_MODE_SINK) ? at_least(down->entry_hover_n - NEAR_HOVER_N, 0.0F) : 0.0F;
}

static float most_n(const let_down_t *down, est_mode_t mode, float hover_n)
{
    const float low_n = touchdown_limit_n(down->near_ground_s, hover_n);

    return (mode == EST_MODE_LAND) ? (down->seen ? low_n : at_most(down->ceiling_n, low_n)) : down->ceiling_n;
}

float let_down_limit_n(const let_down_t *down, est_mode_t mode, float thrust_n, float hover_n)
{
    return at_most(at_least(thrust_n, least_n(down, mode)), most_n(down, mode, hover_n));
}
