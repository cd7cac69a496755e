#include "control/est/deadband.h"

#include <math.h>

#include "control/between.h"

#define BAND_MAX_N 1.5F          /* chosen: three times the deadband that Cleanflight has by default */
#define STEEP_N 0.10F            /* chosen: steep, but no jump */
#define CLEAR_N (2.0F * STEEP_N) /* nearer to neutral the sign of a command tells little */
#define LEARN_PER_S 3.0F         /* chosen: time constant 0.3 s */

void deadband_init(deadband_t *deadband)
{
    *deadband = (deadband_t){.band_n = 0.0F};
}

float deadband_compensate(const deadband_t *deadband, float neutral_n, float effect_n)
{
    return effect_n + deadband->band_n * between(-1.0F, (effect_n - neutral_n) / STEEP_N, 1.0F);
}

float deadband_effect(const deadband_t *deadband, float neutral_n, float command_n)
{
    return command_n - between(-deadband->band_n, command_n - neutral_n, deadband->band_n);
}

void deadband_learn(deadband_t *deadband, float off_n, float missing_n, float dt_s)
{
    const float side = between(-1.0F, off_n / CLEAR_N, 1.0F);
    deadband->band_n = between(0.0F, deadband->band_n + LEARN_PER_S * dt_s * side * missing_n, BAND_MAX_N);
}
