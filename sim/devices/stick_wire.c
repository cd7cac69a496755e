#include "sim/devices/stick_wire.h"

#include <math.h>

#define SPIKE_MOST_US 3000.0

void stick_wire_init(stick_wire_t *wire, const stick_wire_config_t *config, unsigned long seed)
{
    *wire = (stick_wire_t){.config = *config};
    noise_init(&wire->noise, seed, "stick wire");
}

static double told_us(stick_wire_t *wire, double t_s, double pulse_us)
{
    const stick_wire_config_t *config = &wire->config;

    if (span_holds(&config->stuck, t_s)) {
        return config->stuck_us;
    }
    return span_holds(&config->frozen, t_s) && wire->latest_us > 0.0 ? wire->latest_us : pulse_us;
}

sim_time_t stick_wire_pulse(stick_wire_t *wire, double t_s, sim_time_t high_ns)
{
    const stick_wire_config_t *config = &wire->config;

    if (config->connected < 0.5 || span_holds(&config->lost, t_s)) {
        return 0;
    }
    wire->latest_us = told_us(wire, t_s, (double)high_ns * 1e-3);
    double pulse_us = wire->latest_us + config->offset_us + config->noise_us * noise_gauss(&wire->noise);

    if (noise_uniform(&wire->noise, 0.0, 1.0) < config->spikes) {
        pulse_us = noise_uniform(&wire->noise, 1.0, SPIKE_MOST_US);
    }
    return (sim_time_t)llround(fmax(pulse_us, 1.0) * 1e3);
}
