#include "sim/devices/lipo.h"

#include <math.h>
#include <stddef.h>

#define ELECTRONICS_A 1.3 /* docs/hardware.md, supplies */
#define S_PER_H 3600.0

/* At rest, by 5 % of charge: the chart of LiPo voltages at blog.ampow.com/lipo-voltage-chart. */
static const double rest_v[] = {3.27, 3.61, 3.69, 3.71, 3.73, 3.75, 3.77, 3.79, 3.80, 3.82, 3.84,
                                3.85, 3.87, 3.91, 3.95, 3.98, 4.02, 4.08, 4.11, 4.15, 4.20};
#define LAST (sizeof rest_v / sizeof rest_v[0] - 1)

void lipo_init(lipo_t *battery, const lipo_config_t *config, unsigned long seed)
{
    *battery = (lipo_t){.config = *config};
    noise_init(&battery->noise, seed, "battery");
}

double lipo_cell_v(double charge)
{
    const double at = fmin(fmax(charge, 0.0), 1.0) * (double)LAST;
    const size_t from = (size_t)fmin(at, (double)LAST - 1.0);

    return rest_v[from] + (at - (double)from) * (rest_v[from + 1] - rest_v[from]);
}

double lipo_draw(lipo_t *battery, double hovers, double dt_s)
{
    const lipo_config_t *config = &battery->config;
    const double current_a = ELECTRONICS_A + config->hover_a * pow(fmax(hovers, 0.0), 1.5);

    battery->drawn_ah += current_a * dt_s / S_PER_H;
    return config->cells * lipo_cell_v(config->charge - battery->drawn_ah / config->capacity_ah) -
           current_a * config->resistance_ohm;
}

double lipo_share(const lipo_t *battery, double terminal_v)
{
    const lipo_config_t *config = &battery->config;
    const double full_v = config->cells * lipo_cell_v(1.0) -
                          (ELECTRONICS_A + config->hover_a) * config->resistance_ohm;

    return full_v > 0.0 ? fmax(terminal_v, 0.0) / full_v : 0.0;
}

static double told_v(const lipo_t *battery, double t_s, double terminal_v)
{
    return span_holds(&battery->config.stuck, t_s) ? battery->config.stuck_v : terminal_v;
}

double lipo_pin_v(lipo_t *battery, double t_s, double terminal_v)
{
    const lipo_config_t *config = &battery->config;
    const double noise_v = config->noise_v * noise_gauss(&battery->noise);
    const double contact = noise_uniform(&battery->noise, 0.0, 1.0);

    if (config->connected < 0.5 || span_holds(&config->lost, t_s)) {
        return 0.0;
    }
    if (span_holds(&config->frozen, t_s) && battery->latest_v > 0.0) {
        return battery->latest_v;
    }
    if (contact < config->loose) {
        return 0.0;
    }
    battery->latest_v = fmax(told_v(battery, t_s, terminal_v) + noise_v, 0.0) / config->divider;
    return battery->latest_v;
}
