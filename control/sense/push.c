/* One lag for the motors, and the vehicle's model of cascade.h. */
#include "control/sense/push.h"

#include "control/between.h"
#include "control/seconds.h"
#include "control/where/hover_thrust.h"

#define PUSHED_LEAK_PER_S (1.0F / HOVER_TIME_S) /* what the hover thrust is off by is learned so fast */

static float step_s(const command_t *command)
{
    return at_most(command->step_s, CYCLE_MAX_S);
}

void push_lag(push_t *push, const command_t *command)
{
    const float dt_s = step_s(command);

    push->lagged_n += dt_s / (command->lag_s + dt_s) * (command->thrust_n - push->lagged_n);
}

float push_lift_mps(const push_t *push, const command_t *command, float upright)
{
    return command->authority_mps2_per_n * (push->lagged_n * upright - command->hover_n) * step_s(command);
}

float push_undelivered_mps(const push_t *push, const command_t *command, float upright)
{
    return command->authority_mps2_per_n * (command->thrust_n - push->lagged_n) * upright * step_s(command);
}

float push_dragged(const command_t *command)
{
    return command->damping_per_s * step_s(command);
}

void push_move(push_t *push, const command_t *command, float upright)
{
    const float dragged = push_dragged(command);
    const float gained_mps = (push_lift_mps(push, command, upright) - dragged * push->pushed.speed_mps) /
                             (1.0F + dragged);
    const float dt_s = step_s(command);

    if (dt_s > 0.0F) {
        witness_move(&push->pushed, gained_mps / dt_s, dt_s);
    }
}

void push_compare(push_t *push, float rise_m, float gap_s, float age_s)
{
    witness_compare(&push->pushed, rise_m, gap_s, age_s, PUSHED_LEAK_PER_S, 0.0F);
}

float push_speed_mps(const push_t *push, float rise_mps)
{
    const witness_t *pushed = &push->pushed;

    return witness_counts(pushed) ? pushed->speed_mps + PUSHED_LEAK_PER_S * pushed->seen_m : rise_mps;
}

float push_moved_m(const push_t *push)
{
    const witness_t *pushed = &push->pushed;

    return witness_counts(pushed) ? pushed->seen_m - pushed->off_m : 0.0F;
}
