#include "control/laws/pidt.h"

#include <math.h>
#include <stdbool.h>

#include "control/between.h"
#include "control/credible.h"

#define LOW_PASS_S 0.0199F /* chosen: 8 Hz */

#define FAR_M 0.40F       /* tried 0.25 to 0.5: below a reference of 0.6 m, and there is room to brake */
#define APPROACH_MPS 0.1F /* chosen: slower ones may be a vehicle that needs more thrust */

#define SWING_N 0.8F        /* chosen: three times the usual activity, 0.22 N */
#define SWINGS_FREE 3.0F    /* chosen: an edge and the swing back make two */
#define SWINGS_TIME_S 10.0F /* chosen: a loop that has swung would swing again */

void pidt_reset(pidt_state_t *state)
{
    *state = (pidt_state_t){.integral_n = 0.0F};
}

void pidt_resume(pidt_state_t *state)
{
    state->primed = false;
}

static void differentiate(pidt_state_t *state, float height_m, float dt_s)
{
    if (dt_s > 0.0F) {
        state->rate_mps += dt_s / (dt_s + LOW_PASS_S) *
                           ((height_m - state->height_m) / dt_s - state->rate_mps);
    } else {
        state->rate_mps = 0.0F;
    }
    state->height_m = height_m;
    state->primed = true;
}

/* Below 1 after swings to and fro: the gains are too high for this vehicle; twice as many, half of them.
 * action_n: what proportional and derivative part ask for. */
static float calm(pidt_state_t *state, float action_n, float dt_s)
{
    const bool turned = action_n * state->peak_n < 0.0F;

    state->swings *= 1.0F - dt_s / SWINGS_TIME_S;
    if (turned && fabsf(state->peak_n) > SWING_N) {
        state->swings += 1.0F;
    }
    if (turned || fabsf(action_n) > fabsf(state->peak_n)) {
        state->peak_n = action_n;
    }
    return SWINGS_FREE / at_least(state->swings, SWINGS_FREE);
}

float pidt_step(pidt_state_t *state, const pidt_gains_t *gains, float reference_m, float height_m, float dt_s)
{
    const bool steady = state->primed && dt_s >= SCAN_LEAST_S && dt_s <= HEIGHT_FRESH_S;
    const float step_s = steady ? dt_s : 0.0F;
    const float error_m = reference_m - height_m;

    differentiate(state, height_m, step_s);
    const float near_m = between(-FAR_M, error_m, FAR_M);
    const float action_n = gains->kp_n_per_m * near_m - gains->kd_n_s_per_m * state->rate_mps;
    const float other_n = gains->gravity_n + calm(state, action_n, step_s) * action_n;
    const bool arrives = near_m != error_m && near_m * state->rate_mps > FAR_M * APPROACH_MPS;
    const float more_n = arrives ? 0.0F : gains->ki_n_per_m_s * near_m * step_s;
    const float thrust_n = other_n + state->integral_n + more_n;
    const bool further = (thrust_n > gains->most_n && more_n > 0.0F) ||
                         (thrust_n < gains->least_n && more_n < 0.0F);

    state->integral_n += further ? 0.0F : more_n;
    return at_most(at_least(other_n + state->integral_n, gains->least_n), gains->most_n);
}
