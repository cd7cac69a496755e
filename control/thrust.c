#include "control/thrust.h"

#define SLOPE_STEPS_PER_N 177.21F /* seed eq. 4-5 */
#define IDLE_STEPS 4166.0F        /* seed eq. 4-5 */

float thrust_to_pulse_us(float thrust_n)
{
    const float pulse_us = (IDLE_STEPS - SLOPE_STEPS_PER_N * thrust_n) * THRUST_STEP_US;
    if (pulse_us < THRUST_FULL_PULSE_US) {
        return THRUST_FULL_PULSE_US;
    }
    return (pulse_us < THRUST_IDLE_PULSE_US) ? pulse_us : THRUST_IDLE_PULSE_US;
}

float thrust_from_pulse_us(float pulse_us)
{
    const float thrust_n = (IDLE_STEPS - pulse_us / THRUST_STEP_US) / SLOPE_STEPS_PER_N;
    if (thrust_n > THRUST_MAX_N) {
        return THRUST_MAX_N;
    }
    return (thrust_n > 0.0F) ? thrust_n : 0.0F;
}

float thrust_of_percent(float percent)
{
    return 0.01F * percent * THRUST_MAX_N;
}
