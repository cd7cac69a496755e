/* The wire from the receiver's throttle channel to the firmware's pin, and how it may lie. The multiplexer
 * and the autopilot hear the receiver itself. */
#ifndef SIM_DEVICES_STICK_WIRE_H
#define SIM_DEVICES_STICK_WIRE_H

#include <stdbool.h>

#include "sim/devices/span.h"
#include "sim/noise.h"
#include "sim/timeline.h"

typedef struct {
    double connected; /* 0: open; 1 */
    double offset_us; /* added to each pulse */
    double noise_us;  /* of each pulse, rms */
    double spikes;    /* probability that a pulse has any length up to 3 ms */
    double stuck_us;  /* the pulse while `stuck` holds, whatever the pilot does */
    span_t stuck;
    span_t frozen; /* the pulse of its beginning is repeated */
    span_t lost;   /* no pulses */
} stick_wire_config_t;

#define STICK_WIRE_DEFAULT \
    { \
        .stuck_us = 1500.0, .stuck = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S}, \
        .frozen = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S}, .lost = { \
            SPAN_FOR_GOOD_S, \
            SPAN_FOR_GOOD_S \
        } \
    }

typedef struct {
    stick_wire_config_t config;
    noise_t noise;
    double latest_us; /* that reached the pin */
} stick_wire_t;

void stick_wire_init(stick_wire_t *wire, const stick_wire_config_t *config, unsigned long seed);

/* The receiver's pulse as it reaches the firmware, at scenario time t_s. 0: none does. */
sim_time_t stick_wire_pulse(stick_wire_t *wire, double t_s, sim_time_t high_ns);

#endif
