#include "sim/devices/floor.h"

#include <math.h>

#define SQRT_3 1.7320508075688772

/* x'' + 2 w x' + w^2 x = white noise of intensity S has the stationary variance S / (4 w^3). */
void floor_init(floor_t *under, const floor_config_t *config, double step_s, unsigned long seed)
{
    *under = (floor_t){.step_s = step_s};
    floor_change(under, config);
    noise_init(&under->noise, seed, "floor");
}

void floor_change(floor_t *under, const floor_config_t *config)
{
    under->config = *config;
    under->omega = 2.0 / config->tau_s;
    under->drive = config->rms_m * sqrt(4.0 * pow(under->omega, 3.0) * under->step_s);
}

void floor_pass(floor_t *under)
{
    const double w = under->omega;

    under->travel_s += under->step_s;
    if (under->config.rms_m > 0.0) {
        under->rate_mps += under->step_s * (-w * w * under->rough_m - 2.0 * w * under->rate_mps) +
                           under->drive * noise_uniform(&under->noise, -SQRT_3, SQRT_3);
        under->rough_m += under->step_s * under->rate_mps;
    }
}

double floor_height_m(const floor_t *under)
{
    const floor_config_t *c = &under->config;
    const bool over_bar = c->bars_m != 0.0 &&
                          fmod(under->travel_s, c->bars_period_s) >= c->bars_period_s * (1.0 - c->bars_share);

    return under->rough_m + (over_bar ? c->bars_m : 0.0);
}
