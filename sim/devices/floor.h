/* What lies under a vehicle that flies along: a floor that is not even, and bars on it. The vehicle gets on
 * only while it is in the air, so that the place where it stands does not move.
 *
 * The uneven floor is white noise through two equal lags of tau / 2: its deviation is rms, it has a slope
 * everywhere, and tau is the integral of its autocorrelation. The first bar ends one period after the
 * take-off. */
#ifndef SIM_DEVICES_FLOOR_H
#define SIM_DEVICES_FLOOR_H

#include <stdbool.h>

#include "sim/noise.h"

typedef struct {
    double rms_m; /* 0: even */
    double tau_s;
    double bars_m;        /* their height; 0: none */
    double bars_period_s; /* from bar to bar */
    double bars_share;    /* of it is a bar, the rest gap */
} floor_config_t;

#define FLOOR_DEFAULT \
    { \
        .rms_m = 0.0, .tau_s = 0.5, .bars_m = 0.0, .bars_period_s = 0.4, .bars_share = 0.3 \
    }

typedef struct {
    floor_config_t config;
    noise_t noise;
    double step_s, omega, drive;
    double rough_m, rate_mps; /* of the uneven floor: height, and how fast it rises under the vehicle */
    double travel_s;          /* time spent in the air */
} floor_t;

void floor_init(floor_t *under, const floor_config_t *config, double step_s, unsigned long seed);
/* Another floor from here on. */
void floor_change(floor_t *under, const floor_config_t *config);
/* The vehicle has flown on for one step. */
void floor_pass(floor_t *under);
double floor_height_m(const floor_t *under);

#endif
