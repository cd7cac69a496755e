/* A comparison with a number that is none is false, so between() gives its lower end: the idle, no time, no
 * hover thrust. What breaks: a limit that a healthy flight reaches. tests/control/test_guard.c flies none;
 * tools/same/same.sh shows that no scenario does. */
#include "control/guard.h"

#include "control/between.h"
#include "control/seconds.h"
#include "control/thrust.h"

static float impulse_ns(float more_n, float step_s)
{
    return more_n * step_s;
}

static float faded_n(float thrust_n, float step_s)
{
    return thrust_n - GUARD_FADE_N_PER_S * step_s;
}

/* Down: what is commanded below the thrust that is needed. */
static float not_falling_n(guard_t *guard, float thrust_n, float idle_n, float lightest_n, float step_s)
{
    const float sure_n = between(0.0F, guard->sure_n, THRUST_MAX_N);
    const float least_n = between(idle_n, faded_n(sure_n, step_s), lightest_n);
    const float fallen_ns = between(0.0F, guard->fallen_ns, GUARD_FALL_NS);

    if (thrust_n >= least_n) {
        guard->sure_n = at_most(thrust_n, lightest_n);
        guard->fallen_ns = at_least(fallen_ns - impulse_ns(thrust_n - least_n, step_s), 0.0F);
        return thrust_n;
    }
    guard->sure_n = least_n;
    const float more_ns = fallen_ns + impulse_ns(least_n - thrust_n, step_s);
    if (more_ns > GUARD_FALL_NS) {
        return least_n;
    }
    guard->fallen_ns = more_ns;
    return thrust_n;
}

/* Up: what is commanded above the hover thrust of the heaviest vehicle, while no height has confirmed it. */
static float not_climbing_n(guard_t *guard, float thrust_n, float heaviest_n, float step_s)
{
    const float more_ns = impulse_ns(at_least(thrust_n - heaviest_n, 0.0F), step_s);
    const float unseen_ns = between(0.0F, guard->unseen_ns, GUARD_UNSEEN_NS) + more_ns;

    if (unseen_ns > GUARD_UNSEEN_NS) {
        return at_most(thrust_n, heaviest_n);
    }
    guard->unseen_ns = unseen_ns;
    return thrust_n;
}

float guard_step(guard_t *guard, const guard_case_t *now)
{
    const float idle_n = between(0.0F, now->idle_n, THRUST_MAX_N);
    const float wanted_n = between(idle_n, now->wanted_n, THRUST_MAX_N);
    const float heaviest_n = between(idle_n, now->heaviest_n, THRUST_MAX_N);
    const float lightest_n = between(idle_n, now->lightest_n, heaviest_n);
    const float step_s = between(0.0F, now->step_s, CYCLE_MAX_S);

    if (!now->ordered) {
        *guard = (guard_t){.sure_n = idle_n};
        return idle_n;
    }
    const float thrust_n = not_falling_n(guard, wanted_n, idle_n, lightest_n, step_s);
    if (now->confirmed) {
        guard->unseen_ns = 0.0F;
        return thrust_n;
    }
    return not_climbing_n(guard, thrust_n, heaviest_n, step_s);
}
