#include "sim/devices/rc_mux.h"

void rc_mux_init(rc_mux_t *mux, rc_pulse_t autopilot, void *context)
{
    *mux = (rc_mux_t){.firmware_selected = true, .autopilot = autopilot, .context = context};
}

void rc_mux_select(rc_mux_t *mux, bool firmware)
{
    mux->firmware_selected = firmware;
}

void rc_mux_firmware_pulse(void *mux, sim_time_t high_ns)
{
    const rc_mux_t *self = mux;
    if (self->firmware_selected) {
        self->autopilot(self->context, high_ns);
    }
}

void rc_mux_receiver_pulse(rc_mux_t *mux, sim_time_t high_ns)
{
    if (!mux->firmware_selected) {
        mux->autopilot(mux->context, high_ns);
    }
}
