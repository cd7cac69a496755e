/* Any input, for any number of cycles: what one cycle leaves is any state that the next one may find. */
#include "control/guard.c"

#include "prove.h"

static float commanded_ns; /* the impulse that was counted last in a cycle */

static float impulse_ns(float more_n, float step_s)
{
    PROVE(more_n >= 0.0F && more_n <= THRUST_MAX_N && step_s >= 0.0F && step_s <= CYCLE_MAX_S,
          "a thrust and a time");
    commanded_ns = nondet_float();
    ASSUME(commanded_ns >= 0.0F && commanded_ns <= THRUST_MAX_N * CYCLE_MAX_S);
    return commanded_ns;
}

static float faded_to_n; /* what is needed, after the cycle's fading */

static float faded_n(float thrust_n, float step_s)
{
    PROVE(thrust_n >= 0.0F && thrust_n <= THRUST_MAX_N && step_s >= 0.0F && step_s <= CYCLE_MAX_S,
          "a thrust and a time");
    faded_to_n = nondet_float();
    ASSUME(faded_to_n <= thrust_n && faded_to_n >= -GUARD_FADE_N_PER_S * CYCLE_MAX_S);
    return faded_to_n;
}

void any_thrust_fades_slowly(void)
{
    const float thrust_n = nondet_float();
    const float step_s = nondet_float();

    ASSUME(thrust_n >= 0.0F && thrust_n <= THRUST_MAX_N && step_s >= 0.0F && step_s <= CYCLE_MAX_S);
    const float then_n = faded_n_itself(thrust_n, step_s);

    PROVE(then_n <= thrust_n && then_n >= -GUARD_FADE_N_PER_S * CYCLE_MAX_S, "less, and not by more");
}

void any_impulse_is_one(void)
{
    const float more_n = nondet_float();
    const float step_s = nondet_float();

    ASSUME(more_n >= 0.0F && more_n <= THRUST_MAX_N && step_s >= 0.0F && step_s <= CYCLE_MAX_S);
    PROVE(impulse_ns_itself(more_n, step_s) >= 0.0F, "not below nothing");
}

static guard_t any_guard(void)
{
    return (guard_t){.unseen_ns = nondet_float(), .sure_n = nondet_float(), .fallen_ns = nondet_float()};
}

static guard_case_t any_case(void)
{
    return (guard_case_t){
        .wanted_n = nondet_float(),
        .idle_n = nondet_float(),
        .heaviest_n = nondet_float(),
        .lightest_n = nondet_float(),
        .step_s = nondet_float(),
        .ordered = nondet_bool(),
        .confirmed = nondet_bool(),
    };
}

void any_thrust_is_within_idle_and_full(void)
{
    guard_t guard = any_guard();
    const guard_case_t now = any_case();
    const float thrust_n = guard_step(&guard, &now);

    PROVE(thrust_n >= 0.0F && thrust_n <= THRUST_MAX_N, "within the actuator's range, and a number");
    PROVE(!(now.idle_n >= 0.0F && now.idle_n <= THRUST_MAX_N) || thrust_n >= now.idle_n,
          "never below the idle");
}

void no_order_is_no_thrust(void)
{
    guard_t guard = any_guard();
    guard_case_t now = any_case();

    now.ordered = false;
    ASSUME(now.idle_n >= 0.0F && now.idle_n <= THRUST_MAX_N);
    PROVE(guard_step(&guard, &now) == now.idle_n, "the idle, whatever is wanted");
}

/* What is commanded above the heaviest hover thrust goes onto the sum, and the sum stays below its limit. So
 * all cycles since a confirmed climb together stay below it too. */
void any_unseen_impulse_is_bounded(void)
{
    guard_t guard = any_guard();
    guard_case_t now = any_case();

    ASSUME(guard.unseen_ns >= 0.0F && guard.unseen_ns <= GUARD_UNSEEN_NS);
    ASSUME(now.heaviest_n >= 0.0F && now.heaviest_n <= THRUST_MAX_N && now.idle_n <= now.heaviest_n);
    ASSUME(now.step_s >= 0.0F && now.step_s <= CYCLE_MAX_S);
    now.ordered = true;
    now.confirmed = false;
    const float before_ns = guard.unseen_ns;
    const float thrust_n = guard_step(&guard, &now);

    PROVE(guard.unseen_ns >= before_ns && guard.unseen_ns <= GUARD_UNSEEN_NS, "the sum grows to its limit");
    PROVE(thrust_n <= now.heaviest_n || guard.unseen_ns == before_ns + commanded_ns,
          "what is above the heaviest hover thrust is on the sum");
}

/* What is commanded below the thrust that is needed goes onto its sum, which stays below its limit; and that
 * thrust fades as faded_n() says. So a fall by command is bounded in any number of cycles. */
void any_fall_is_bounded(void)
{
    guard_t guard = any_guard();
    guard_case_t now = any_case();

    ASSUME(guard.sure_n >= 0.0F && guard.sure_n <= THRUST_MAX_N);
    ASSUME(guard.fallen_ns >= 0.0F && guard.fallen_ns <= GUARD_FALL_NS);
    ASSUME(now.lightest_n >= 0.0F && now.lightest_n <= now.heaviest_n && now.heaviest_n <= THRUST_MAX_N);
    ASSUME(now.step_s >= 0.0F && now.step_s <= CYCLE_MAX_S && now.idle_n <= now.lightest_n);
    now.ordered = true;
    now.confirmed = true; /* any_unseen_impulse_is_bounded() is the other half */
    const float before_ns = guard.fallen_ns;
    const float thrust_n = guard_step(&guard, &now);
    const float least_n = faded_to_n < now.lightest_n ? faded_to_n : now.lightest_n;

    PROVE(guard.fallen_ns >= 0.0F && guard.fallen_ns <= GUARD_FALL_NS, "the sum stays within its limit");
    PROVE(guard.sure_n >= least_n, "what is needed fades slowly");
    PROVE(thrust_n >= least_n || guard.fallen_ns == before_ns + commanded_ns,
          "what is below the needed thrust is on the sum");
}
