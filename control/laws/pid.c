#include "control/laws/pid.h"

#include "control/between.h"
#include "control/thrust.h"

void pid_reset(pid_state_t *state)
{
    *state = (pid_state_t){.integral_n = 0.0F};
}

void pid_resume(pid_state_t *state)
{
    state->primed = false;
}

static float into_actuator(float thrust_n)
{
    return at_most(at_least(thrust_n, 0.0F), THRUST_MAX_N);
}

float pid_step(pid_state_t *state, const pid_gains_t *gains, float error_mm)
{
    const float lowest_n = into_actuator(gains->gravity_n - gains->descension_n);
    const float highest_n = into_actuator(gains->gravity_n + gains->ascension_n);
    const float change_mm = state->primed ? error_mm - state->last_error_mm : 0.0F;
    const float other_n = gains->kp_n_per_mm * error_mm + gains->kd_n_per_mm * change_mm + gains->gravity_n;
    const float held_n = (gains->ki_n_per_mm > 0.0F) ? state->integral_n : 0.0F;
    const float integral_n = held_n + gains->ki_n_per_mm * error_mm;

    state->last_error_mm = error_mm;
    state->primed = true;
    state->saturated = other_n + integral_n < lowest_n || other_n + integral_n > highest_n;
    state->integral_n = state->saturated ? held_n : integral_n;
    return at_most(at_least(other_n + state->integral_n, lowest_n), highest_n);
}
