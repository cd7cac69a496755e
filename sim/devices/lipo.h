/* The battery, the power module's divider and the wire to the firmware's pin, and how these may lie.
 *
 * The cells' voltage at rest follows the charge. Under load it sags by the current times the resistance. The
 * current grows with the thrust to the power of 1.5, as momentum theory has it for a rotor that hovers. */
#ifndef SIM_DEVICES_LIPO_H
#define SIM_DEVICES_LIPO_H

#include "sim/devices/span.h"
#include "sim/noise.h"

typedef struct {
    double connected; /* 0: nothing is on the pin; 1 */
    double cells;
    double charge; /* at power-on, 0 .. 1 */
    double capacity_ah;
    double resistance_ohm; /* of all cells and their leads */
    double hover_a;        /* in a hover */
    double divider;        /* of the module, with the load that the pin is to it */
    double noise_v;        /* at the battery, rms: motors, converter */
    double loose;          /* probability that a reading finds the wire open */
    double stuck_v;        /* what the module tells while `stuck` holds */
    span_t stuck;
    span_t frozen; /* the reading of its beginning is repeated */
    span_t lost;   /* the wire is open */
} lipo_config_t;

/* docs/hardware.md: 4S, 5 Ah. Resistance: PX4 reckons with 0.3 V a cell from 5C to 25C (BAT1_V_LOAD_DROP), 3
 * mOhm a cell, and leads of 8. Current: 58 W a rotor by momentum theory for 7.4 N and 10 inch, half of that
 * lost in propeller, motor and controller. Divider: ArduPilot's for this module. Noise: chosen, 4 steps. */
#define LIPO_DEFAULT \
    { \
        .cells = 4.0, .charge = 1.0, .capacity_ah = 5.0, .resistance_ohm = 0.02, .hover_a = 31.0, \
        .divider = 10.1, .noise_v = 0.03, .stuck_v = 14.8, .stuck = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S}, \
        .frozen = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S}, .lost = { \
            SPAN_FOR_GOOD_S, \
            SPAN_FOR_GOOD_S \
        } \
    }

typedef struct {
    lipo_config_t config;
    noise_t noise;
    double drawn_ah;
    double latest_v; /* at the pin */
} lipo_t;

void lipo_init(lipo_t *battery, const lipo_config_t *config, unsigned long seed);

/* Volts of a cell at rest; charge 0 .. 1. */
double lipo_cell_v(double charge);

/* The thrust, as a share of that of a hover, was drawn for dt_s. Returns the volts at the terminals. */
double lipo_draw(lipo_t *battery, double hovers, double dt_s);

/* The volts at the terminals as a share of what a full one has in a hover. */
double lipo_share(const lipo_t *battery, double terminal_v);

/* What reaches the pin at scenario time t_s, in volts; 0 where the wire is open: the pin is pulled down. */
double lipo_pin_v(lipo_t *battery, double t_s, double terminal_v);

#endif
