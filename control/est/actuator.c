#include "control/est/actuator.h"

void actuator_init(actuator_t *actuator, uint32_t now_us)
{
    *actuator = (actuator_t){.time_us = now_us};
}

void actuator_describe(actuator_t *actuator, float delay_s, float lag_s)
{
    actuator->delay_us = (uint32_t)(delay_s * 1.0e6F + 0.5F);
    actuator->lag_s = lag_s;
}

static void take_effect(actuator_t *actuator)
{
    actuator->demand_n = actuator->coming[0].thrust_n;
    --actuator->count;
    for (uint16_t i = 0U; i < actuator->count; ++i) {
        actuator->coming[i] = actuator->coming[i + 1U];
    }
}

void actuator_command(actuator_t *actuator, float thrust_n, uint32_t now_us)
{
    if (actuator->count == ACTUATOR_COMMANDS) {
        take_effect(actuator);
    }
    actuator->coming[actuator->count] = (actuator_command_t){now_us + actuator->delay_us, thrust_n};
    ++actuator->count;
}

static inline void lag(actuator_t *actuator, uint32_t until_us)
{
    const int32_t step_us = (int32_t)(until_us - actuator->time_us);

    if (step_us > 0) {
        const float step_s = (float)step_us * 1.0e-6F;
        const float share = step_s / (actuator->lag_s + 0.5F * step_s);
        actuator->thrust_n += ((share < 1.0F) ? share : 1.0F) * (actuator->demand_n - actuator->thrust_n);
        actuator->time_us = until_us;
    }
}

void actuator_advance(actuator_t *actuator, uint32_t time_us)
{
    while (actuator->count > 0U && (int32_t)(actuator->coming[0].due_us - time_us) <= 0) {
        lag(actuator, actuator->coming[0].due_us);
        take_effect(actuator);
    }
    lag(actuator, time_us);
}

actuator_t actuator_at(const actuator_t *actuator, uint32_t time_us)
{
    actuator_t then = *actuator;

    actuator_advance(&then, time_us);
    return then;
}
