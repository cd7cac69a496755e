/* A comparison with a number that is none is false, so between() gives its lower end: the idle, no time, no
 * hover thrust. What breaks: a limit that a healthy flight reaches. tests/control/test_guard.c flies none;
 * tools/same/same.sh shows that no scenario does. */
#include "control/guard.h"

#include "control/between.h"
#include "control/thrust.h"

static float impulse_ns(float more_n, float step_s)
{
    return more_n * step_s;
}

float guard_step(guard_t *guard, const guard_case_t *now)
{
    const float idle_n = between(0.0F, now->idle_n, THRUST_MAX_N);
    const float thrust_n = between(idle_n, now->wanted_n, THRUST_MAX_N);
    const float heaviest_n = between(idle_n, now->heaviest_n, THRUST_MAX_N);
    const float step_s = between(0.0F, now->step_s, GUARD_STEP_MAX_S);

    if (!now->ordered || now->confirmed) {
        guard->unseen_ns = 0.0F;
        return now->ordered ? thrust_n : idle_n;
    }
    const float more_ns = impulse_ns(at_least(thrust_n - heaviest_n, 0.0F), step_s);
    const float unseen_ns = between(0.0F, guard->unseen_ns, GUARD_UNSEEN_NS) + more_ns;

    if (unseen_ns > GUARD_UNSEEN_NS) {
        return at_most(thrust_n, heaviest_n);
    }
    guard->unseen_ns = unseen_ns;
    return thrust_n;
}
