/* What comes back of a ray in a place: through glass and past edges. */
#ifndef SIM_DEVICES_ECHO_H
#define SIM_DEVICES_ECHO_H

#include <stdbool.h>

#include "sim/devices/bracket.h"
#include "sim/devices/place.h"
#include "sim/noise.h"

#define ECHO_REACH_MM 5600.0 /* as far as the sensor tells distances; beyond 4095 its own affair */

typedef struct {
    double signal; /* of surface_signal(); 0: nothing in reach */
    double mm;     /* from the sensor, the mean by the light */
    double dazzle; /* probability of too much light */
    bool edged;    /* its spot lights two things */
    bool plain;    /* nothing but plain surfaces */
} echo_t;

/* spot_rad: half the width of what the ray lights; 0: a line. noise: of what lies within a pile. */
echo_t echo_of(const place_t *place, const bracket_ray_t *ray, double spot_rad, double t_s, noise_t *noise);

#endif
