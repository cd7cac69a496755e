/* The Pololu 4-channel RC multiplexer on the throttle channel: SEL chooses the pilot's receiver or the
 * firmware. */
#ifndef SIM_DEVICES_RC_MUX_H
#define SIM_DEVICES_RC_MUX_H

#include <stdbool.h>

#include "sim/timeline.h"

typedef void (*rc_pulse_t)(void *context, sim_time_t high_ns);

typedef struct {
    bool firmware_selected;
    rc_pulse_t autopilot;
    void *context;
} rc_mux_t;

void rc_mux_init(rc_mux_t *mux, rc_pulse_t autopilot, void *context); /* the firmware has the throttle */
void rc_mux_select(rc_mux_t *mux, bool firmware);
void rc_mux_firmware_pulse(void *mux, sim_time_t high_ns); /* rc_pulse_t shape */
void rc_mux_receiver_pulse(rc_mux_t *mux, sim_time_t high_ns);

#endif
